"""Convergence studies from rows: orders, efficient fronts, and what half the error costs."""

from __future__ import annotations

import math
from typing import Any

import pytest

from warpsph.validation.convergence import NOTE
from warpsph.validation.halving import halving_cost
from warpsph.validation.study import Study, efficient, studies_of


def row(spacing: float, error: float | None, wall: float | None = 1.0, **other: Any) -> dict[str, Any]:
    steps = None if wall is None else round(10 * wall)
    fixed = {"scene": "tank", "quantity": "front", "steps": steps, "particles": 300}
    return {**fixed, "resolution": spacing, "error": error, "wall_seconds": wall, **other}


def study(*rows: dict[str, Any]) -> Study:
    (only,) = studies_of(rows)
    return only


def power_law(order: float, cost_order: float, count: int = 3) -> Study:
    """Errors 0.1 h^p and wall times 2 h^-s at h = 1, 1/2, 1/4 ..."""
    spacings = [0.5**k for k in range(count)]
    return study(*(row(h, 0.1 * h**order, 2.0 * h**-cost_order) for h in spacings))


def test_rows_are_grouped_by_scene_quantity_and_options() -> None:
    a, b = {"options": {"kernel": "a"}}, {"options": {"kernel": "b"}}
    rows = [
        row(0.1, 0.1),
        row(0.2, 0.2),
        row(0.1, 0.3, **a),
        row(0.1, 0.4, **b),
        row(0.1, 0.5, quantity="level"),
    ]
    found = [(s.quantity, s.label, [p.resolution for p in s.points]) for s in studies_of(rows)]
    assert found == [
        ("front", "", [0.2, 0.1]),
        ("front", "kernel=a", [0.1]),
        ("front", "kernel=b", [0.1]),
        ("level", "", [0.1]),
    ]


def test_limits_changes_and_reported_figures_make_no_study() -> None:
    assert studies_of([row(0.1, 0.0, error_unit="kg/s")]) == ()
    assert studies_of([row(0.2, None), row(0.1, 0.03, note=NOTE)]) == ()


def test_particle_steps_are_particles_times_steps() -> None:
    assert study(row(0.1, 0.1)).finest.particle_steps == 3000.0
    failed = row(0.1, None, None, steps=None, particles=None)
    assert study(row(0.2, 0.1), failed).finest.particle_steps is None


def test_errors_are_quoted_at_the_uncertainty_of_the_reference_at_least() -> None:
    points = study(row(0.2, 0.05, uncertainty=0.01), row(0.1, 0.002, uncertainty=0.01)).points
    assert [point.quoted for point in points] == [0.05, 0.01]
    assert [point.at_uncertainty for point in points] == [False, True]
    exact = study(row(0.1, 0.0)).finest
    assert (exact.quoted, exact.at_uncertainty) == (0.0, False)


def test_errors_within_the_uncertainty_tell_nothing_about_the_order() -> None:
    """0.4, 0.1 fall by order 2; 0.02, below the uncertainty 0.03, would make it 2.16."""
    rows = [row(h, e, uncertainty=0.03) for h, e in ((0.4, 0.4), (0.2, 0.1), (0.1, 0.02))]
    order = study(*rows).order
    assert order is not None
    assert order.order == pytest.approx(2.0)
    assert order.standard_error is None


def test_a_run_without_an_error_counts_for_nothing() -> None:
    assert study(row(0.2, 0.1), row(0.1, None, None)).order is None


def test_front_keeps_what_nothing_beats() -> None:
    """(2, 3) is beaten by (1, 3), which costs less for the same error; (4, 2) by (3, 1) in both."""
    costs = [1.0, 2.0, 3.0, 4.0, None, 5.0]
    errors = [3.0, 3.0, 1.0, 2.0, 0.1, None]
    assert efficient(costs, errors) == [True, False, True, False, False, False]


def test_equal_pairs_are_both_efficient() -> None:
    assert efficient([1.0, 1.0], [2.0, 2.0]) == [True, True]


def test_halving_of_power_laws() -> None:
    """Half the error takes a spacing 2^(-1/p) times as large, which costs 2^(s / p): 2^(3 / 2) = 2.83."""
    cost = halving_cost(power_law(2.0, 3.0))
    assert cost is not None
    assert cost.factor == pytest.approx(2.0**1.5)
    assert cost.range == pytest.approx((2.0**1.5, 2.0**1.5))


def test_no_order_above_that_of_the_scheme_is_relied_on() -> None:
    steep, formal = halving_cost(power_law(6.0, 3.0)), halving_cost(power_law(2.0, 3.0))
    assert steep is not None
    assert formal is not None
    assert steep.factor == pytest.approx(formal.factor)


def test_two_resolutions_give_no_range() -> None:
    cost = halving_cost(power_law(1.0, 3.0, count=2))
    assert cost is not None
    assert cost.factor == pytest.approx(8.0)
    assert cost.range is None


def test_scattered_errors_give_a_range_about_the_factor() -> None:
    """Logarithms to base 2 of the errors are 0, -1, -3 over those of h 0, -1, -2: p = 3/2, residuals 1/6, -1/3, 1/6.

    Their standard error is sqrt(1/6 / 1 / 2) = 0.289 and the costs go as h^-3.
    """
    cost = halving_cost(study(row(1.0, 1.0, 1.0), row(0.5, 0.5, 8.0), row(0.25, 0.125, 64.0)))
    assert cost is not None
    assert cost.factor == pytest.approx(4.0)
    spread = math.sqrt(1.0 / 12.0)
    assert cost.range == pytest.approx((2.0 ** (3.0 / (1.5 + spread)), 2.0 ** (3.0 / (1.5 - spread))))


@pytest.mark.parametrize("errors", [(0.1, 0.1, 0.1), (0.1, 0.2, 0.4), (0.1, 0.4, 0.08)])
def test_an_error_that_does_not_clearly_fall_has_no_price(errors: tuple[float, ...]) -> None:
    """The last: orders -2 and 2.3, on average 0.16 with a standard error of 1.25."""
    rows = [row(0.5**k, error, 8.0**k) for k, error in enumerate(errors)]
    assert halving_cost(study(*rows)) is None


def test_one_resolution_shows_no_price() -> None:
    assert halving_cost(study(row(0.1, 0.1))) is None
