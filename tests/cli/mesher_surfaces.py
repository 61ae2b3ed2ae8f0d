"""Surfaces, good and bad, for the test of sinew-mesh: lists of nodes and of polygons."""

import math
import random
import struct


def ball(radius=1.0, centre=(0.0, 0.0, 0.0), level=3):
    """An icosahedron whose triangles are split `level` times, on a sphere."""
    g = (1 + math.sqrt(5)) / 2
    nodes = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g),
             (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4),
             (11, 10, 2), (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8),
             (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(level):
        middle = {}

        def between(a, b):
            key = (min(a, b), max(a, b))
            if key not in middle:
                middle[key] = len(nodes)
                nodes.append(tuple((nodes[a][i] + nodes[b][i]) / 2 for i in range(3)))
            return middle[key]

        split = []
        for a, b, c in faces:
            ab, bc, ca = between(a, b), between(b, c), between(c, a)
            split += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = split
    out = []
    for p in nodes:
        length = math.sqrt(sum(v * v for v in p))
        out.append(tuple(centre[i] + radius * p[i] / length for i in range(3)))
    return out, faces


def box(size=(1.0, 1.0, 1.0), origin=(0.0, 0.0, 0.0)):
    """Six quadrilaterals that look outwards; the lid (largest z) comes last."""
    nodes = [tuple(origin[i] + size[i] * (c >> i & 1) for i in range(3)) for c in range(8)]
    return nodes, [(0, 2, 3, 1), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6),
                   (4, 5, 7, 6)]


def grid(n, m, place, wrap_u=True, wrap_v=True, twist=False):
    """n x m quadrilaterals of place(i/n, j/m), closed in u, in v; twist: v runs back after u."""
    nodes = [place(i / n, j / m) for i in range(n + (not wrap_u)) for j in range(m + (not wrap_v))]
    rows = m + (not wrap_v)

    def at(i, j):
        if wrap_u and i == n:
            i, j = 0, ((m - j) if twist else j)
        return i * rows + (j % m if wrap_v else j)

    return nodes, [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1))
                   for i in range(n) for j in range(m)]


def torus(big=1.0, small=0.35):
    def place(u, v):
        u, v = 2 * math.pi * u, 2 * math.pi * v
        r = big + small * math.cos(v)
        return r * math.cos(u), r * math.sin(u), small * math.sin(v)
    return grid(48, 20, place)


def klein():
    """A Klein bottle (figure of eight): closed, with one side only."""
    def place(u, v):
        u, v = 2 * math.pi * u, 2 * math.pi * v
        w = math.cos(u / 2) * math.sin(v) - math.sin(u / 2) * math.sin(2 * v)
        return ((2 + w) * math.cos(u), (2 + w) * math.sin(u),
                math.sin(u / 2) * math.sin(v) + math.cos(u / 2) * math.sin(2 * v))
    return grid(40, 24, place, twist=True)


def moebius():
    def place(u, v):
        u, w = 2 * math.pi * u, v - 0.5
        r = 1 + w * math.cos(u / 2)
        return r * math.cos(u), r * math.sin(u), w * math.sin(u / 2)
    return grid(60, 6, place, wrap_v=False, twist=True)


def spike(height=4.0, radius=0.25, n=24):
    """A cone with a needle's tip."""
    nodes = [(radius * math.cos(2 * math.pi * i / n), radius * math.sin(2 * math.pi * i / n), 0.0)
             for i in range(n)] + [(0.0, 0.0, 0.0), (0.0, 0.0, height)]
    return nodes, [f for i in range(n) for f in [((i + 1) % n, i, n), (i, (i + 1) % n, n + 1)]]


def join(*surfaces):
    nodes, faces = [], []
    for more, polygons in surfaces:
        faces += [tuple(i + len(nodes) for i in f) for f in polygons]
        nodes += more
    return nodes, faces


def moved(surface, factor=1.0, shift=(0.0, 0.0, 0.0)):
    nodes, faces = surface
    return [tuple(factor * p[i] + shift[i] for i in range(3)) for p in nodes], faces


def without(surface, gone):
    nodes, faces = surface
    return nodes, [f for f in faces if not gone([nodes[i] for i in f])]


def reversed_at_random(surface, seed=1):
    chance = random.Random(seed)
    nodes, faces = surface
    return nodes, [f[::-1] if chance.random() < 0.5 else f for f in faces]


