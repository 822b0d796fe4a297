"""Constitutive laws of structures: stress from the displacement gradient.

A law is one device function `law(H, p) -> (P, psi, P_33)` of the displacement gradient H = F - I and the numbers
`p` of the material (`make_material_struct`). It returns the first Piola-Kirchhoff stress P = dpsi/dF [Pa], the
strain energy psi [J per reference volume], and in two dimensions the stress P_33 out of the plane (else zero).
Laws are written in H, because in single precision F would have lost the small strains before they are needed.

In two dimensions a law comes in two states: plane strain (F_33 = 1) and plane stress (P_33 = 0).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic

NEWTON_STEPS = 6
"""Enough for the thickness of a plane-stress element to converge to single precision from any stretch in 0.3..3."""


@dataclass(frozen=True)
class LawOptions:
    """What a law is specialised for; `plane_stress` is False in three dimensions."""

    arithmetic: Arithmetic
    plane_stress: bool


LawFactory = Callable[[LawOptions], Any]


@cache
def make_material_struct(arithmetic: Arithmetic) -> Any:
    """Return the struct of a structure's numbers, in SI units.

    `lame`, `shear_modulus` [Pa] are Lame's constants, `bulk_modulus` = lame + 2/3 shear_modulus, `density` at rest;
    `penalty` [Pa] is the hourglass stiffness zeta E; `damping` [1/s] acts on momentum.
    """
    names = ("lame", "shear_modulus", "bulk_modulus", "density", "penalty", "damping")

    class Material:
        pass

    Material.__annotations__ = dict.fromkeys(names, arithmetic.real)
    return wp.struct(Material)


@cache
def make_kinematics(arithmetic: Arithmetic) -> tuple[Any, Any]:
    """Return the device functions `volume_change(H)` = det(I + H) - 1 and `inverse_transpose(H)` = (I + H)^-T.

    The first is a sum without the 1, so that small volume changes keep their digits.
    """
    real, dim = arithmetic.real, arithmetic.dimension
    matrix = arithmetic.matrix

    def volume_change(H: matrix):
        change = wp.trace(H) + wp.determinant(H)
        if wp.static(dim == 3):
            change += real(0.5) * (wp.trace(H) * wp.trace(H) - wp.trace(H * H))
        return change

    def inverse_transpose(H: matrix):
        return wp.transpose(wp.inverse(wp.identity(n=wp.static(dim), dtype=real) + H))

    return wp.func(volume_change), wp.func(inverse_transpose)


@cache
def make_log1p(arithmetic: Arithmetic) -> Any:
    """Return the device function log(1 + x) that keeps the digits of a small x (Kahan's quotient)."""
    real = arithmetic.real

    def log1p(x: real):
        y = real(1.0) + x
        result = x
        if y != real(1.0):
            result = wp.log(y) * x / (y - real(1.0))
        return result

    return wp.func(log1p)


@cache
def make_expm1(arithmetic: Arithmetic) -> Any:
    """Return the device function exp(x) - 1 that keeps the digits of a small x, as 2 t / (1 - t) with t = tanh(x/2)."""
    real = arithmetic.real

    def expm1(x: real):
        t = wp.tanh(real(0.5) * x)
        return real(2.0) * t / (real(1.0) - t)

    return wp.func(expm1)


@cache
def make_energy_parts(arithmetic: Arithmetic) -> tuple[Any, Any]:
    """Return two device functions from which energies are summed up without a difference of large numbers.

    `excess(H)` = tr(F F^T - I) - 2 (J - 1), of second order in H; `log1p_rest(x)` = x - log(1 + x), of second order
    in x: a series in s = x / (2 + x) where x is small, because log(1 + x) = 2 artanh(s).
    """
    real, dim, matrix = arithmetic.real, arithmetic.dimension, arithmetic.matrix
    log1p = make_log1p(arithmetic)
    terms = 5 if arithmetic.precision == "single" else 12

    def excess(H: matrix):
        value = wp.ddot(H, H) - real(2.0) * wp.determinant(H)
        if wp.static(dim == 3):
            value += wp.trace(H * H) - wp.trace(H) * wp.trace(H)
        return value

    def log1p_rest(x: real):
        rest = x - log1p(x)
        if wp.abs(x) < real(0.25):
            s = x / (real(2.0) + x)
            series = real(0.0)
            for k in range(wp.static(terms)):
                series = series * s * s + real(1.0) / real(2 * (wp.static(terms) - k) + 1)
            rest = real(2.0) * s * s * (real(1.0) / (real(1.0) - s) - s * series)
        return rest

    return wp.func(excess), wp.func(log1p_rest)


@cache
def make_st_venant_kirchhoff(options: LawOptions) -> Any:
    """S = lambda tr(E) I + 2 mu E with E = (F^T F - I)/2, P = F S, psi = S : E / 2 (e.g. Bonet & Wood 2008).

    Plane stress: lambda becomes 2 lambda mu / (lambda + 2 mu).
    """
    arithmetic, plane_stress = options.arithmetic, options.plane_stress
    real, dim, matrix = arithmetic.real, arithmetic.dimension, arithmetic.matrix
    material = make_material_struct(arithmetic)

    def st_venant_kirchhoff(H: matrix, p: material):
        E = real(0.5) * (H + wp.transpose(H) + wp.transpose(H) * H)
        lame = p.lame
        if wp.static(plane_stress):
            lame = real(2.0) * p.lame * p.shear_modulus / (p.lame + real(2.0) * p.shear_modulus)
        identity = wp.identity(n=wp.static(dim), dtype=real)
        S = lame * wp.trace(E) * identity + real(2.0) * p.shear_modulus * E
        P_33 = real(0.0)
        if wp.static(dim == 2 and not plane_stress):
            P_33 = lame * wp.trace(E)
        return S + H * S, real(0.5) * wp.ddot(S, E), P_33

    return wp.func(st_venant_kirchhoff)


@cache
def make_linear_elastic(options: LawOptions) -> Any:
    """P = lambda tr(e) I + 2 mu e with e = (H + H^T)/2: for small displacements, as a check of the others."""
    arithmetic, plane_stress = options.arithmetic, options.plane_stress
    real, dim, matrix = arithmetic.real, arithmetic.dimension, arithmetic.matrix
    material = make_material_struct(arithmetic)

    def linear_elastic(H: matrix, p: material):
        e = real(0.5) * (H + wp.transpose(H))
        lame = p.lame
        if wp.static(plane_stress):
            lame = real(2.0) * p.lame * p.shear_modulus / (p.lame + real(2.0) * p.shear_modulus)
        identity = wp.identity(n=wp.static(dim), dtype=real)
        P = lame * wp.trace(e) * identity + real(2.0) * p.shear_modulus * e
        P_33 = real(0.0)
        if wp.static(dim == 2 and not plane_stress):
            P_33 = lame * wp.trace(e)
        return P, real(0.5) * wp.ddot(P, e), P_33

    return wp.func(linear_elastic)


@cache
def make_neo_hookean(options: LawOptions) -> Any:
    """psi = mu/2 (tr(F^T F) - 3 - 2 ln J) + lambda/2 (ln J)^2, P = [mu (F F^T - I) + lambda ln J I] F^-T.

    The compressible neo-Hookean law of Bonet & Wood (2008, section 6.4.3). Plane stress finds the stretch t through
    the thickness from P_33 t = mu (t^2 - 1) + lambda ln(J t) = 0, with the J of the plane, by Newton's method in ln t.
    """
    arithmetic, plane_stress = options.arithmetic, options.plane_stress
    real, dim, matrix = arithmetic.real, arithmetic.dimension, arithmetic.matrix
    material = make_material_struct(arithmetic)
    volume_change, inverse_transpose = make_kinematics(arithmetic)
    log1p, expm1 = make_log1p(arithmetic), make_expm1(arithmetic)
    excess, log1p_rest = make_energy_parts(arithmetic)

    def neo_hookean(H: matrix, p: material):
        b = H + wp.transpose(H) + H * wp.transpose(H)
        growth = volume_change(H)
        log_J = log1p(growth)
        identity = wp.identity(n=wp.static(dim), dtype=real)
        # mu/2 (tr(F F^T - I) - 2 ln J) in parts of second order; so is what the thickness adds, t^2 - 1 - 2 ln t
        shape = real(0.5) * excess(H) + log1p_rest(growth)
        if wp.static(plane_stress):
            log_J_plane = log_J
            log_t = real(0.0)
            for _ in range(wp.static(NEWTON_STEPS)):
                thicker = expm1(real(2.0) * log_t)
                residual = p.shear_modulus * thicker + p.lame * (log_J_plane + log_t)
                log_t -= residual / (real(2.0) * p.shear_modulus * (real(1.0) + thicker) + p.lame)
            log_J = log_J_plane + log_t
            shape += real(0.5) * log1p_rest(expm1(real(2.0) * log_t))
        P = (p.shear_modulus * b + p.lame * log_J * identity) * inverse_transpose(H)
        psi = p.shear_modulus * shape + real(0.5) * p.lame * log_J * log_J
        P_33 = real(0.0)
        if wp.static(dim == 2 and not plane_stress):
            P_33 = p.lame * log_J
        return P, psi, P_33

    return wp.func(neo_hookean)


@cache
def make_split_neo_hookean(options: LawOptions) -> Any:
    """psi = mu/2 (J^(-2/3) tr(F^T F) - 3) + K/2 (J - 1)^2, the law with separate volume and shape of Lee, Gil & Bonet
    (2013); P = [mu J^(-2/3) dev(F F^T) + K (J - 1) J I] F^-T. Plane strain and three dimensions.
    """
    arithmetic = options.arithmetic
    real, dim, matrix = arithmetic.real, arithmetic.dimension, arithmetic.matrix
    material = make_material_struct(arithmetic)
    volume_change, inverse_transpose = make_kinematics(arithmetic)
    log1p, expm1 = make_log1p(arithmetic), make_expm1(arithmetic)
    excess, log1p_rest = make_energy_parts(arithmetic)

    def split_neo_hookean(H: matrix, p: material):
        b = H + wp.transpose(H) + H * wp.transpose(H)
        growth = volume_change(H)
        J = real(1.0) + growth
        identity = wp.identity(n=wp.static(dim), dtype=real)
        mean = wp.trace(b) / real(3.0)
        isochoric = wp.pow(J, real(wp.static(-2.0 / 3.0)))
        shape = p.shear_modulus * isochoric
        pressure = p.bulk_modulus * growth * J
        P = (shape * (b - mean * identity) + pressure * identity) * inverse_transpose(H)
        # tr(F F^T) - 3 J^(2/3) in parts of second order, since 3 (J^(2/3) - 1) is 2 (J - 1) to first order
        larger = expm1(real(wp.static(2.0 / 3.0)) * log1p(growth))
        distortion = excess(H) + real(2.0) * log1p_rest(growth) - real(3.0) * log1p_rest(larger)
        psi = real(0.5) * (shape * distortion + p.bulk_modulus * growth * growth)
        P_33 = real(0.0)
        if wp.static(dim == 2):
            P_33 = pressure - shape * mean
        return P, psi, P_33

    return wp.func(split_neo_hookean)


LAWS: dict[str, LawFactory] = {
    "st_venant_kirchhoff": make_st_venant_kirchhoff,
    "neo_hookean": make_neo_hookean,
    "split_neo_hookean": make_split_neo_hookean,
    "linear_elastic": make_linear_elastic,
}
"""Constitutive law by its name in a scene; `warpsph.register_material` adds to it."""
