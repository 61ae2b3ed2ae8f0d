"""A second referee for bars: stable neo-Hookean 20-node hexahedra in numpy.

If a body folds so sharply that the minimiser of its energy has inverted points, ccx, which uses
C = F^T F, does not converge. This solver uses F as Sinew does, and minimises the energy by Newton's
method with a line search. On the same mesh with the same integration points it gives the result of
ccx with the card stable_neo_hookean.
"""

import numpy as np

from .ccx import lame
from .mesh import CORNERS, EDGES, Block

LEVI_CIVITA = np.zeros((3, 3, 3))
for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
    LEVI_CIVITA[i, j, k], LEVI_CIVITA[i, k, j] = 1.0, -1.0


def gauss_points(reduced):
    """Points (n, 3) in [-1, 1]^3 and weights: 2 x 2 x 2 (C3D20R) or 3 x 3 x 3 (C3D20)."""
    x, w = np.polynomial.legendre.leggauss(2 if reduced else 3)
    points = np.stack(np.meshgrid(x, x, x, indexing="ij"), -1).reshape(-1, 3)
    return points, np.einsum("i,j,k->ijk", w, w, w).ravel()


def shape_functions(points):
    """Values (n, 20) and derivatives (n, 20, 3) of the serendipity hexahedron."""
    nodes = np.array([2 * c - 1 for c in CORNERS] +
                     [CORNERS[a] + CORNERS[b] - 1 for a, b in EDGES], dtype=float)
    values, slopes = np.empty((len(points), 20)), np.empty((len(points), 20, 3))
    for a, s in enumerate(nodes):
        # Factors along each axis and their derivatives: (1 + s x), or 1 - x^2 across an edge.
        f = np.where(s == 0.0, 1.0 - points ** 2, 1.0 + s * points)
        d = np.where(s == 0.0, -2.0 * points, s)
        scale, extra, extra_slope = (0.125, points @ s - 2.0, s) if a < 8 else (0.25, 1.0, s * 0.0)
        product = f.prod(axis=1)
        values[:, a] = scale * product * extra
        for i in range(3):
            others = np.delete(f, i, axis=1).prod(axis=1)
            slopes[:, a, i] = scale * (d[:, i] * others * extra + product * extra_slope[i])
    return values, slopes


