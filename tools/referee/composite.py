"""Bodies of two materials: two bars, a stiff cube within a soft one, skin on fat."""

import numpy as np

from . import mesh
from .fem import Bar
from .values import extrapolate

SOURCE = "quadratic hexahedra with the same energy (tools/referee/fem.py), extrapolated"


def towards(share, grading, *borders):
    """Shares in [0, 1] moved towards 0, 1 and the borders between."""
    ends = [0.0, *borders, 1.0]
    out = np.array(share, dtype=float)
    for low, high in zip(ends[:-1], ends[1:]):
        inside = (share >= low) & (share <= high)
        local = (share[inside] - low) / (high - low)
        out[inside] = low + (high - low) * mesh.both_ends(local, grading)
    return out


def centroids(block):
    return block.points[block.elements[:, :8] - 1].mean(axis=1)


def solve(block, young, poisson, held, moved, steps=2):
    """The forces of rest [N] (nodes, 3), and the displacements. held: [(ids, axis)]; moved:
    (ids, displacement), all three components of it but those that are None."""
    bar = Bar(block, young, poisson)
    free = np.ones(block.points.shape, bool)
    for ids, axis in held:
        free[ids - 1, axis] = False
    ids, displacement = moved
    x = block.points.copy()
    for _ in range(steps):
        for axis, distance in enumerate(displacement):
            if distance is None:
                continue
            free[ids - 1, axis] = False
            x[ids - 1, axis] += distance / steps
        x = bar.minimise(x, free, np.zeros_like(x))
    return bar.force(x), x - block.points


def all_axes(ids):
    return [(ids, 0), (ids, 1), (ids, 2)]


# ---- two bars ----

STIFF, SOFT = 100e3, 10e3


def bars(n, variant):
    """Force on the pulled end of a bar of 0.04 x 0.04 x 0.16 m; the half x > 0."""
    def place(a, b, c):
        return np.stack([0.02 * a ** (1 / 1.5), 0.04 * towards(b, 1.5, 0.5) - 0.02,
                         0.16 * towards(c, 1.8, 0.5)], axis=1)
    block = mesh.Block((n // 2, n, 2 * n), place)
    y, z = centroids(block)[:, 1:].T
    young, poisson = SOFT, 0.45
    if variant == "side by side":
        young = np.where(y > 0.0, STIFF, SOFT)
    elif variant == "end to end":
        young = np.where(z > 0.08, STIFF, SOFT)
    else:
        poisson = np.where(y > 0.0, 0.499, 0.3)
    end = block.side(2, -1)
    force, _ = solve(block, young, poisson, all_axes(block.side(2, 0)) + [(block.side(0, 0), 0)],
                     (end, (0.0, 0.0, 0.016)))
    return (2.0 * force[end - 1, 2].sum(),)


def two_bars(runner):
    for variant in ("side by side", "end to end", "nu 0.3 and 0.499"):
        found = [runner.remember(f"bars-{variant.replace(' ', '-')}-{n}",
                                 lambda n=n, v=variant: bars(n, v))[0] for n in (4, 6, 8)]
        yield extrapolate(variant, "force", (4, 6, 8), found, "n = {}")


# ---- a stiff cube within a soft one ----

def inclusion_of(n, stiff):
    """Force of the upper plate, and how far the middle of a free side bulges; an eighth."""
    def place(a, b, c):
        return 0.04 * np.stack([towards(s, 1.5, 0.5) for s in (a, b, c)], axis=1)
    block = mesh.Block((n, n, n), place)
    young = np.where((centroids(block) < 0.02).all(axis=1), stiff, 10e3)
    top = block.side(1, -1)
    force, u = solve(block, young, 0.45, [(block.side(axis, 0), axis) for axis in range(3)],
                     (top, (0.0, -0.004, 0.0)))
    return 4.0 * force[top - 1, 1].sum(), u[block.index[-1, 0, 0] - 1, 0]


def inclusion(runner):
    for ratio in (10, 1000):
        sizes = (4, 6, 8)
        found = [runner.remember(f"inclusion-{ratio}-{n}",
                                 lambda n=n, r=ratio: inclusion_of(n, 10e3 * r)) for n in sizes]
        for quantity, values in zip(("force", "bulge"), zip(*found)):
            yield extrapolate(f"{ratio} times as stiff", quantity, sizes, values, "n = {}")


# ---- skin on fat ----

SKIN, FAT = 150e3, 5e3


def skin_of(n):
    """Force on a plate of 16 x 16 mm glued to the skin and pushed in by 4 mm, and how far the skin
    sinks 16 mm from its middle; a quarter."""
    def place(a, b, c):
        return np.stack([0.04 * towards(a, 1.5, 0.2), 0.022 * towards(b, 1.5, 10.0 / 11.0),
                         0.04 * towards(c, 1.5, 0.2)], axis=1)
    # Cells of 0.2 in a and c: the plate's edge is a border of cells; so is the skin's lower side.
    block = mesh.Block((5 * n, 11, 5 * n), place)
    young = np.where(centroids(block)[:, 1] > 0.02, SKIN, FAT)
    top = block.side(1, -1)
    below = np.abs(block.points[top - 1][:, [0, 2]]).max(axis=1) < 0.008 * (1 + 1e-9)
    plate = top[below]
    force, u = solve(block, young, 0.45,
                     all_axes(block.side(1, 0)) + [(block.side(0, 0), 0), (block.side(2, 0), 2)],
                     (plate, (0.0, -0.004, 0.0)))
    edge = block.index[:, -1, 0]
    edge = edge[edge > 0] - 1
    beside = np.interp(0.016, block.points[edge, 0], u[edge, 1])
    return 4.0 * force[plate - 1, 1].sum(), beside


def skin(runner):
    sizes = (1, 2)
    found = [runner.remember(f"skin-{n}", lambda n=n: skin_of(n)) for n in sizes]
    for quantity, values in zip(("force", "beside"), zip(*found)):
        yield extrapolate("", quantity, sizes, values, "n = {}")


CASES = {"two_bars": (SOURCE, two_bars, None), "inclusion": (SOURCE, inclusion, None),
         "skin": (SOURCE, skin, None)}
