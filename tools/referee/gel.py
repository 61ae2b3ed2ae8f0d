"""A ball of gel that hits the ground: Hertz's theory, and an axisymmetric solver of the same law."""

import math

import numpy as np

from . import ccx
from .values import extrapolate

YOUNG, POISSON = 50e3, 0.45
RADIUS, SPEED = 0.03, 0.5
SOURCE = ("tools/referee/gel.py: axisymmetric explicit finite elements, 12, 16, 24 cells over the "
          "radius, extrapolated where they show an order; Hertz's theory of impact beside it")


def hertz():
    """Largest approach [m] and time of contact [s] of an elastic ball on a rigid plane without
    gravity: m v^2 / 2 = 2/5 k d^2.5 with k = 4/3 E / (1 - nu^2) sqrt(R), T = 2.9432 d / v."""
    stiffness = 4.0 / 3.0 * YOUNG / (1.0 - POISSON ** 2) * math.sqrt(RADIUS)
    mass = 4.0 / 3.0 * math.pi * RADIUS ** 3 * ccx.DENSITY
    approach = (5.0 * mass * SPEED ** 2 / (4.0 * stiffness)) ** 0.4
    return approach, 2.9432 * approach / SPEED


class Ball:
    """4-node axisymmetric elements in the half plane r >= 0; the volume term has one integration
    point, the rest four, so that it does not lock."""

    def __init__(self, cells):
        u, v = np.meshgrid(np.linspace(0.0, 1.0, cells + 1), np.linspace(-1.0, 1.0, 2 * cells + 1),
                           indexing="ij")
        # The square to the disc.
        self.rest = RADIUS * np.stack([u * np.sqrt(1.0 - v * v / 2.0),
                                       v * np.sqrt(1.0 - u * u / 2.0)], axis=-1).reshape(-1, 2)
        self.rest[:, 1] += RADIUS
        first = np.arange(u.size).reshape(u.shape)
        self.elements = np.stack([first[:-1, :-1], first[1:, :-1], first[1:, 1:], first[:-1, 1:]],
                                 axis=-1).reshape(-1, 4)
        lam, self.mu = ccx.lame(YOUNG, POISSON)
        self.kappa = lam + self.mu
        g = 1.0 / math.sqrt(3.0)
        self.full = self.points([(-g, -g), (g, -g), (g, g), (-g, g)], 1.0)
        self.centre = self.points([(0.0, 0.0)], 4.0)
        shape, _, _, weight = self.full
        share = ccx.DENSITY * np.einsum("eq,qa->ea", weight, shape)
        self.mass = np.bincount(self.elements.ravel(), share.ravel(), len(self.rest))
        self.axis = self.rest[:, 0] == 0.0
        slope = math.sqrt((self.full[1] ** 2).sum(axis=(2, 3)).max())  # [1/m], of the thinnest
        self.step = 0.6 / slope / math.sqrt((lam + 2.0 * self.mu) / ccx.DENSITY)

    def points(self, places, weight):
        """Shape functions (q, 4), their derivatives (e, q, 4, 2), shape / r (e, q, 4), volumes."""
        s, t = np.array(places).T[:, :, None]
        a, b = np.array([-1, 1, 1, -1]), np.array([-1, -1, 1, 1])
        shape = (1 + a * s) * (1 + b * t) / 4.0
        slopes = np.stack([a * (1 + b * t), b * (1 + a * s)], axis=-1) / 4.0
        corner = self.rest[self.elements]
        jacobian = np.einsum("eai,qaj->eqij", corner, slopes)
        gradient = np.einsum("qaj,eqji->eqai", slopes, np.linalg.inv(jacobian))
        radius = np.einsum("qa,ea->eq", shape, corner[..., 0])
        volume = weight * 2.0 * math.pi * radius * np.linalg.det(jacobian)
        return shape, gradient, shape / radius[..., None], volume

    def force(self, x):
        """Of the law, on the nodes [N]."""
        corner = x[self.elements]
        total = np.zeros((len(self.elements), 4, 2))
        for (_, gradient, hoop, volume), has_shape, has_volume in (
                (self.full, 1.0, 0.0), (self.centre, 0.0, 1.0)):
            f = np.einsum("eai,eqaj->eqij", corner, gradient)
            stretch = np.einsum("ea,eqa->eq", corner[..., 0], hoop)
            plane = f[..., 0, 0] * f[..., 1, 1] - f[..., 0, 1] * f[..., 1, 0]
            pressure = (has_volume * self.kappa * (plane * stretch - 1.0) -
                        has_shape * self.mu) * volume
            shear = has_shape * self.mu * volume
            cofactor = np.stack([np.stack([f[..., 1, 1], -f[..., 1, 0]], -1),
                                 np.stack([-f[..., 0, 1], f[..., 0, 0]], -1)], -2)
            stress = (shear[..., None, None] * f +
                      (pressure * stretch)[..., None, None] * cofactor)
            total -= np.einsum("eqij,eqaj->eai", stress, gradient)
            total[..., 0] -= np.einsum("eq,eqa->ea", shear * stretch + pressure * plane, hoop)
        return np.stack([np.bincount(self.elements.ravel(), total[..., i].ravel(), len(self.rest))
                         for i in range(2)], axis=1)


def impact(cells):
    """Largest approach of the centre of mass [m], time of contact [s], rebound speed of the centre
    of mass as a share. The ground takes a node's downward velocity."""
    ball = Ball(cells)
    x, h = ball.rest.copy(), ball.step
    v = np.zeros_like(x)
    v[:, 1] = -SPEED
    share = ball.mass / ball.mass.sum()
    lowest, time = share @ x[:, 1], 0.0
    while time < 0.2:
        v += h * ball.force(x) / ball.mass[:, None]
        v[:, 1] -= h * ccx.GRAVITY
        v[ball.axis, 0] = 0.0
        # Not below the ground within this step.
        v[:, 1] = np.maximum(v[:, 1], -x[:, 1] / h)
        x += h * v
        time += h
        height, speed = share @ x[:, 1], share @ v[:, 1]
        lowest = min(lowest, height)
        if speed > 0.0 and x[:, 1].min() > 0.0:
            return RADIUS - lowest, time, speed / SPEED
    raise ccx.RefereeError("the ball of gel did not leave the ground")


def values(runner):
    sizes = (12, 16, 24)
    found = [runner.remember(f"gel-{n}", lambda n=n: impact(n)) for n in sizes]
    for i, (quantity, theory, unit) in enumerate((("approach", hertz()[0], 1.0),
                                                  ("contact", hertz()[1], 1.0),
                                                  ("rebound", SPEED, SPEED))):
        value = extrapolate("", quantity, sizes, [unit * f[i] for f in found], "{} cells")
        value.meshes = {"Hertz": theory, **value.meshes}
        yield value


CASES = {"gel": (SOURCE, values, None)}