def split_corners(surface, noise=0.0, seed=1):
    """Every face with corners of its own, off by at most `noise`."""
    chance = random.Random(seed)
    nodes, faces = surface
    out = [tuple(v + noise * (2 * chance.random() - 1) for v in nodes[i]) for f in faces for i in f]
    ends, at = [], 0
    for f in faces:
        ends.append(tuple(range(at, at + len(f))))
        at += len(f)
    return out, ends


def ball_with_wall():
    """A ball with a disc across its middle."""
    n, m = 32, 16
    nodes = [(0.0, 0.0, -1.0), (0.0, 0.0, 1.0)]
    for j in range(1, m):
        a = math.pi * j / m - math.pi / 2
        nodes += [(math.cos(a) * math.cos(2 * math.pi * i / n),
                   math.cos(a) * math.sin(2 * math.pi * i / n), math.sin(a)) for i in range(n)]

    def at(j, i):
        return 0 if j == 0 else 1 if j == m else 2 + (j - 1) * n + i % n

    faces = []
    for j in range(m):
        for i in range(n):
            f = [at(j, i), at(j, i + 1), at(j + 1, i + 1), at(j + 1, i)]
            faces.append(tuple(dict.fromkeys(f)))
    centre = len(nodes)
    nodes.append((0.0, 0.0, 0.0))
    faces += [(at(m // 2, i), at(m // 2, i + 1), centre) for i in range(n)]
    return nodes, faces


def dented_ball():
    """A ball with a dent that comes out on the other side: one part that crosses itself."""
    nodes, faces = ball(level=3)
    out = []
    for x, y, z in nodes:
        r = math.hypot(x, y)
        out.append((x, y, z - 2.6 * math.exp(-(r / 0.25) ** 2) if z > 0 else z))
    return out, faces


def random_triangles(n=60, seed=2):
    chance = random.Random(seed)
    nodes = [tuple(chance.random() for _ in range(3)) for _ in range(3 * n)]
    return nodes, [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(n)]


def write(path, surface):
    """By the ending: .off, .obj, .ply (text, or binary for .bin.ply), .stl (binary, or text for
    .text.stl)."""
    nodes, faces = surface
    name = str(path)
    if name.endswith(".off"):
        text = f"OFF\n{len(nodes)} {len(faces)} 0\n"
        text += "".join("%r %r %r\n" % p for p in nodes)
        text += "".join(f"{len(f)} {' '.join(map(str, f))}\n" for f in faces)
        path.write_text(text)
    elif name.endswith(".obj"):
        text = "# a surface\no thing\n" + "".join("v %r %r %r\n" % p for p in nodes)
        text += "".join("f " + " ".join(f"{i + 1}//1" for i in f) + "\n" for f in faces)
        path.write_text(text)
    elif name.endswith(".ply"):
        binary = name.endswith(".bin.ply")
        head = ("ply\nformat %s 1.0\ncomment a surface\nelement vertex %d\nproperty double x\n"
                "property double y\nproperty double z\nelement face %d\n"
                "property list uchar int vertex_indices\nend_header\n" %
                ("binary_big_endian" if binary else "ascii", len(nodes), len(faces)))
        if binary:
            body = b"".join(struct.pack(">3d", *p) for p in nodes)
            body += b"".join(struct.pack(f">B{len(f)}i", len(f), *f) for f in faces)
            path.write_bytes(head.encode() + body)
        else:
            body = "".join("%r %r %r\n" % p for p in nodes)
            body += "".join(f"{len(f)} {' '.join(map(str, f))}\n" for f in faces)
            path.write_text(head + body)
    else:
        triangles = [(f[0], f[k], f[k + 1]) for f in faces for k in range(1, len(f) - 1)]
        if name.endswith(".text.stl"):
            text = "solid a surface\n"
            for t in triangles:
                text += "facet normal 0 0 0\nouter loop\n"
                text += "".join("vertex %r %r %r\n" % nodes[i] for i in t)
                text += "endloop\nendfacet\n"
            path.write_text(text + "endsolid a surface\n")
        else:
            body = b"".join(struct.pack("<12fH", 0, 0, 0, *nodes[a], *nodes[b], *nodes[c], 0)
                            for a, b, c in triangles)
            path.write_bytes(b"solid".ljust(80) + struct.pack("<I", len(triangles)) + body)
    return path
