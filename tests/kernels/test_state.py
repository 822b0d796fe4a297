"""The equation of state in either precision against its closed form."""

import numpy as np
import pytest
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.state import make_tait

DENSITY, SOUND_SPEED = 1000.0, 40.0


def pressure(deviation: np.ndarray, precision: str, gamma: float) -> np.ndarray:
    arithmetic = Arithmetic(2, precision)
    real, state = arithmetic.real, make_tait(arithmetic)

    @wp.kernel(module="unique", enable_backward=False)
    def evaluate(argument: wp.array(dtype=real), exponent: real, value: wp.array(dtype=real)):
        i = wp.tid()
        value[i] = state(argument[i], real(DENSITY), real(SOUND_SPEED), exponent)

    value = wp.zeros(len(deviation), dtype=real, device="cpu")
    argument = wp.array(deviation, dtype=real, device="cpu")
    wp.launch(evaluate, len(deviation), inputs=[argument, gamma, value], device="cpu")
    return value.numpy()


def closed_form(deviation: np.ndarray, gamma: float) -> np.ndarray:
    strength = DENSITY * SOUND_SPEED**2 / gamma
    return strength * np.expm1(gamma * np.log1p(deviation / DENSITY))


@pytest.mark.parametrize(("precision", "rounding"), [("single", 1e-6), ("double", 1e-14)])
def test_tait_keeps_small_deviations(precision, rounding):
    deviation = DENSITY * np.array([-1e-2, -1e-6, 1e-7, 1e-3, 5e-2])
    assert pressure(deviation, precision, 7.0) == pytest.approx(closed_form(deviation, 7.0), rel=rounding)


def test_tait_for_an_exponent_that_is_no_integer():
    # The series ends after e^8: at 5 per cent compression the rest is below 1e-10 of the bracket.
    deviation = DENSITY * np.array([-0.05, 0.01, 0.05])
    assert pressure(deviation, "double", 1.4) == pytest.approx(closed_form(deviation, 1.4), rel=1e-9)
