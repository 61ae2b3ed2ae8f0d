"""The workload W: a clamped bar under its own weight."""

import numpy as np

from . import ccx, mesh
from .fem import Bar
from .values import Value, extrapolate

SOURCE = ("CalculiX 2.20, 20-node hexahedra graded towards the clamp, k = 4, 6, 8 cells over the "
          "width, extrapolated; 15 kPa, and 150 kPa on k = 8, by the same elements in "
          "tools/referee/fem.py")
EXAMPLE = "beam-150kPa-0.45-4"
YOUNG = {"15kPa": 15e3, "150kPa": 150e3, "1.5MPa": 1.5e6, "15MPa": 15e6}
POISSON = (0.3, 0.45, 0.49, 0.499)


def block(k, grading=2.0):
    """The half x < 0 of the bar, k cells over its whole width, 3 k along it: smaller ones towards
    the clamp and the sides, where stresses are singular."""
    def place(a, b, c):
        return np.stack([-0.05 * (1.0 - a ** grading), 0.1 * mesh.both_ends(b, grading) - 0.05,
                         0.4 * c ** grading], axis=1)
    return mesh.Block((k // 2, k, 3 * k), place)


def law_of(young, poisson):
    """Where volumes hardly change, Ciarlet's law is the same and free of noise."""
    return ccx.stable_neo_hookean if young < 1e6 and poisson < 0.48 else ccx.ciarlet


def deck(b, young, poisson, kind="C3D20R"):
    law = law_of(young, poisson)
    return (b.deck(kind) + ccx.node_set("CLAMP", b.side(2, 0)) +
            ccx.node_set("MIDDLE", b.side(0, -1)) + ccx.node_set("TIP", b.side(2, -1)) +
            ccx.section(law, young, poisson) +
            "*BOUNDARY\nCLAMP,1,3\nMIDDLE,1,1\n" +
            ccx.static_step(f"*DLOAD\nBODY,GRAV,{ccx.GRAVITY},0.,-1.,0.\n"
                            "*NODE PRINT,NSET=TIP,FREQUENCY=2000\nU\n", law))


def by_calculix(runner, name, b, young, poisson, kind="C3D20R"):
    """Mean y displacement of the end [m]."""
    table = runner.run(name, deck(b, young, poisson, kind)).last("displacements", "TIP")
    weights = b.side_weights(2, -1)
    return (mesh.mean(table, weights, 1),)


def by_fem(b, young, poisson, reduced=True):
    bar = Bar(b, young, poisson, reduced)
    free = np.ones(b.points.shape, bool)
    free[b.side(2, 0) - 1] = False
    free[b.side(0, -1) - 1, 0] = False
    load = np.zeros_like(b.points)
    load[:, 1] = -ccx.DENSITY * ccx.GRAVITY * bar.weights_of_mass()
    steps = 10 if young < 100e3 else 2
    x = b.points.copy()
    for step in range(1, steps + 1):
        # Rounding hides more where kappa is large.
        x = bar.minimise(x, free, load * step / steps, 1e-9 if young < 1e7 else 1e-7)
    return (sum(w * (x - b.points)[n - 1, 1] for n, w in b.side_weights(2, -1).items()),)


def stiff(runner, name, young, poisson):
    """Converging meshes, and the second referee on the coarsest."""
    answers = {k: by_calculix(runner, f"beam-{name}-{poisson}-{k}", block(k), young, poisson)
               for k in (4, 6)}
    if young > 1e6:
        answers[8] = by_calculix(runner, f"beam-{name}-{poisson}-8", block(8), young, poisson)
    else:
        answers[8] = runner.remember(f"beam-{name}-{poisson}-fem-8",
                                     lambda: by_fem(block(8), young, poisson))
    check = runner.remember(f"beam-{name}-{poisson}-fem-4",
                            lambda: by_fem(block(4), young, poisson))
    value = extrapolate("", "tip", (4, 6, 8), [answers[k][0] for k in (4, 6, 8)])
    value.meshes["k = 4, fem.py"] = check[0]
    return value


def soft(runner, name, young, poisson):
    """Below 100 kPa the bar hangs straight down and folds at the clamp: how, depends on the mesh.
    Reduced integration would let it fold in a zigzag of the elements."""
    answers = {k: runner.remember(f"beam-{name}-{poisson}-fem-{k}",
                                  lambda k=k: by_fem(block(k), young, poisson, reduced=False))
               for k in (4, 6)}
    value, other = answers[6][0], answers[4][0]
    meshes = {"k = 4, fem.py": other, "k = 6, fem.py": value}
    try:
        meshes["k = 4, uniform"] = by_calculix(runner, f"beam-{name}-{poisson}-uniform",
                                               block(4, grading=1.0), young, poisson, "C3D20")[0]
    except ccx.RefereeError as problem:
        runner.say(f"  {problem}")
    # Uniform meshes with k = 6 fold otherwise, and hang 0.2 to 0.6 % less deep.
    return Value("", "tip", value, max(abs(value - other), 5e-3 * abs(value)), meshes)


def values(runner):
    for name, young in YOUNG.items():
        for poisson in POISSON:
            value = (soft if young < 100e3 else stiff)(runner, name, young, poisson)
            value.variant = f"E={name} nu={poisson}"
            yield value


CASES = {"beam": (SOURCE, values, EXAMPLE)}
