"""Richardson extrapolation against manufactured figures f = f0 + C h^p of known order and limit."""

from __future__ import annotations

import numpy as np
import pytest

from warpsph.validation.richardson import extrapolate, observed_richardson_order

UNEQUAL = (0.1, 0.1 / 1.5, 0.05)


def figures(spacings: tuple[float, ...], p: float, slope: float = 3.0) -> list[np.ndarray]:
    return [np.array([7.0 + slope * h**p]) for h in spacings]


@pytest.mark.parametrize("p", [0.5, 1.0, 1.37, 2.0])
@pytest.mark.parametrize("slope", [3.0, -3.0])
def test_power_law_gives_its_order_limit_and_error_exactly(p: float, slope: float) -> None:
    found = extrapolate(UNEQUAL, figures(UNEQUAL, p, slope))
    assert found.behaviour == "converging"
    assert found.observed == pytest.approx(p, rel=1e-6)
    assert found.limit == pytest.approx(7.0)
    assert found.error == pytest.approx(3.0 * 0.05**p, rel=1e-5)
    assert found.uncertainty == pytest.approx(1.25 * found.error)
    assert found.order_uncertainty == pytest.approx(2.0 - p, abs=1e-6)


def test_order_of_equal_ratios_is_the_logarithm_of_the_changes() -> None:
    """p = ln(e32 / e21) / ln r where both ratios are r."""
    assert observed_richardson_order(5.0, 1.5, 1.5) == pytest.approx(np.log(5.0) / np.log(1.5))


def test_celik_and_others_example_of_a_reattachment_length() -> None:
    """Celik et al. 2008, table 1: N = 18000, 8000, 4500 cells in the plane; 6.063, 5.972, 5.863 give p = 1.53, an
    extrapolated value of 6.1685 and a fine-grid index of 2.2 %."""
    spacings = tuple(n**-0.5 for n in (4500, 8000, 18000))
    found = extrapolate(spacings, [np.array([f]) for f in (5.863, 5.972, 6.063)])
    assert found.observed == pytest.approx(1.53, abs=0.01)
    assert found.limit == pytest.approx(6.1685, abs=1e-3)
    assert found.uncertainty / found.scale == pytest.approx(0.022, abs=5e-4)


def test_error_falls_with_the_order() -> None:
    found = extrapolate(UNEQUAL, figures(UNEQUAL, 1.5))
    assert found.error * found.growth(0.01) == pytest.approx(3.0 * 0.01**1.5, rel=1e-5)
    assert found.error_of(figures(UNEQUAL, 1.5)[0]) == pytest.approx(3.0 * 0.1**1.5, rel=1e-5)


def test_two_spacings_assume_the_first_order_and_a_large_factor_of_safety() -> None:
    found = extrapolate((0.2, 0.1), figures((0.2, 0.1), 1.0))
    assert (found.behaviour, found.order, found.observed) == ("order assumed", 1.0, None)
    assert found.error == pytest.approx(0.3)
    assert found.uncertainty == pytest.approx(0.9)


def test_no_order_above_the_formal_one_is_relied_on() -> None:
    """f = 7 + 3 h^4: the error with order 1 is the change over r - 1, and the factor of safety is 3."""
    found = extrapolate(UNEQUAL, figures(UNEQUAL, 4.0))
    assert found.observed == pytest.approx(4.0)
    assert found.order == 1.0
    assert found.error == pytest.approx(3.0 * ((0.1 / 1.5) ** 4 - 0.05**4) / (4.0 / 3.0 - 1.0))
    assert found.error > 3.0 * 0.05**4
    assert found.uncertainty == pytest.approx(3.0 * found.error)


def test_an_order_just_above_the_formal_one_is_the_formal_one() -> None:
    found = extrapolate(UNEQUAL, figures(UNEQUAL, 2.05))
    assert found.order == 2.0
    assert found.uncertainty == pytest.approx(1.25 * found.error)


@pytest.mark.parametrize(
    ("values", "behaviour"),
    [
        ((1.0, 1.2, 1.1), "oscillating"),
        ((1.0, 1.2, 1.2), "oscillating"),
        ((1.0, 1.1, 1.3), "diverging"),
        ((1.0, 1.1, 1.18), "slow"),
    ],
)
def test_changes_without_an_order_are_named(values: tuple[float, ...], behaviour: str) -> None:
    """The error is then the range over h3 / h1 - 1 = 1, with a factor of safety of 3."""
    found = extrapolate((0.4, 0.28, 0.2), [np.array([v]) for v in values])
    assert found.behaviour == behaviour
    assert found.order is None
    assert not found.relies_on_observation
    assert found.error == pytest.approx(max(values) - min(values))
    assert found.uncertainty == pytest.approx(3.0 * found.error)
    with pytest.raises(ValueError, match=behaviour):
        found.growth(0.1)


def test_equal_figures_have_no_error() -> None:
    found = extrapolate(UNEQUAL, [np.array([2.0])] * 3)
    assert (found.behaviour, found.error, found.uncertainty) == ("equal", 0.0, 0.0)


def test_several_values_share_one_order() -> None:
    """f_k = a_k + c_k h^1.5: the error is the root mean square of c_k h^1.5."""
    limit, slopes = np.array([1.0, -2.0, 4.0]), np.array([0.5, 2.0, -1.0])
    found = extrapolate(UNEQUAL, [limit + slopes * h**1.5 for h in UNEQUAL])
    assert found.observed == pytest.approx(1.5)
    assert found.limit == pytest.approx(limit)
    assert found.error == pytest.approx(np.sqrt(np.mean(slopes**2)) * 0.05**1.5)


def test_only_the_three_finest_count() -> None:
    spacings = (0.4, *UNEQUAL)
    found = extrapolate(spacings, [np.array([-100.0]), *figures(UNEQUAL, 1.2)])
    assert found.observed == pytest.approx(1.2)


@pytest.mark.parametrize("spacings", [(0.1,), (0.1, 0.1), (0.1, 0.2)])
def test_spacings_that_do_not_fall_are_refused(spacings: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="finer"):
        extrapolate(spacings, [np.array([1.0])] * len(spacings))
