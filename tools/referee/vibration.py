"""The first natural frequencies of the beam's bar."""

import math

import numpy as np

from . import ccx, mesh
from .values import Value, extrapolate

SOURCE = ("CalculiX 2.20, linear, 20-node hexahedra graded towards the clamp, k = 4, 6, 8 cells "
          "over the width, extrapolated; axial: analysis, sqrt(E / rho) / (4 L)")
YOUNG, LENGTH = 150e3, 0.4


def block(k, grading=2.0):
    def place(a, b, c):
        return np.stack([0.1 * mesh.both_ends(a, grading) - 0.05,
                         0.1 * mesh.both_ends(b, grading) - 0.05, LENGTH * c ** grading], axis=1)
    return mesh.Block((k, k, 3 * k), place)


def deck(k, poisson, count):
    b = block(k)
    return (b.deck() + ccx.node_set("CLAMP", b.side(2, 0)) +
            ccx.section(ccx.linear_elastic, YOUNG, poisson) + "*BOUNDARY\nCLAMP,1,3\n"
            f"*STEP\n*FREQUENCY\n{count}\n*END STEP\n")


def values(runner):
    sizes = (4, 6, 8)
    found = [runner.run(f"vibration-0.45-{k}", deck(k, 0.45, 6)).frequencies() for k in sizes]
    for mode in range(6):
        yield extrapolate("nu=0.45", f"f{mode + 1}", sizes, [f[mode] for f in found])
    # Without lateral strain the bar is one-dimensional, and a bar of one dimension has this mode.
    exact = math.sqrt(YOUNG / ccx.DENSITY) / (4.0 * LENGTH)
    modes = runner.run("vibration-0-4", deck(4, 0.0, 12)).frequencies()
    yield Value("nu=0", "axial", exact, 1e-9 * exact, {"k = 4": min(modes, key=lambda f: abs(f - exact))})


CASES = {"vibration": (SOURCE, values, "vibration-0.45-4")}
