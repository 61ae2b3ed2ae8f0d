"""Cook's membrane in three dimensions, nearly incompressible."""

import numpy as np

from . import ccx, mesh
from .liver import ROOT, volumes
from .fem import Bar
from .values import extrapolate

SOURCE = ("CalculiX 2.20, 20-node hexahedra, n = 8, 12, 16 cells along and across, extrapolated")
YOUNG, POISSON = 240e3, 0.499
TRACTION = 5000.0  # [Pa], along y on the end x = 0.048
THICKNESS = 0.01


def place(across, through, along):
    """The membrane's points from shares along y, z, x."""
    low, high = 0.044 * along, 0.044 + 0.016 * along
    return np.stack([0.048 * along, low + across * (high - low), THICKNESS * through], axis=1)


def block(n, grading=1.5):
    """The half z < 0.005, n cells across and along, graded towards the clamp, the two long edges
    and the free face."""
    def graded(a, b, c):
        return place(mesh.both_ends(a, grading), b ** grading / 2.0, c ** grading)
    return mesh.Block((n, max(1, n // 4), n), graded)


def loads(b):
    """{node: force along y [N]} of the half."""
    total = TRACTION * 0.016 * THICKNESS / 2.0
    return {node: w * total for node, w in b.side_weights(2, -1).items()}


def edge_weights(b):
    """{node: share} of the mean over the half edge x = 0.048, y = 0.060 (Simpson)."""
    ids = b.index[-1, :, -1]
    z = b.points[ids - 1, 2]
    weights = dict.fromkeys(ids.tolist(), 0.0)
    for i in range(0, len(ids) - 1, 2):
        for j, share in ((i, 1.0 / 6.0), (i + 1, 4.0 / 6.0), (i + 2, 1.0 / 6.0)):
            weights[int(ids[j])] += share * (z[i + 2] - z[i]) / (THICKNESS / 2.0)
    return weights


def deck(n, law=ccx.ciarlet):
    b = block(n)
    text = (b.deck() + ccx.node_set("CLAMP", b.side(2, 0)) + ccx.node_set("MIDDLE", b.side(1, -1)) +
            ccx.node_set("EDGE", b.index[-1, :, -1]) + ccx.section(law, YOUNG, POISSON) +
            "*BOUNDARY\nCLAMP,1,3\nMIDDLE,3,3\n")
    forces = "".join(f"{node},2,{force:.12e}\n" for node, force in loads(b).items())
    return text + ccx.static_step("*CLOAD\n" + forces + "*NODE PRINT,NSET=EDGE,FREQUENCY=2000\nU\n",
                                  law, 0.25, 0.25)


def by_calculix(runner, n):
    table = runner.run(f"cook-{n}", deck(n)).last("displacements", "EDGE")
    return (mesh.mean(table, edge_weights(block(n)), 1),)


def by_fem(n, reduced=True):
    b = block(n)
    bar = Bar(b, YOUNG, POISSON, reduced)
    free = np.ones(b.points.shape, bool)
    free[b.side(1, -1) - 1, 2] = free[b.side(2, 0) - 1] = False
    load = np.zeros_like(b.points)
    for node, force in loads(b).items():
        load[node - 1, 1] = force
    x = b.points.copy()
    for step in (1, 2):
        x = bar.minimise(x, free, load * step / 2.0)
    return (sum(w * (x[n - 1, 1] - b.points[n - 1, 1]) for n, w in edge_weights(b).items()),)


def tet_mesh(cells):
    """Nodes and tets, from 0, of the whole membrane: five tets a cell, mirrored in every other."""
    lattice = np.stack(np.meshgrid(*(np.arange(n + 1) for n in cells), indexing="ij"), -1)
    index = np.arange(lattice[..., 0].size).reshape(lattice.shape[:3])
    along, across, through = (lattice / np.array(cells)).reshape(-1, 3).T
    points = place(across, through, along)
    bits = np.array([(b & 1, b >> 1 & 1, b >> 2) for b in range(8)])
    five = np.array([(0, 1, 3, 5), (0, 3, 2, 6), (0, 5, 6, 4), (3, 6, 5, 7), (0, 3, 6, 5)])
    tets = []
    for cell in np.ndindex(*cells):
        corners = bits ^ (np.array([1, 0, 0]) if sum(cell) % 2 else 0)
        tets.append(index[tuple((np.array(cell) + corners).T)][five])
    tets = np.concatenate(tets)
    swapped = volumes(points, tets) < 0.0
    tets[swapped] = tets[swapped][:, [0, 1, 3, 2]]
    return points, tets


def write_meshes(folder):
    """The meshes for Sinew, MEDIT in ASCII."""
    folder.mkdir(parents=True, exist_ok=True)
    for number, cells in enumerate(((4, 4, 1), (8, 8, 2), (16, 16, 4)), 1):
        points, tets = tet_mesh(cells)
        lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(points))]
        lines += [" ".join(f"{v:.12g}" for v in p) + " 0" for p in points]
        lines += ["Tetrahedra", str(len(tets))]
        lines += [" ".join(str(n + 1) for n in t) + " 0" for t in tets]
        (folder / f"cook-{number}.mesh").write_text("\n".join(lines + ["End", ""]))


def values(runner):
    write_meshes(ROOT / "validation" / "cook" / "meshes")
    answers = {n: by_calculix(runner, n)[0] for n in (4, 8, 12, 16)}
    value = extrapolate("", "tip", (8, 12, 16), [answers[n] for n in (8, 12, 16)])
    value.meshes = {f"n = {n}": answer for n, answer in answers.items()}
    for n in (4, 8):
        value.meshes[f"n = {n}, fem.py"] = runner.remember(f"cook-fem-{n}", lambda n=n: by_fem(n))[0]
    yield value


CASES = {"cook": (SOURCE, values, "cook-4")}
