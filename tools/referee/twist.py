"""The bar of the beam, one end turned by half a turn about its axis."""

import numpy as np

from . import ccx, mesh
from .fem import Bar
from .values import extrapolate

SOURCE = ("CalculiX 2.20 on 20-node hexahedra, k = 2 cells over the width; k = 2, 4, 6, "
          "extrapolated, by the same elements in tools/referee/fem.py")
YOUNG, POISSON = 15e3, 0.45
STEPS = 6  # of 30 degrees


def block(k, grading=1.5):
    def place(a, b, c):
        x, y, z = (mesh.both_ends(s, grading) for s in (a, b, c))
        return np.stack([0.1 * x - 0.05, 0.1 * y - 0.05, 0.4 * z], axis=1)
    return mesh.Block((k, k, 3 * k), place)


def turned(points, degrees):
    """Points turned about the z axis."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return points @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def deck(k, law=ccx.stable_neo_hookean):
    b = block(k)
    end = b.side(2, -1)
    text = (b.deck() + ccx.node_set("CLAMP", b.side(2, 0)) + ccx.node_set("END", end) +
            ccx.section(law, YOUNG, POISSON) + "*BOUNDARY\nCLAMP,1,3\n")
    for step in range(1, STEPS + 1):
        moves = turned(b.points[end - 1], 180.0 * step / STEPS) - b.points[end - 1]
        output = "*NODE PRINT,NSET=END,FREQUENCY=2000\nU,RF\n" if step == STEPS else ""
        text += ccx.static_step("*BOUNDARY\n" + mesh.prescribed(end, moves) + output, law, 0.5, 0.5)
    return text


def resultants(points, forces):
    """Torque about z [N m] and force along z [N] of forces at points."""
    return np.cross(points, forces)[:, 2].sum(), forces[:, 2].sum()


def by_calculix(runner, k):
    b = block(k)
    result = runner.run(f"twist-{k}", deck(k))
    moves, forces = (result.last(kind, "END") for kind in ("displacements", "forces"))
    nodes = sorted(forces)
    points = b.points[np.array(nodes) - 1] + np.array([moves[n] for n in nodes])
    return resultants(points, np.array([forces[n] for n in nodes]))


def by_fem(k, reduced=True):
    b = block(k)
    bar = Bar(b, YOUNG, POISSON, reduced)
    end = b.side(2, -1) - 1
    free = np.ones(b.points.shape, bool)
    free[b.side(2, 0) - 1] = free[end] = False
    x = b.points.copy()
    for step in range(1, STEPS + 1):
        # Every section turned with the end: close to where it will rest.
        for node, share in enumerate(b.points[:, 2] / 0.4):
            x[node] = turned(x[node:node + 1], 180.0 / STEPS * share)[0]
        x[end] = turned(b.points[end], 180.0 * step / STEPS)
        x = bar.minimise(x, free, np.zeros_like(x))
    return resultants(x[end], bar.force(x)[end])


def values(runner):
    answers = {k: runner.remember(f"twist-fem-{k}", lambda k=k: by_fem(k)) for k in (2, 4, 6)}
    check = by_calculix(runner, 2)
    for i, quantity in enumerate(("torque", "axial")):
        value = extrapolate("", quantity, (2, 4, 6), [answers[k][i] for k in (2, 4, 6)])
        value.meshes = {"k = 2, CalculiX": check[i], **value.meshes}
        yield value


CASES = {"twist": (SOURCE, values, "twist-2")}
