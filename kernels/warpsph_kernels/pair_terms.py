"""Exchangeable terms of the fluid's pair sums: pressure forms, viscosities, density diffusions.

Each entry of a registry is a factory that takes the arithmetic and returns a device function. Forces are densities
per V_a V_b and without the factor F of the kernel gradient (grad_a W_ab = F x_ab, F < 0), see `smoothing`.
"""

from collections.abc import Callable, Mapping
from functools import cache
from types import MappingProxyType
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic

Factory = Callable[[Arithmetic], Any]


@cache
def make_constants_struct(arithmetic: Arithmetic) -> Any:
    """Return the struct of a fluid's numbers, in SI units.

    `slope_norm` = alpha_d h^-(d+2), `diffusion` = delta h c0; for `barrier` see `make_barrier`. The two vectors of
    parameters are those of the state and of a viscosity that a user has added.
    """
    real, vector = arithmetic.real, arithmetic.vector

    class FluidConstants:
        pass

    scalars = (
        "smoothing_length",
        "inverse_h",
        "norm",
        "slope_norm",
        "mass",
        "wall_volume",
        "rest_density",
        "sound_speed",
        "artificial_viscosity",
        "dynamic_viscosity",
        "diffusion",
        "inverse_spacing",
        "barrier",
        "inverse_barrier_reach",
        "background_pressure",
        "tension_cutoff",
    )
    parameters = dict.fromkeys(("state_parameters", "viscosity_parameters"), arithmetic.parameters)
    vectors = {"gravity": vector, "period": vector}
    FluidConstants.__annotations__ = dict.fromkeys(scalars, real) | vectors | parameters
    return wp.struct(FluidConstants)


@cache
def make_symmetric_pressure(arithmetic: Arithmetic) -> Any:
    """p_a + p_b (Colagrossi & Landrini 2003)."""
    constants_type, real, vector = make_constants_struct(arithmetic), arithmetic.real, arithmetic.vector

    def symmetric_pressure(c: constants_type, x_ab: vector, u_ab: vector, r2: real, p_a: real, p_b: real):
        return p_a + p_b

    return wp.func(symmetric_pressure)


RIEMANN_LIMITER = 3.0


@cache
def make_riemann_pressure(arithmetic: Arithmetic) -> Any:
    """2 p* = p_a + p_b + rho0 min(3 max(u, 0), c0) u, u = -v_ab . x_ab / r (Zhang, Hu & Adams 2017).

    The linearised Riemann solver between a and b, whose dissipation the limiter takes away where particles part,
    and keeps small where they come together slowly. Density and sound speed are those at rest.
    """
    constants_type, real, vector = make_constants_struct(arithmetic), arithmetic.real, arithmetic.vector

    def riemann_pressure(c: constants_type, x_ab: vector, u_ab: vector, r2: real, p_a: real, p_b: real):
        tiny = real(1.0e-12) * c.smoothing_length * c.smoothing_length
        u = wp.max(-wp.dot(u_ab, x_ab) / wp.sqrt(wp.max(r2, tiny)), real(0.0))
        beta = wp.min(real(wp.static(RIEMANN_LIMITER)) * u, c.sound_speed)
        return p_a + p_b + c.rest_density * beta * u

    return wp.func(riemann_pressure)


@cache
def make_no_viscosity(arithmetic: Arithmetic) -> Any:
    constants_type, real, vector = make_constants_struct(arithmetic), arithmetic.real, arithmetic.vector

    def no_viscosity(c: constants_type, x_ab: vector, v_ab: vector, r2: real):
        return vector()

    return wp.func(no_viscosity)


@cache
def make_artificial_viscosity(arithmetic: Arithmetic) -> Any:
    """alpha h c0 rho0 (v_ab . x_ab) / (r^2 + 0.01 h^2) x_ab for approaching pairs (Monaghan 1992).

    Density and sound speed of the pair are taken at rest, as usual for a weakly compressible fluid.
    """
    constants_type, real, vector = make_constants_struct(arithmetic), arithmetic.real, arithmetic.vector

    def artificial_viscosity(c: constants_type, x_ab: vector, v_ab: vector, r2: real):
        approach = wp.min(wp.dot(v_ab, x_ab), real(0.0))
        softened = r2 + real(0.01) * c.smoothing_length * c.smoothing_length
        return c.artificial_viscosity * approach / softened * x_ab

    return wp.func(artificial_viscosity)


@cache
def make_laminar_viscosity(arithmetic: Arithmetic) -> Any:
    """2 mu v_ab (Morris, Fox & Zhu 1997, eq. 22, in volume form).

    Their factor x_ab . grad W / (r^2 + 0.01 h^2) is F without the softening, which guards a division that F does not
    have: it would take 1.5 per cent of the viscosity away, at any resolution.
    """
    constants_type, real, vector = make_constants_struct(arithmetic), arithmetic.real, arithmetic.vector

    def laminar_viscosity(c: constants_type, x_ab: vector, v_ab: vector, r2: real):
        return real(2.0) * c.dynamic_viscosity * v_ab

    return wp.func(laminar_viscosity)