class Bar:
    """A Block, its unknowns ordered by layers along the third axis. young, poisson: numbers, or
    arrays (elements) where it has more than one material."""

    def __init__(self, block: Block, young, poisson, reduced=True):
        lam, mu = lame(np.broadcast_to(young, len(block.elements)),
                       np.broadcast_to(poisson, len(block.elements)))
        self.mu, self.kappa = mu[:, None], (lam + mu)[:, None]  # (elements, 1), for the points
        self.obstacle = None  # with energy(x), force(x) and, for the last layer, stiffness(x)
        self.rest = block.points
        self.elements = block.elements - 1
        points, weights = gauss_points(reduced)
        self.shape, slopes = shape_functions(points)
        jacobian = np.einsum("eai,qaj->eqij", self.rest[self.elements], slopes)
        self.gradient = np.einsum("qaj,eqji->eqai", slopes, np.linalg.inv(jacobian))
        self.weight = weights * np.linalg.det(jacobian)  # [m3] (elements, points)
        # Layer of a node: of the elements that begin there; the last plane is its own layer.
        place = np.zeros(len(self.rest), dtype=int)
        lattice = np.argwhere(block.index > 0)
        place[block.index[tuple(lattice.T)] - 1] = lattice[:, 2] // 2
        self.layers = [np.flatnonzero(place == n) for n in range(block.cells[2] + 1)]
        first = place[self.elements].min(axis=1)
        self.elements_of = [np.flatnonzero(first == n) for n in range(block.cells[2])]

    def weights_of_mass(self):
        """The integral of each shape function [m3] (nodes)."""
        share = np.einsum("eq,qa->ea", self.weight, self.shape)
        return np.bincount(self.elements.ravel(), share.ravel(), len(self.rest))

    def deformation(self, x):
        return np.einsum("eai,eqaj->eqij", x[self.elements], self.gradient)

    def energy(self, x):
        """[J]"""
        f = self.deformation(x)
        j = np.linalg.det(f) - 1.0
        w = self.mu / 2.0 * ((f * f).sum((2, 3)) - 3.0) - self.mu * j + self.kappa / 2.0 * j * j
        obstacle = self.obstacle.energy(x) if self.obstacle else 0.0
        return float((w * self.weight).sum()) + obstacle

    def pressure_and_cofactor(self, f, chosen=slice(None)):
        cofactor = np.stack([np.cross(f[..., 1], f[..., 2]), np.cross(f[..., 2], f[..., 0]),
                             np.cross(f[..., 0], f[..., 1])], axis=-1)
        return self.kappa[chosen] * (np.linalg.det(f) - 1.0) - self.mu[chosen], cofactor

    def force(self, x):
        """The energy's derivative [N] (nodes, 3): what has to be applied to hold x."""
        f = self.deformation(x)
        pressure, cofactor = self.pressure_and_cofactor(f)
        stress = (self.mu[..., None, None] * f + pressure[..., None, None] * cofactor) * self.weight[..., None, None]
        share = np.einsum("eqij,eqaj->eai", stress, self.gradient)
        force = np.stack([np.bincount(self.elements.ravel(), share[..., i].ravel(), len(self.rest))
                          for i in range(3)], axis=1)
        return force + self.obstacle.force(x) if self.obstacle else force

    def element_stiffness(self, x, chosen):
        """Second derivatives (elements, 20, 3, 20, 3) of the chosen elements."""
        gradient, weight = self.gradient[chosen], self.weight[chosen]
        f = np.einsum("eai,eqaj->eqij", x[self.elements[chosen]], gradient)
        pressure, cofactor = self.pressure_and_cofactor(f, chosen)
        of_element = (slice(None), slice(None), None, None, None, None)
        d = self.kappa[chosen][of_element] * np.einsum("eqij,eqkl->eqijkl", cofactor, cofactor)
        d += np.einsum("eq,ikm,jln,eqmn->eqijkl", pressure, LEVI_CIVITA, LEVI_CIVITA, f,
                       optimize=True)
        d += self.mu[chosen][of_element] * np.einsum("ik,jl->ijkl", np.eye(3), np.eye(3))
        d *= weight[..., None, None, None, None]
        e, q = weight.shape
        half = (d.reshape(e, q, 27, 3) @ gradient.transpose(0, 1, 3, 2)).reshape(e, q, 3, 3, 60)
        half = half.transpose(0, 1, 3, 2, 4).reshape(e, 3 * q, 180)
        left = gradient.transpose(0, 2, 1, 3).reshape(e, 20, 3 * q)
        return (left @ half).reshape(e, 20, 3, 3, 20).transpose(0, 1, 2, 4, 3)

    def newton_direction(self, x, residual, free, shift):
        """Solves (K + shift) d = -residual for the free components, layer by layer. None where
        the matrix is not positive definite."""
        count = len(self.layers)
        local = np.empty(len(self.rest), dtype=int)
        diagonal, right, solved = None, None, []
        for n in range(count):
            nodes = self.layers[n]
            following = self.layers[n + 1] if n + 1 < count else nodes[:0]
            both = np.concatenate([nodes, following])
            local[both] = np.arange(len(both))
            size, split = 3 * len(both), 3 * len(nodes)
            matrix = np.zeros(size * size)
            if n + 1 < count:
                chosen = self.elements_of[n]
                k = self.element_stiffness(x, chosen)
                dof = (3 * local[self.elements[chosen]][..., None] + np.arange(3)).reshape(-1, 60)
                place = dof[:, :, None] * size + dof[:, None, :]
                matrix = np.bincount(place.ravel(), k.reshape(-1), size * size)
            elif self.obstacle:
                matrix = self.obstacle.stiffness(x, nodes)
            matrix = matrix.reshape(size, size)
            if diagonal is not None:
                matrix[:split, :split] += diagonal
            vector = residual[nodes].ravel() + (0.0 if right is None else right)
            held = ~free[both].ravel()
            own = matrix[:split, :split]
            own[held[:split], :] = 0.0
            own[:, held[:split]] = 0.0
            own[np.arange(split), np.arange(split)] += np.where(held[:split], 1.0, shift)
            vector[held[:split]] = 0.0
            coupling = matrix[split:, :split]
            coupling[held[split:], :] = 0.0
            coupling[:, held[:split]] = 0.0
            try:
                np.linalg.cholesky(own)
            except np.linalg.LinAlgError:
                return None
            answer = np.linalg.solve(own, np.column_stack([coupling.T, vector]))
            solved.append(answer)
            diagonal = matrix[split:, split:] - coupling @ answer[:, :-1]
            right = -coupling @ answer[:, -1]
        direction = np.zeros((len(self.rest), 3))
        behind = np.zeros(0)
        for n in reversed(range(count)):
            behind = -solved[n][:, -1] - solved[n][:, :-1] @ behind
            direction[self.layers[n]] = behind.reshape(-1, 3)
        return direction

    def minimise(self, x, free, load, tolerance=1e-9, most=200):
        """The state at rest under nodal forces `load` [N] near x, where `free` (nodes, 3) is true.
        It ends where the residual is this share of the largest force, or a full step of Newton's
        this share of the body's size, since rounding keeps a residual up where kappa is large."""
        size = np.ptp(self.rest, axis=0).max()
        x = x.copy()
        shift = 0.0
        stiff = self.mu.max() * np.cbrt(self.weight.sum()) / len(self.layers)
        for _ in range(most):
            force = self.force(x)
            residual = np.where(free, force - load, 0.0)
            if np.abs(residual).max() <= tolerance * max(np.abs(force).max(), np.abs(load).max()):
                return x
            while (d := self.newton_direction(x, residual, free, shift)) is None:
                shift = max(4.0 * shift, 1e-4 * stiff)
            shift = shift / 4.0 if shift > 1e-4 * stiff else 0.0
            slope = float((residual * d).sum())
            here, length = self.energy(x) - float((load * x).sum()), 1.0
            floor = 1e-13 * (abs(here) + abs(slope))
            while (self.energy(x + length * d) - float((load * (x + length * d)).sum())
                   > here + 1e-4 * length * slope + floor):
                length /= 2.0
                if length < 1e-8:
                    raise ArithmeticError("the line search found no lower energy")
            x += length * d
            if length == 1.0 and shift == 0.0 and np.abs(d).max() < tolerance * size:
                return x
        raise ArithmeticError("no state at rest after the most steps")
