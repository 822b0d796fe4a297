"""Equations of state in either precision against their closed forms."""

import numpy as np
import pytest
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.state import STATES

DENSITY, SOUND_SPEED = 1000.0, 40.0


def evaluated(make, deviation: np.ndarray, precision: str, *numbers: float) -> np.ndarray:
    """A device function of a state at density deviations."""
    arithmetic = Arithmetic(2, precision)
    real, parameters = arithmetic.real, arithmetic.parameters
    function = make(arithmetic)

    @wp.kernel(module="unique", enable_backward=False)
    def evaluate(argument: wp.array(dtype=real), given: parameters, value: wp.array(dtype=real)):
        i = wp.tid()
        value[i] = function(argument[i], real(DENSITY), real(SOUND_SPEED), given)

    value = wp.zeros(len(deviation), dtype=real, device="cpu")
    argument = wp.array(deviation, dtype=real, device="cpu")
    given = parameters(*numbers, *(0.0 for _ in range(4 - len(numbers))))
    wp.launch(evaluate, len(deviation), inputs=[argument, given, value], device="cpu")
    return value.numpy()


def tait(deviation: np.ndarray, gamma: float) -> np.ndarray:
    strength = DENSITY * SOUND_SPEED**2 / gamma
    return strength * np.expm1(gamma * np.log1p(deviation / DENSITY))


@pytest.mark.parametrize(("precision", "rounding"), [("single", 1e-6), ("double", 1e-14)])
def test_tait_keeps_small_deviations(precision, rounding):
    deviation = DENSITY * np.array([-1e-2, -1e-6, 1e-7, 1e-3, 5e-2])
    pressure = evaluated(STATES["tait"].make, deviation, precision, 7.0)
    assert pressure == pytest.approx(tait(deviation, 7.0), rel=rounding)


def test_tait_for_an_exponent_that_is_no_integer():
    # The series ends after e^8: at 5 per cent compression the rest is below 1e-10 of the bracket.
    deviation = DENSITY * np.array([-0.05, 0.01, 0.05])
    pressure = evaluated(STATES["tait"].make, deviation, "double", 1.4)
    assert pressure == pytest.approx(tait(deviation, 1.4), rel=1e-9)


@pytest.mark.parametrize(("precision", "rounding"), [("single", 1e-6), ("double", 1e-14)])
def test_linear_is_linear(precision, rounding):
    deviation = DENSITY * np.array([-0.5, -1e-6, 0.0, 1e-7, 0.3])
    pressure = evaluated(STATES["linear"].make, deviation, precision)
    assert pressure == pytest.approx(SOUND_SPEED**2 * deviation, rel=rounding)


@pytest.mark.parametrize(("name", "numbers"), [("tait", (7.0,)), ("tait", (1.4,)), ("linear", ())])
def test_stiffening_is_the_slope_of_the_pressure(name, numbers):
    # Central difference: error of order step^2, rounding of order 1e-16 / step.
    deviation = DENSITY * np.array([-0.02, 0.0, 0.01, 0.03])
    step = 1e-5 * DENSITY
    above, below = (evaluated(STATES[name].make, deviation + s, "double", *numbers) for s in (step, -step))
    stiffening = evaluated(STATES[name].make_stiffening, deviation, "double", *numbers)
    assert stiffening == pytest.approx((above - below) / (2.0 * step) / SOUND_SPEED**2, rel=1e-7)
