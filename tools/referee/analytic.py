"""Cases with a formula: homogeneous strains of the stable neo-Hookean law, a hollow sphere."""

import math

import numpy as np

from . import ccx, mesh
from .fem import LEVI_CIVITA
from .values import Value

YOUNG = 15e3
POISSON = (0.3, 0.45, 0.499)
STRETCHES = {0.3: (1.5, 0.7), 0.45: (1.5, 0.5), 0.499: (1.5, 0.5)}
ROUNDING = 1e-9  # of a formula's value


def exact(variant, quantity, value, scale=0.0, meshes=None):
    return Value(variant, quantity, value, ROUNDING * max(abs(value), scale), meshes or {})


def uniaxial_state(young, poisson, stretch):
    """Lateral stretch t and nominal stress [Pa] of a bar stretched along its axis, free at its
    sides. P = mu F + (kappa (J - 1) - mu) cof F; the lateral stress vanishes where
    mu - mu s + kappa s (s t^2 - 1) = 0, s the stretch."""
    lam, mu = ccx.lame(young, poisson)
    kappa = lam + mu
    s = stretch
    volume = 1.0 + mu * (s - 1.0) / (kappa * s)  # J = s t^2
    t = math.sqrt(volume / s)
    return t, mu * s + (kappa * (volume - 1.0) - mu) * t * t


def surface_is_stable(young, poisson, stretch):
    """Whether waves on a free side of that bar cost energy: the surface impedance of the law's
    tangent moduli is positive definite (Biot 1963; Stroh's formalism). If they do not, the
    homogeneous state is not a rest state, however fine the mesh."""
    lam, mu = ccx.lame(young, poisson)
    kappa = lam + mu
    lateral, _ = uniaxial_state(young, poisson, stretch)
    f = np.diag([lateral, lateral, stretch])
    volume = np.linalg.det(f)
    cofactor = volume * np.linalg.inv(f).T
    moduli = (mu * np.einsum("ik,jl->ijkl", np.eye(3), np.eye(3)) +
              kappa * np.einsum("ij,kl->ijkl", cofactor, cofactor) +
              (kappa * (volume - 1.0) - mu) * np.einsum("ikm,jln,mn->ijkl", LEVI_CIVITA,
                                                        LEVI_CIVITA, f))
    # Waves along the axis, on a side with the normal x.
    q, r, t = moduli[:, 2, :, 2], moduli[:, 2, :, 0], np.linalg.inv(moduli[:, 0, :, 0])
    roots, vectors = np.linalg.eig(np.block([[-t @ r.T, t], [r @ t @ r.T - q, -r @ t]]))
    decaying = vectors[:, np.argsort(-roots.imag)[:3]]
    impedance = -1j * decaying[3:] @ np.linalg.inv(decaying[:3])
    return np.linalg.eigvalsh((impedance + impedance.conj().T) / 2.0).min() > 0.0


def cube(poisson, stretch):
    """One element, stretched along x, for ccx: does its card give the law?"""
    b = mesh.Block((1, 1, 1), mesh.box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)))
    law = ccx.stable_neo_hookean
    return b, (b.deck() + ccx.node_set("PULLED", b.side(0, -1)) + ccx.section(law, YOUNG, poisson) +
               "*BOUNDARY\n" + "".join(mesh.held(b.side(axis, 0), axis + 1) for axis in range(3)) +
               ccx.static_step(f"*BOUNDARY\nPULLED,1,1,{stretch - 1.0}\n"
                               "*NODE PRINT,NSET=PULLED,FREQUENCY=2000\nU,RF\n", law))


def uniaxial(runner):
    """A bar stretched and compressed, free at its sides, as far as that is stable."""
    for poisson in POISSON:
        for stretch in STRETCHES[poisson]:
            if not surface_is_stable(YOUNG, poisson, stretch):
                raise ccx.RefereeError(f"the homogeneous state of {stretch} is not stable")
            b, deck = cube(poisson, stretch)
            result = runner.run(f"uniaxial-{poisson}-{stretch}", deck)
            corner = result.last("displacements", "PULLED")[int(b.index[-1, -1, -1])]
            forces = result.last("forces", "PULLED").values()
            found = {"stress": sum(f[0] for f in forces), "lateral": 1.0 + corner[1]}
            lateral, stress = uniaxial_state(YOUNG, poisson, stretch)
            for quantity, value in (("stress", stress), ("lateral", lateral)):
                yield exact(f"stretch {stretch} nu={poisson}", quantity, value,
                            meshes={"CalculiX, one element": found[quantity]})


def shear(_runner):
    """Simple shear F = I + g e_x e_y^T, g = 0.5: J = 1 and cof F = I - g e_y e_x^T, so that
    P_xy = P_yx = mu g and every other component is 0."""
    for poisson in POISSON:
        _, mu = ccx.lame(YOUNG, poisson)
        yield exact(f"nu={poisson}", "P_xy", 0.5 * mu)
        for c in ("xx", "yy", "zz"):
            yield exact(f"nu={poisson}", f"P_{c}", 0.0, scale=mu)


def hollow_sphere(_runner):
    """Lame's thick sphere, inner radius a, outer b, inner pressure p; small strains:
    u(r) = p a^3 / (b^3 - a^3) (r / (3 lambda + 2 mu) + b^3 / (4 mu r^2))."""
    a, b, pressure, young = 0.05, 0.1, 100.0, 100e3
    for poisson in POISSON:
        lam, mu = ccx.lame(young, poisson)
        inner = pressure * a ** 3 / (b ** 3 - a ** 3) * (
            a / (3.0 * lam + 2.0 * mu) + b ** 3 / (4.0 * mu * a ** 2))
        # The error of the formula is of the order of the strain, p / mu.
        yield Value(f"nu={poisson}", "inner", inner, inner * pressure / mu)


LAW = "analysis: the law's own formula, P = mu F + (kappa (J - 1) - mu) cof F"
CASES = {"uniaxial": (LAW, uniaxial, None), "shear": (LAW, shear, None),
         "hollow_sphere": ("analysis: Lame's thick-walled sphere, small strains", hollow_sphere,
                           None)}
