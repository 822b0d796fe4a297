"""Viscous stress from the strain rate: what a fluid's viscosity depends on.

With the velocity gradient G_ij = dv_i/dx_j, D = (G + G^T)/2 and the shear rate s = sqrt(2 D:D), a law gives the
dynamic viscosity [Pa s], and the stress is 2 mu (D - tr(D)/3 I).
"""

from collections.abc import Callable, Mapping
from functools import cache
from types import MappingProxyType
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic


@cache
def make_stress_struct(arithmetic: Arithmetic) -> Any:
    """Return the struct of the numbers of a stress.

    `viscosity`: at large shear rates [Pa s]; `consistency` [Pa s^n], `exponent` n, `yield_stress` [Pa]; `time` [s];
    `largest`: cap of the viscosity [Pa s]; `smagorinsky`: (C_s dp)^2 and `isotropic`: C_I dp^2 [m^2].
    """

    class StressConstants:
        pass

    names = ("viscosity", "consistency", "exponent", "yield_stress", "time", "largest")
    StressConstants.__annotations__ = dict.fromkeys((*names, "smagorinsky", "isotropic"), arithmetic.real)
    return wp.struct(StressConstants)


@cache
def make_newtonian(arithmetic: Arithmetic) -> Any:
    """The viscosity that the particle carries."""
    constants, real = make_stress_struct(arithmetic), arithmetic.real

    def newtonian(s: constants, shear_rate: real, carried: real):
        return carried

    return wp.func(newtonian)


@cache
def make_herschel_bulkley(arithmetic: Arithmetic) -> Any:
    """K s^(n-1) + tau_y (1 - exp(-m s)) / s (Herschel & Bulkley 1926; regularised by Papanastasiou 1987).

    With n = 1 a Bingham fluid, without a yield stress a power law.
    """
    constants, real = make_stress_struct(arithmetic), arithmetic.real

    def herschel_bulkley(s: constants, shear_rate: real, carried: real):
        rate = wp.max(shear_rate, real(1.0e-12))
        plastic = s.yield_stress * (real(1.0) - wp.exp(-s.time * rate)) / rate
        return s.consistency * wp.pow(rate, s.exponent - real(1.0)) + plastic

    return wp.func(herschel_bulkley)


@cache
def make_carreau(arithmetic: Arithmetic) -> Any:
    """mu_inf + (mu_0 - mu_inf) (1 + (lambda s)^2)^((n-1)/2) (Carreau 1972)."""
    constants, real = make_stress_struct(arithmetic), arithmetic.real

    def carreau(s: constants, shear_rate: real, carried: real):
        bend = real(1.0) + s.time * s.time * shear_rate * shear_rate
        return s.viscosity + s.consistency * wp.pow(bend, real(0.5) * (s.exponent - real(1.0)))

    return wp.func(carreau)


LAWS: Mapping[str, Callable[[Arithmetic], Any]] = MappingProxyType(
    {"newtonian": make_newtonian, "herschel_bulkley": make_herschel_bulkley, "carreau": make_carreau}
)


@cache
def make_viscosity(arithmetic: Arithmetic, law: str) -> Any:
    """Return the device function `viscosity(s, gradient, carried) -> mu` [Pa s] of a law of `LAWS`."""
    real, matrix = arithmetic.real, arithmetic.matrix
    constants, law_viscosity = make_stress_struct(arithmetic), LAWS[law](arithmetic)

    def viscosity(s: constants, gradient: matrix, carried: real):
        D = real(0.5) * (gradient + wp.transpose(gradient))
        return wp.min(law_viscosity(s, wp.sqrt(real(2.0) * wp.ddot(D, D)), carried), s.largest)

    return wp.func(viscosity)


@cache
def make_transposed_stress(arithmetic: Arithmetic) -> Any:
    """Return the device function `stress(mu, gradient) -> matrix` [Pa]: mu (G^T - 2/3 tr(G) I).

    What the viscous stress has beside mu G, whose divergence is summed pair by pair.
    """
    real, matrix, dim = arithmetic.real, arithmetic.matrix, arithmetic.dimension

    def transposed_stress(mu: real, gradient: matrix):
        mean = real(wp.static(2.0 / 3.0)) * wp.trace(gradient)
        return mu * (wp.transpose(gradient) - mean * wp.identity(n=wp.static(dim), dtype=real))

    return wp.func(transposed_stress)


@cache
def make_sub_particle_stress(arithmetic: Arithmetic) -> Any:
    """Return the device function `stress(s, gradient, density) -> matrix` of the sub-particle scale [Pa].

    rho [nu_t (2 D - 2/3 tr(D) I) - 2/3 C_I dp^2 s^2 I], nu_t = (C_s dp)^2 s (Dalrymple & Rogers 2006, eqs. 11-14).
    """
    real, matrix, dim = arithmetic.real, arithmetic.matrix, arithmetic.dimension
    constants = make_stress_struct(arithmetic)

    def sub_particle_stress(s: constants, gradient: matrix, density: real):
        D = real(0.5) * (gradient + wp.transpose(gradient))
        square = real(2.0) * wp.ddot(D, D)
        nu_t = s.smagorinsky * wp.sqrt(square)
        mean = real(wp.static(2.0 / 3.0)) * (nu_t * wp.trace(D) + s.isotropic * square)
        return density * (real(2.0) * nu_t * D - mean * wp.identity(n=wp.static(dim), dtype=real))

    return wp.func(sub_particle_stress)
