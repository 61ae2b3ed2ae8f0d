#!/usr/bin/python3
"""Computes tests/data/c3d4.txt: the solution of CalculiX for a small jittered block of its linear
tetrahedra (C3D4), linear elastic, held at one end and pulled sideways at single nodes. The test
forces/linear_tet_test.cpp compares the law neo-hookean with beta = 1 and a cell per tet with it.

Needs python3-numpy and ccx (Debian: calculix-ccx).
"""

import pathlib
import tempfile

import numpy as np

from referee import ccx, mesh

YOUNG, POISSON = 15e3, 0.4
CELLS, EDGE = (2, 2, 3), 0.05  # [m]
FORCE = np.array([1e-6, -2e-6, 0.5e-6])  # [N] on every free node of the far end, in turn reversed
TARGET = pathlib.Path(__file__).resolve().parent.parent / "tests" / "data" / "c3d4.txt"


def block():
    """Points (n, 3) and tets (m, 4), counted from 0: six to a cube, inner coordinates jittered."""
    lattice = np.stack(np.meshgrid(*(np.arange(n + 1) for n in CELLS), indexing="ij"), -1)
    count = np.array(lattice.shape[:3])
    index = np.arange(np.prod(count)).reshape(count)
    points = EDGE * lattice.reshape(-1, 3).astype(float)
    points += 0.25 * EDGE * (np.random.default_rng(1).random(points.shape) - 0.5)
    points = np.round(points, 6)
    tets = []
    for cell in np.ndindex(*CELLS):
        for order in ((0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)):
            corner, ids = np.array(cell), [index[cell]]
            for axis in order:
                corner = corner + np.eye(3, dtype=int)[axis]
                ids.append(index[tuple(corner)])
            edges = points[ids[1:]] - points[ids[0]]
            tets.append(ids if np.linalg.det(edges) > 0 else [ids[0], ids[2], ids[1], ids[3]])
    return points, np.array(tets), index[:, :, 0].ravel(), index[:, :, -1].ravel()


def main():
    points, tets, held, pulled = block()
    forces = {node: FORCE * (1 if n % 2 == 0 else -0.5) for n, node in enumerate(pulled)}
    loads = "".join(f"{node + 1},{axis + 1},{value:.12e}\n"
                    for node, force in forces.items() for axis, value in enumerate(force))
    deck = (mesh.nodes_deck(points) + mesh.elements_deck(tets + 1, "C3D4") +
            ccx.node_set("HELD", held + 1) + ccx.section(ccx.linear_elastic, YOUNG, POISSON) +
            "*BOUNDARY\nHELD,1,3\n*STEP\n*STATIC\n*CLOAD\n" + loads +
            "*NODE PRINT,NSET=ALL\nU\n*END STEP\n")
    with tempfile.TemporaryDirectory() as scratch:
        moved = ccx.Runner(scratch).run("c3d4", deck).last("displacements", "ALL")
    with open(TARGET, "w", encoding="utf-8") as out:
        out.write("# Written by tools/referee_c3d4.py with CalculiX 2.20: C3D4, linear elastic.\n"
                  f"# E [Pa], nu; counts of nodes and tets\n{YOUNG} {POISSON}\n"
                  f"{len(points)} {len(tets)}\n"
                  "# x y z [m], 1 where held, force [N], displacement of CalculiX [m]\n")
        for node, point in enumerate(points):
            row = [*point, int(node in held), *forces.get(node, np.zeros(3)), *moved[node + 1]]
            out.write(" ".join(f"{value:.9g}" for value in row) + "\n")
        out.write("# tets, nodes counted from 0\n")
        for tet in tets:
            out.write(" ".join(str(node) for node in tet) + "\n")


if __name__ == "__main__":
    main()
