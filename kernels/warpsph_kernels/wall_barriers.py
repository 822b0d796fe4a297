"""Forces by which the surface of a wall keeps single particles out, beside its pressure; by wall method."""

from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.pair_terms import Factory, make_barrier, make_constants_struct


@cache
def make_repulsion(arithmetic: Arithmetic) -> Any:
    """Return the device function of the repulsion of fluid a by the surface particle b (Liu, Shao & Chang 2012).

    0.01 rho0 c0^2 / V_w chi f(eta) x_ab / r^2 with chi = 1 - r / (1.5 dp) below 1.5 dp, eta = r / (0.75 h), and f = 2/3
    up to eta = 2/3, 2 eta - 1.5 eta^2 up to 1, (2 - eta)^2 / 2 up to 2. Particles whose `normal` is zero lie behind the
    surface and do not repel.
    """
    constants_type, real, vector = make_constants_struct(arithmetic), arithmetic.real, arithmetic.vector

    def repulsion(c: constants_type, x_ab: vector, normal: vector):
        r = wp.length(x_ab)
        chi = real(1.0) - r * c.inverse_spacing / real(1.5)
        eta = r * c.inverse_h / real(0.75)
        f = real(2.0) / real(3.0)
        if real(3.0) * eta > real(2.0):
            f = real(2.0) * eta - real(1.5) * eta * eta
        if eta > real(1.0):
            f = real(0.5) * (real(2.0) - eta) * (real(2.0) - eta)
        strength = real(0.0)
        if chi > real(0.0) and wp.dot(normal, normal) > real(0.0):
            stiffness = real(0.01) * c.rest_density * c.sound_speed * c.sound_speed / c.wall_volume
            strength = (
                stiffness * chi * f / wp.max(r * r, real(1.0e-6) * c.smoothing_length * c.smoothing_length)
            )
        return strength * x_ab

    return wp.func(repulsion)


BARRIERS: Mapping[str, Factory] = MappingProxyType(
    {"extrapolated": make_barrier, "modified_dynamic": make_barrier, "repulsive": make_repulsion}
)
