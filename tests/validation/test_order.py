"""Observed order of convergence."""

from __future__ import annotations

import math

import pytest

from warpsph.validation.order import observed_order


@pytest.mark.parametrize("p", [0.5, 1.0, 2.0])
def test_power_law_gives_its_exponent_exactly(p: float) -> None:
    spacings = [0.1, 0.05, 0.02, 0.01]
    order = observed_order(spacings, [3.0 * h**p for h in spacings])
    assert order is not None
    assert order.order == pytest.approx(p)
    assert order.standard_error == pytest.approx(0.0, abs=1e-7)


def test_two_resolutions_give_no_standard_error() -> None:
    order = observed_order([0.2, 0.1], [0.04, 0.01])
    assert order is not None
    assert order.order == pytest.approx(2.0)
    assert order.standard_error is None


def test_standard_error_of_scattered_errors() -> None:
    """Errors 1, 2, 1 over spacings e^0, e^1, e^2: slope 0, residual sum 2/3 (ln 2)^2, one degree of freedom."""
    order = observed_order([1.0, math.e, math.e**2], [1.0, 2.0, 1.0])
    assert order is not None
    assert order.order == pytest.approx(0.0, abs=1e-12)
    assert order.standard_error == pytest.approx(math.log(2.0) * math.sqrt(2.0 / 3.0 / 2.0))


def test_errors_that_tell_nothing_are_left_out() -> None:
    assert observed_order([0.2, 0.1, 0.05], [math.nan, 0.0, 0.01]) is None
    assert observed_order([0.1, 0.1], [0.1, 0.2]) is None