@cache
def make_no_diffusion(arithmetic: Arithmetic) -> Any:
    constants_type, real, vector = make_constants_struct(arithmetic), arithmetic.real, arithmetic.vector

    def no_diffusion(c: constants_type, x_ab: vector, deviation_a: real, deviation_b: real):
        return real(0.0)

    return wp.func(no_diffusion)


@cache
def make_molteni_colagrossi(arithmetic: Arithmetic) -> Any:
    """-2 (rho_b - rho_a), to be multiplied by delta h c0 V_b F (Molteni & Colagrossi 2009)."""
    constants_type, real, vector = make_constants_struct(arithmetic), arithmetic.real, arithmetic.vector

    def molteni_colagrossi(c: constants_type, x_ab: vector, deviation_a: real, deviation_b: real):
        return real(2.0) * (deviation_a - deviation_b)

    return wp.func(molteni_colagrossi)


@cache
def make_fourtakas(arithmetic: Arithmetic) -> Any:
    """Molteni & Colagrossi's term without the hydrostatic part of rho_b - rho_a (Fourtakas et al. 2019).

    The hydrostatic part is linearised, rho0/c0^2 g . (x_b - x_a): over a support the next term is smaller by
    the relative change of the density.
    """
    constants_type, real, vector = make_constants_struct(arithmetic), arithmetic.real, arithmetic.vector

    def fourtakas(c: constants_type, x_ab: vector, deviation_a: real, deviation_b: real):
        hydrostatic = c.rest_density / (c.sound_speed * c.sound_speed) * wp.dot(c.gravity, x_ab)
        return real(2.0) * (deviation_a - deviation_b - hydrostatic)

    return wp.func(fourtakas)


@cache
def make_barrier(arithmetic: Arithmetic) -> Any:
    """Return the device function of the force that keeps fluid a out of the surface particle b of a wall.

    Minus the gradient of B D g(d/D) w(s/dp), with g(q) = (1 - q)^2 / 2, but 1/2 - q below 0, and the weight
    w(q) = (1 - q)^2 (1 + 2 q); the distance d = x_ab . n_b along the normal of the wall is between -dp/2 and D, and the
    distance s across it below dp. Over a flat row of particles the weights sum up to one, so that only the push along
    the normal is left and nothing brakes the flow along the wall. At a corner, whose normal is oblique to both of its
    sides, it is the push across the normal that makes the work of a particle on its way in that of its way out.

    A pressure that is averaged over the fluid, as that of an extrapolated wall, does not answer to the single particle
    that comes too near, and density diffusion takes away its own: without a barrier disordered fluid creeps in. It
    does not act on particles that keep more than D - dp/2 off the surface.
    """
    constants_type, real, vector = make_constants_struct(arithmetic), arithmetic.real, arithmetic.vector

    def barrier(c: constants_type, x_ab: vector, normal: vector):
        d = wp.dot(x_ab, normal)
        across = x_ab - d * normal
        s = wp.length(across) * c.inverse_spacing
        depth = real(1.0) - d * c.inverse_barrier_reach
        # Zeros instead of branches: a loop with branches has no vector instructions.
        push = wp.clamp(depth, real(0.0), real(1.0))
        energy = real(0.5) * push * push + wp.max(depth - real(1.0), real(0.0))
        outward = wp.max(real(1.0) - s, real(0.0))
        weight = outward * outward * (real(1.0) + real(2.0) * s)
        slope_over_s = real(6.0) * outward * c.inverse_spacing * c.inverse_spacing
        force = push * weight * normal + energy / c.inverse_barrier_reach * slope_over_s * across
        strength = wp.where(d * c.inverse_spacing > real(-0.5), c.barrier, real(0.0))
        return strength * force

    return wp.func(barrier)


PRESSURE_FORMS: Mapping[str, Factory] = MappingProxyType(
    {"symmetric": make_symmetric_pressure, "riemann": make_riemann_pressure}
)
VISCOSITIES: dict[str, Factory] = {
    "none": make_no_viscosity,
    "artificial": make_artificial_viscosity,
    "laminar": make_laminar_viscosity,
}
"""By name; `warpsph.register_viscosity` adds to it."""
DIFFUSIONS: Mapping[str, Factory] = MappingProxyType(
    {
        "none": make_no_diffusion,
        "molteni_colagrossi": make_molteni_colagrossi,
        "fourtakas": make_fourtakas,
        "delta_sph": make_molteni_colagrossi,  # less the gradients, which the sum adds
    }
)
