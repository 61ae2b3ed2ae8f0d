"""A rigid frictionless sphere pressed into a block."""

import numpy as np

from . import ccx, mesh
from .fem import Bar
from .values import extrapolate

SOURCE = ("tools/referee/fem.py, 20-node hexahedra, n = 4, 6, 8 cells over half the width, "
          "extrapolated; checked by CalculiX 2.20 on n = 4")
YOUNG, POISSON = 10e3, 0.45
SIZE = np.array([0.05, 0.05, 0.05])  # of the quarter x > 0, z > 0, y up
RADIUS, DEPTH = 0.03, 0.01
STEPS = 5


def block(n, grading=1.6):
    """n cells along x and z, 3 n / 4 along y, the smallest ones under the sphere."""
    def place(a, b, c):
        return SIZE * np.stack([b ** grading, 1.0 - (1.0 - c) ** grading, a ** grading], axis=1)
    return mesh.Block((n, n, 3 * n // 4), place)


class Sphere:
    """Pushes points of the block's top out: energy stiffness/2 gap^2 per area [Pa/m], where the
    gap to the sphere is negative. Its points are Gauss points of the 8-node faces."""

    def __init__(self, b, stiffness, order=4):
        self.count = len(b.points)
        self.stiffness_per_area = stiffness
        x, w = np.polynomial.legendre.leggauss(order)
        s, t = (v.ravel() for v in np.meshgrid(x, x, indexing="ij"))
        weights = np.outer(w, w).ravel()
        ids = b.index[:, :, -1]
        corners = [(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0)]
        shape = np.stack([
            (1 + i * s) * (1 + j * t) * (i * s + j * t - 1) / 4 if i and j else
            (1 - s * s) * (1 + j * t) / 2 if i == 0 else (1 - t * t) * (1 + i * s) / 2
            for i, j in corners], axis=1)
        self.shape, self.nodes, self.area = [], [], []
        for i in range(1, ids.shape[0], 2):
            for j in range(1, ids.shape[1], 2):
                face = np.array([ids[i + di, j + dj] for di, dj in corners]) - 1
                sides = b.points[face[1]] - b.points[face[0]], b.points[face[3]] - b.points[face[0]]
                self.nodes.append(np.tile(face, (len(s), 1)))
                self.shape.append(shape)
                self.area.append(weights / 4.0 * np.linalg.norm(np.cross(*sides)))
        self.nodes, self.shape = np.concatenate(self.nodes), np.concatenate(self.shape)
        self.area = np.concatenate(self.area) * stiffness
        self.centre = np.array([0.0, SIZE[1] + RADIUS, 0.0])

    def touching(self, x):
        """Of the points inside: which, gap [m], direction from the centre."""
        arm = np.einsum("pa,pai->pi", self.shape, x[self.nodes]) - self.centre
        distance = np.linalg.norm(arm, axis=1)
        inside = np.flatnonzero(distance < RADIUS)
        return inside, distance[inside] - RADIUS, arm[inside] / distance[inside, None]

    def energy(self, x):
        inside, gap, _ = self.touching(x)
        return float((0.5 * self.area[inside] * gap * gap).sum())

    def force(self, x):
        inside, gap, normal = self.touching(x)
        share = np.einsum("p,pi,pa->pai", self.area[inside] * gap, normal, self.shape[inside])
        force = np.zeros((self.count, 3))
        np.add.at(force, self.nodes[inside], share)
        return force

    def stiffness(self, x, layer):
        """The second derivative for the nodes of the top, as a flat square matrix; without the
        part of the sphere's curvature, which is negative and small where the gap is."""
        local = np.zeros(self.count, dtype=int)
        local[layer] = np.arange(len(layer))
        inside, _, normal = self.touching(x)
        slope = np.einsum("pa,pi->pai", self.shape[inside], normal).reshape(len(inside), 24)
        blocks = self.area[inside][:, None, None] * slope[:, :, None] * slope[:, None, :]
        dof = (3 * local[self.nodes[inside]][..., None] + np.arange(3)).reshape(len(inside), 24)
        size = 3 * len(layer)
        place = dof[:, :, None] * size + dof[:, None, :]
        return np.bincount(place.ravel(), blocks.ravel(), size * size)

    def lift(self, x):
        """Force on the whole sphere, up [N]."""
        inside, gap, normal = self.touching(x)
        return 4.0 * float((self.area[inside] * gap * normal[:, 1]).sum())


def ball(n=8):
    """The rigid sphere for ccx: a shell whose outer side lies on it."""
    def place(a, b, c):
        x, z = 0.0195 * a, 0.0195 * b
        direction = np.stack([x, -np.sqrt(RADIUS ** 2 - x ** 2 - z ** 2), z], axis=1) / RADIUS
        return np.array([0.0, SIZE[1] + RADIUS, 0.0]) + direction * (0.02 + 0.01 * c)[:, None]
    return mesh.Block((n, n, 1), place, curved=True)


def deck(n, law=ccx.stable_neo_hookean, stiffness=1e9):
    b, rigid = block(n), ball()
    count, cells = len(b.points), len(b.elements)
    tops = [f"{e},S2" for e in range(cells + 1 - n * n, cells + 1)]
    outer = [f"{e},S2" for e in range(cells + 1, cells + len(rigid.elements) + 1)]
    text = (b.deck() + mesh.nodes_deck(rigid.points, count + 1, "BALL") +
            mesh.elements_deck(rigid.elements + count, "C3D20", "SHELL", cells + 1) +
            ccx.node_set("BOTTOM", b.side(2, 0)) + ccx.section(law, YOUNG, POISSON) +
            ccx.section(ccx.ciarlet, 1e9, 0.3, "SHELL") +
            "*SURFACE,NAME=TOP\n" + "\n".join(tops) + "\n*SURFACE,NAME=SPHERE\n" +
            "\n".join(outer) + "\n*SURFACE INTERACTION,NAME=CONTACT\n"
            f"*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR\n{stiffness}\n"
            "*CONTACT PAIR,INTERACTION=CONTACT,TYPE=SURFACE TO SURFACE\nTOP,SPHERE\n"
            "*BOUNDARY\nBOTTOM,1,3\n" + mesh.held(b.side(0, 0), 3) + mesh.held(b.side(1, 0), 1))
    return text + ccx.static_step(f"*BOUNDARY\nBALL,1,1\nBALL,2,2,{-DEPTH}\nBALL,3,3\n"
                                  "*NODE PRINT,NSET=BALL,FREQUENCY=2000\nRF\n", law, 0.05, 0.1)


def by_calculix(runner, n):
    forces = runner.run(f"indentation-{n}", deck(n)).last("forces", "BALL")
    return (-4.0 * sum(f[1] for f in forces.values()),)


def by_fem(n, stiffness=1e9, reduced=True):
    b = block(n)
    bar = Bar(b, YOUNG, POISSON, reduced)
    bar.obstacle = Sphere(b, stiffness)
    free = np.ones(b.points.shape, bool)
    free[b.side(2, 0) - 1] = False
    free[b.side(0, 0) - 1, 2] = free[b.side(1, 0) - 1, 0] = False
    x = b.points.copy()
    for step in range(1, STEPS + 1):
        bar.obstacle.centre[1] = SIZE[1] + RADIUS - DEPTH * step / STEPS
        x = bar.minimise(x, free, np.zeros_like(x))
    return (bar.obstacle.lift(x),)


def values(runner):
    sizes = (4, 6, 8)
    found = [runner.remember(f"indentation-fem-{n}", lambda n=n: by_fem(n))[0] for n in sizes]
    value = extrapolate("", "force", sizes, found, "n = {}")
    value.meshes = {"n = 4, CalculiX": by_calculix(runner, 4)[0], **value.meshes}
    yield value


CASES = {"indentation": (SOURCE, values, "indentation-4")}
