"""The liver of scenes/liver.toml at rest under its own weight, by 10-node tetrahedra."""

import pathlib

import numpy as np

from . import ccx, mesh
from .values import Value

SOURCE = ("CalculiX 2.20, 10-node tetrahedra on the scene's mesh (straight sides); corrected by what "
          "linear elasticity changes on the same mesh with every tetrahedron cut into eight")
ROOT = pathlib.Path(__file__).resolve().parents[2]
MESH = ROOT / "scenes" / "meshes" / "liver-10mm.mesh"
YOUNG = {1: 30e3, 2: 50e3, 3: 10e3}  # [Pa], by label
POISSON = 0.45
TOLERANCE = 1e-9  # of places, times the diagonal


def read_medit(path):
    """Nodes (n, 3), tets (t, 4) from 0, labels (t) of an ASCII MEDIT file."""
    words = path.read_text().split()

    def section(name, width):
        at = words.index(name)
        count = int(words[at + 1])
        return np.array(words[at + 2:at + 2 + count * width], dtype=float).reshape(count, width)

    tets = section("Tetrahedra", 5).astype(int)
    return section("Vertices", 4)[:, :3], tets[:, :4] - 1, tets[:, 4]


def volumes(points, tets):
    a, b, c, d = (points[tets[:, i]] for i in range(4))
    return np.einsum("ti,ti->t", np.cross(b - a, c - a), d - a) / 6.0


def placed(points, tets):
    """As the scene places it: metres, the centroid at the origin, turned by -90 degrees about x."""
    share = volumes(points, tets)
    centre = (share[:, None] * points[tets].mean(axis=1)).sum(axis=0) / share.sum()
    x, y, z = (0.001 * (points - centre)).T
    return np.stack([x, z, -y], axis=1)


class TetMesh:
    """Straight-sided tets; `pinned` (nodes): held."""

    def __init__(self, points, tets, labels):
        self.points, self.labels = points, labels
        self.tets = np.where((volumes(points, tets) < 0.0)[:, None], tets[:, [1, 0, 2, 3]], tets)
        ends = np.sort(np.concatenate([self.tets[:, list(e)] for e in mesh.TET_EDGES]), axis=1)
        self.edges, back = np.unique(ends, axis=0, return_inverse=True)
        self.edge_of_tet = back.reshape(6, -1).T  # (tets, 6)
        faces = np.sort(np.concatenate([np.delete(self.tets, i, axis=1) for i in range(4)]), axis=1)
        faces, count = np.unique(faces, axis=0, return_counts=True)
        self.outside = faces[count == 1]
        self.pinned = np.zeros(len(points), dtype=bool)

    def surface_edges(self):
        """(edges): on the surface."""
        ends = np.concatenate([self.outside[:, [i, j]] for i, j in ((0, 1), (0, 2), (1, 2))])
        keys = self.edges[:, 0] * len(self.points) + self.edges[:, 1]
        return np.isin(keys, ends[:, 0] * len(self.points) + ends[:, 1])

    def middles_pinned(self):
        """(edges): both ends are pinned, and the edge is on the surface."""
        return self.surface_edges() & self.pinned[self.edges].all(axis=1)

    def with_middles(self):
        """Nodes and 10-node tets from 0, and which nodes are pinned."""
        points = np.concatenate([self.points, self.points[self.edges].mean(axis=1)])
        tets = np.concatenate([self.tets, len(self.points) + self.edge_of_tet], axis=1)
        return points, tets, np.concatenate([self.pinned, self.middles_pinned()])

    def subdivided(self):
        """Every tet cut into eight, around the shortest diagonal of its inner octahedron."""
        points, ten, pinned = self.with_middles()
        a, b, c, d, ab, bc, ca, ad, bd, cd = ten.T
        corners = [(a, ab, ca, ad), (ab, b, bc, bd), (ca, bc, c, cd), (ad, bd, cd, d)]
        # A diagonal and the four others in order around it.
        choices = [((ab, cd), (bc, ca, ad, bd)), ((bc, ad), (ca, ab, bd, cd)),
                   ((ca, bd), (ab, bc, cd, ad))]
        length = np.stack([np.linalg.norm(points[p] - points[q], axis=1)
                           for (p, q), _ in choices])
        best = length.argmin(axis=0)
        inner = []
        for side in range(4):
            tet = np.empty((len(ten), 4), dtype=int)
            for n, ((p, q), ring) in enumerate(choices):
                rows = best == n
                tet[rows] = np.stack([p, q, ring[side], ring[(side + 1) % 4]], axis=1)[rows]
            inner.append(tet)
        tets = np.concatenate([np.stack(t, axis=1) for t in corners] + inner)
        finer = TetMesh(points, tets, np.tile(self.labels, 8))
        finer.pinned = pinned
        return finer


