"""A bar bent to an arc of a circle by its two rigid ends."""

import numpy as np

from . import ccx, mesh
from .fem import Bar
from .values import extrapolate

SOURCE = ("CalculiX 2.20 on 20-node hexahedra, k = 2 cells over the width; k = 4, 6, 8, "
          "extrapolated, by the same elements in tools/referee/fem.py")
YOUNG, POISSON = 100e3, 0.45
HALF_ANGLE = 30.0  # [degrees], of each end
LENGTH = 0.4
STEPS = 3


def block(k, grading=1.5):
    """The quarter x < 0, z > 0, from the middle to the end, graded towards the sides and the end."""
    def place(a, b, c):
        return np.stack([-0.02 * (1.0 - a ** grading), 0.04 * mesh.both_ends(b, grading) - 0.02,
                         0.2 * (1.0 - (1.0 - c) ** grading)], axis=1)
    return mesh.Block((k // 2, k, 4 * k), place)


def moved(points, degrees):
    """The end face turned about x through its centre and moved along z, so that an arc of the
    bar's own length fits between the two ends."""
    angle = np.radians(degrees)
    c, s = np.cos(angle), np.sin(angle)
    radius = LENGTH / (2.0 * angle)
    centre = np.array([0.0, 0.0, LENGTH / 2.0])
    turn = np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]])
    return (points - centre) @ turn + np.array([0.0, 0.0, radius * s])


def deck(k, law=ccx.stable_neo_hookean):
    b = block(k)
    end, middle = b.side(2, -1), b.side(2, 0)
    text = (b.deck() + ccx.node_set("END", end) + ccx.node_set("MIDDLE", middle) +
            ccx.node_set("PLANE", b.side(0, -1)) + ccx.section(law, YOUNG, POISSON) +
            "*BOUNDARY\nMIDDLE,3,3\n" + mesh.held(sorted(set(b.side(0, -1)) - set(end)), 1))
    for step in range(1, STEPS + 1):
        moves = moved(b.points[end - 1], HALF_ANGLE * step / STEPS) - b.points[end - 1]
        output = ("*NODE PRINT,NSET=END,FREQUENCY=2000\nU,RF\n*NODE PRINT,NSET=MIDDLE,"
                  "FREQUENCY=2000\nU\n" if step == STEPS else "")
        text += ccx.static_step("*BOUNDARY\n" + mesh.prescribed(end, moves) + output, law, 0.5, 0.5)
    return text


def moment(points, forces):
    """About x, through the end's centre [N m], of the whole bar."""
    arms = points - moved(np.array([[0.0, 0.0, LENGTH / 2.0]]), HALF_ANGLE)
    return 2.0 * np.cross(arms, forces)[:, 0].sum()


def by_calculix(runner, k):
    b = block(k)
    result = runner.run(f"bending-{k}", deck(k))
    moves, forces = (result.last(kind, "END") for kind in ("displacements", "forces"))
    nodes = sorted(forces)
    points = b.points[np.array(nodes) - 1] + np.array([moves[n] for n in nodes])
    return (moment(points, np.array([forces[n] for n in nodes])),
            mesh.mean(result.last("displacements", "MIDDLE"), b.side_weights(2, 0), 1))


def by_fem(k, reduced=True):
    b = block(k)
    bar = Bar(b, YOUNG, POISSON, reduced)
    end = b.side(2, -1) - 1
    free = np.ones(b.points.shape, bool)
    free[b.side(0, -1) - 1, 0] = free[b.side(2, 0) - 1, 2] = free[end] = False
    x = b.points.copy()
    for step in range(1, STEPS + 1):
        angle = np.radians(HALF_ANGLE * step / STEPS)
        radius = LENGTH / (2.0 * angle)
        # Every section on the arc: close to where it will rest.
        s, y = b.points[:, 2] / radius, b.points[:, 1] + radius
        x = np.stack([b.points[:, 0], y * np.cos(s) - radius * np.cos(angle), y * np.sin(s)],
                     axis=1)
        x[end] = moved(b.points[end], HALF_ANGLE * step / STEPS)
        x = bar.minimise(x, free, np.zeros_like(x))
    weights = b.side_weights(2, 0)
    return (moment(x[end], bar.force(x)[end]),
            sum(w * (x[n - 1, 1] - b.points[n - 1, 1]) for n, w in weights.items()))


def values(runner):
    answers = {k: runner.remember(f"bending-fem-{k}", lambda k=k: by_fem(k)) for k in (4, 6, 8)}
    check = by_calculix(runner, 2)
    for i, quantity in enumerate(("moment", "mid")):
        value = extrapolate("", quantity, (4, 6, 8), [answers[k][i] for k in (4, 6, 8)])
        value.meshes = {"k = 2, CalculiX": check[i], **value.meshes}
        yield value


CASES = {"bending": (SOURCE, values, "bending-2")}
