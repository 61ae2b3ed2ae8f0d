#!/usr/bin/python3
"""Writes scenes/meshes/bowl.off: a bowl with a wall, closed, for obstacles of shape "mesh".

    tools/make_bowl.py > scenes/meshes/bowl.off

Its inside is a part of a sphere of radius 0.3 m about (0, 0.3, 0): the lowest point of it is the
origin, and it opens upwards (y) to 75 degrees from there. The wall is 20 mm thick.
"""

from math import cos, pi, radians, sin

RADIUS, WALL, OPENING = 0.3, 0.02, radians(75)
RINGS, SECTORS = 6, 24


def sheet(radius):
    """The pole, then ring after ring."""
    points = [(0.0, RADIUS - radius, 0.0)]
    for ring in range(1, RINGS + 1):
        polar = OPENING * ring / RINGS
        for k in range(SECTORS):
            turn = 2 * pi * k / SECTORS
            points.append((radius * sin(polar) * cos(turn), RADIUS - radius * cos(polar),
                           radius * sin(polar) * sin(turn)))
    return points


def triangles_of_sheet(first):
    """Counter-clockwise seen from the centre of the sphere."""
    def node(ring, k):
        return first + 1 + (ring - 1) * SECTORS + k % SECTORS

    for k in range(SECTORS):
        yield first, node(1, k + 1), node(1, k)
        for ring in range(1, RINGS):
            a, b = node(ring, k), node(ring, k + 1)
            c, d = node(ring + 1, k), node(ring + 1, k + 1)
            yield a, b, d
            yield a, d, c


def bowl():
    inner, outer = sheet(RADIUS), sheet(RADIUS + WALL)
    first = len(inner)
    triangles = list(triangles_of_sheet(0))
    triangles += [(a, c, b) for a, b, c in triangles_of_sheet(first)]
    rim = 1 + (RINGS - 1) * SECTORS
    for k in range(SECTORS):
        a, b = rim + k, rim + (k + 1) % SECTORS
        triangles += [(a, b, first + b), (a, first + b, first + a)]
    return inner + outer, triangles


def main():
    points, triangles = bowl()
    print("OFF")
    print(len(points), len(triangles), 0)
    for p in points:
        print(*(f"{c:.6g}" for c in p))
    for t in triangles:
        print(3, *t)


if __name__ == "__main__":
    main()
