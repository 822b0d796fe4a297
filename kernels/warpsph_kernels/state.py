"""Equations of state: pressure from the density deviation rho - rho0.

The deviation is what the run stores: in single precision rho itself would lose the small changes that carry the
pressure of a weakly compressible fluid.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic


@dataclass(frozen=True)
class EquationOfState:
    """A state by its device functions of (rho - rho0, rho0, c0, parameters); densities in kg/m^dim, speeds in m/s.

    make(arithmetic): the pressure p [Pa]; make_stiffening(arithmetic): the square of the local over the reference
    sound speed, dp/drho / c0^2.
    """

    make: Callable[[Arithmetic], Any]
    make_stiffening: Callable[[Arithmetic], Any]


@cache
def make_tait(arithmetic: Arithmetic) -> Any:
    """Tait: p = rho0 c0^2 / gamma ((rho/rho0)^gamma - 1) (Monaghan 1994); gamma is the first parameter.

    With e = rho/rho0 - 1 the bracket is gamma e (1 + (gamma-1)/2 e (1 + (gamma-2)/3 e (...))), which has no
    cancellation. Seven factors are the whole binomial of gamma = 7; what is left for another gamma is of order e^8.
    """
    real, parameters_vector = arithmetic.real, arithmetic.parameters

    def tait(deviation: real, rest_density: real, sound_speed: real, parameters: parameters_vector):
        gamma = parameters[0]
        e = deviation / rest_density
        series = real(1.0)
        for m in range(7):
            k = real(7 - m)
            series = real(1.0) + (gamma - k) / (k + real(1.0)) * e * series
        return rest_density * sound_speed * sound_speed * e * series

    return wp.func(tait)


@cache
def make_tait_stiffening(arithmetic: Arithmetic) -> Any:
    """(rho/rho0)^(gamma - 1)."""
    real, parameters_vector = arithmetic.real, arithmetic.parameters

    def tait_stiffening(
        deviation: real, rest_density: real, sound_speed: real, parameters: parameters_vector
    ):
        return wp.pow(real(1.0) + deviation / rest_density, parameters[0] - real(1.0))

    return wp.func(tait_stiffening)


@cache
def make_linear(arithmetic: Arithmetic) -> Any:
    """Linear: p = c0^2 (rho - rho0)."""
    real, parameters_vector = arithmetic.real, arithmetic.parameters

    def linear(deviation: real, rest_density: real, sound_speed: real, parameters: parameters_vector):
        return sound_speed * sound_speed * deviation

    return wp.func(linear)


@cache
def make_no_stiffening(arithmetic: Arithmetic) -> Any:
    """The sound speed is the same at every density."""
    real, parameters_vector = arithmetic.real, arithmetic.parameters

    def no_stiffening(deviation: real, rest_density: real, sound_speed: real, parameters: parameters_vector):
        return real(1.0)

    return wp.func(no_stiffening)


STRAIN_STEP = 1.0e-4


def difference_stiffening(make: Callable[[Arithmetic], Any]) -> Callable[[Arithmetic], Any]:
    """Return the factory of a stiffening that is the central difference of a state, over 2e-4 of the density."""

    @cache
    def make_stiffening(arithmetic: Arithmetic) -> Any:
        real, parameters_vector = arithmetic.real, arithmetic.parameters
        state = make(arithmetic)

        def stiffening(deviation: real, rest_density: real, sound_speed: real, parameters: parameters_vector):
            step = real(wp.static(STRAIN_STEP)) * rest_density
            above = state(deviation + step, rest_density, sound_speed, parameters)
            below = state(deviation - step, rest_density, sound_speed, parameters)
            return (above - below) / (real(2.0) * step * sound_speed * sound_speed)

        return wp.func(stiffening)

    return make_stiffening


STATES: dict[str, EquationOfState] = {
    "tait": EquationOfState(make_tait, make_tait_stiffening),
    "linear": EquationOfState(make_linear, make_no_stiffening),
}
"""By name; `warpsph.register_state` adds to it."""
