"""Equations of state: pressure from the density deviation rho - rho0.

The deviation is what the run stores: in single precision rho itself would lose the small changes that carry the
pressure of a weakly compressible fluid.
"""

from collections.abc import Callable, Mapping
from functools import cache
from types import MappingProxyType
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic


@cache
def make_tait(arithmetic: Arithmetic) -> Any:
    """Tait: p = rho0 c0^2 / gamma ((rho/rho0)^gamma - 1) (Monaghan 1994).

    With e = rho/rho0 - 1 the bracket is gamma e (1 + (gamma-1)/2 e (1 + (gamma-2)/3 e (...))), which has no
    cancellation. Seven factors are the whole binomial of gamma = 7; what is left for another gamma is of order e^8.
    """
    real = arithmetic.real

    def tait(deviation: real, rest_density: real, sound_speed: real, gamma: real):
        e = deviation / rest_density
        series = real(1.0)
        for m in range(7):
            k = real(7 - m)
            series = real(1.0) + (gamma - k) / (k + real(1.0)) * e * series
        return rest_density * sound_speed * sound_speed * e * series

    return wp.func(tait)


STATES: Mapping[str, Callable[[Arithmetic], Any]] = MappingProxyType({"tait": make_tait})
"""Equation of state by its name in a scene: device function (rho - rho0, rho0, c0, gamma) -> p [Pa]."""
