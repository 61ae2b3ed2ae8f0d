"""Quadratic meshes for ccx: structured blocks of 20-node hexahedra, 10-node tetrahedra."""

import numpy as np

# Corners of a hexahedron in ccx's order, as steps along i, j, k; then the ends of its edges.
CORNERS = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0),
                    (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)])
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4),
         (0, 4), (1, 5), (2, 6), (3, 7)]
# Of a 10-node tetrahedron.
TET_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]


class Block:
    """20-node hexahedra on a lattice. Node ids count from 1; `index[i, j, k]` is the id at the
    lattice's half steps, 0 where a serendipity element has no node."""

    def __init__(self, cells, place, curved=False):
        """cells: hexahedra along i, j, k. place(a, b, c) maps arrays of shares in [0, 1] to points
        (n, 3): the corners; the middles of edges too where they are curved."""
        nx, ny, nz = cells
        self.cells = cells
        half = np.stack(np.meshgrid(*(np.arange(2 * n + 1) for n in cells), indexing="ij"), -1)
        used = (half % 2).sum(-1) <= 1
        self.index = np.zeros(used.shape, dtype=int)
        self.index[used] = np.arange(1, used.sum() + 1)
        lattice = half[used]
        low, high = lattice // 2, (lattice + 1) // 2  # the ends of a mid-side node's edge
        share = np.array(cells, dtype=float)
        self.points = (place(*(low / share).T) + place(*(high / share).T)) / 2.0
        if curved:
            self.points = place(*(lattice / (2.0 * share)).T)
        # Elements in layers: k counts slowest.
        first = np.stack(np.meshgrid(*(np.arange(n) for n in cells), indexing="ij"), -1)
        first = 2 * first.transpose(2, 1, 0, 3).reshape(-1, 3)
        offsets = [2 * c for c in CORNERS] + [CORNERS[a] + CORNERS[b] for a, b in EDGES]
        self.elements = np.stack([self.index[tuple((first + o).T)] for o in offsets], axis=1)

    def side(self, axis, end):
        """Ids on a side of the block: axis 0..2, end 0 or -1."""
        ids = np.take(self.index, end, axis=axis)
        return ids[ids > 0]

    def side_weights(self, axis, end):
        """{id: share of the side's area integral}, by the shape functions of its 8-node faces."""
        ids = np.take(self.index, end, axis=axis)
        points = np.zeros((*ids.shape, 3))
        points[ids > 0] = self.points[ids[ids > 0] - 1]
        weights = {}
        for i in range(0, ids.shape[0] - 1, 2):
            for j in range(0, ids.shape[1] - 1, 2):
                corners = [(i, j), (i + 2, j), (i + 2, j + 2), (i, j + 2)]
                mids = [(i + 1, j), (i + 2, j + 1), (i + 1, j + 2), (i, j + 1)]
                diagonals = [points[corners[n + 2]] - points[corners[n]] for n in (0, 1)]
                area = np.linalg.norm(np.cross(*diagonals)) / 2.0
                for places, share in ((corners, -1.0 / 12.0), (mids, 1.0 / 3.0)):
                    for place in places:
                        node = int(ids[place])
                        weights[node] = weights.get(node, 0.0) + share * area
        total = sum(weights.values())
        return {node: weight / total for node, weight in weights.items()}

    def deck(self, kind="C3D20R"):
        return nodes_deck(self.points) + elements_deck(self.elements, kind)


def mean(table, weights, axis):
    """The weighted mean of one component of a table of ccx."""
    return sum(weight * table[node][axis] for node, weight in weights.items())


def nodes_deck(points, first=1, name="ALL"):
    return f"*NODE,NSET={name}\n" + "".join(
        f"{i},{p[0]:.12e},{p[1]:.12e},{p[2]:.12e}\n" for i, p in enumerate(points, first))


def elements_deck(elements, kind, name="BODY", first=1):
    lines = [f"*ELEMENT,TYPE={kind},ELSET={name}"]
    for number, nodes in enumerate(elements, first):
        ids = [str(number), *(str(n) for n in nodes)]
        lines += [",".join(ids[:11]) + ("," if len(ids) > 11 else "")]
        lines += [",".join(ids[11:])] if len(ids) > 11 else []
    return "\n".join(lines) + "\n"


def box(low, high):
    """A place function of a box."""
    low, high = np.array(low), np.array(high)
    return lambda a, b, c: low + np.stack([a, b, c], axis=1) * (high - low)


def both_ends(share, grading):
    """Shares in [0, 1] moved towards 0 and 1."""
    side = 2.0 * share - 1.0
    return 0.5 + 0.5 * np.sign(side) * (1.0 - (1.0 - np.abs(side)) ** grading)


def prescribed(nodes, moves):
    """Lines of *BOUNDARY: each node's displacement, all three components."""
    return "".join(f"{n},{i + 1},{i + 1},{m[i]:.12e}\n" for n, m in zip(nodes, moves)
                   for i in range(3))


def held(nodes, axis):
    """Lines of *BOUNDARY: one component of each node held; axis 1 to 3."""
    return "".join(f"{n},{axis},{axis}\n" for n in nodes)