def load():
    """The scene's body, its pins set, and the nodes of its two probes."""
    points, tets, labels = read_medit(MESH)
    points = placed(points, tets)
    body = TetMesh(points, tets, labels)
    low, high = points.min(axis=0), points.max(axis=0)
    slack = TOLERANCE * np.linalg.norm(high - low)
    body.pinned[np.unique(body.outside)] = True
    body.pinned &= points[:, 2] <= low[2] + 0.08 + slack
    used = np.isin(np.arange(len(points)), tets)
    return body, {"front_y": np.flatnonzero(used & (points[:, 2] >= high[2] - 0.005 - slack)),
                  "left_tip_y": np.flatnonzero(used & (points[:, 0] >= high[0] - 0.01 - slack))}


def deck(body, probes, law):
    points, tets, pinned = body.with_middles()
    text = mesh.nodes_deck(points)
    first = 1
    for label in YOUNG:
        chosen = tets[body.labels == label] + 1
        text += mesh.elements_deck(chosen, "C3D10", f"REGION{label}", first)
        first += len(chosen)
    text += ccx.node_set("BACK", np.flatnonzero(pinned) + 1)
    text += ccx.node_set("PROBES", np.unique(np.concatenate(list(probes.values()))) + 1)
    for label, young in YOUNG.items():
        text += ccx.section(law, young, POISSON, f"REGION{label}")
    loads = "*DLOAD\n" + "".join(f"REGION{label},GRAV,{ccx.GRAVITY},0.,-1.,0.\n" for label in YOUNG)
    loads += "*NODE PRINT,NSET=PROBES,FREQUENCY=2000\nU\n"
    text += "*BOUNDARY\nBACK,1,3\n"
    if law is ccx.linear_elastic:
        return text + f"*STEP\n*STATIC,SOLVER=ITERATIVE CHOLESKY\n{loads}*END STEP\n"
    return text + ccx.static_step(loads, law, 0.2, 0.4, "SPOOLES")


def by_calculix(runner, name, body, probes, law):
    table = runner.run(name, deck(body, probes, law)).last("displacements", "PROBES")
    return {quantity: float(np.mean([table[n + 1][1] for n in nodes]))
            for quantity, nodes in probes.items()}


def values(runner):
    body, probes = load()
    finer = body.subdivided()
    found = by_calculix(runner, "liver-1", body, probes, ccx.stable_neo_hookean)
    coarse = by_calculix(runner, "liver-linear-1", body, probes, ccx.linear_elastic)
    fine = by_calculix(runner, "liver-linear-2", finer, probes, ccx.linear_elastic)
    for quantity in probes:
        # Quadratic elements on a smooth part: the error falls by 2^2 at least. The rest of it
        # on the scene's mesh is taken to be the same share as in linear elasticity.
        share = 4.0 / 3.0 * (fine[quantity] / coarse[quantity] - 1.0)
        value = found[quantity] * (1.0 + share)
        yield Value("", quantity, value, abs(value - found[quantity]),
                    {"10 mm": found[quantity], "10 mm, linear": coarse[quantity],
                     "5 mm, linear": fine[quantity]})


CASES = {"liver": (SOURCE, values, None)}
