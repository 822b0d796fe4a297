"""Estimates of the discretisation error held against true errors: which figures count, and what is said of them."""

from __future__ import annotations

from typing import Any

import error_estimates
import pytest

from warpsph.scene.references import FeatureReference, InlineTable, LimitReference, SeriesReference
from warpsph.validation.convergence import NOTE

FEATURE = FeatureReference(source="none", column="x[m]", feature="maximum", value=1.0)
SERIES = SeriesReference(source="none", column="x[m]", table=InlineTable(time=(1.0, 2.0), value=(1.0, 1.0)))
LIMIT = LimitReference(source="none", column="x[m]", high=1.0)


def row(h: float, value: float | None, **more: Any) -> dict[str, Any]:
    return {"scene": "tank", "quantity": "x", "resolution": h, "value": value, "reference": 1.0, **more}


def trials_of(rows: list[dict[str, Any]], reference: Any = FEATURE) -> list[error_estimates.Trial]:
    return list(error_estimates.trials(rows, {("tank", "x"): reference}))


def test_two_and_three_finest_runs_are_tried() -> None:
    """f = 1 + h^2: the error at 0.1 is 0.01; with two runs and order 1 it is 0.04 - 0.01 over 2 - 1."""
    two, three = trials_of([row(h, 1.0 + h * h) for h in (0.8, 0.1, 0.4, 0.2)])
    assert two.spacings == (0.2, 0.1)
    assert three.spacings == (0.4, 0.2, 0.1)
    assert (two.estimate, two.true) == (pytest.approx(0.03), pytest.approx(0.01))
    assert (three.estimate, three.at_most) == (pytest.approx(0.01), pytest.approx(0.0125))
    assert two.covered
    assert three.covered


def test_an_error_that_does_not_change_is_missed_and_said_to_be() -> None:
    found = trials_of([row(h, 1.5 + 0.01 * h) for h in (0.2, 0.1)])
    assert not found[0].covered
    assert "**no**" in error_estimates.table(found)
    assert "with 2 spacings 0 of 1" in error_estimates.table(found)


def test_nothing_is_missed_below_the_uncertainty_of_the_reference() -> None:
    (one,) = trials_of([row(h, 1.05 + 0.01 * h, uncertainty=0.06) for h in (0.2, 0.1)])
    assert one.covered


@pytest.mark.parametrize("reference", [SERIES, LIMIT, None])
def test_only_single_figures_count(reference: Any) -> None:
    assert trials_of([row(0.2, 1.2), row(0.1, 1.1)], reference) == []


@pytest.mark.parametrize("more", [{"value": None}, {"reference": None}, {"note": NOTE}])
def test_rows_without_a_true_error_do_not_count(more: dict[str, Any]) -> None:
    assert trials_of([row(0.2, 1.2), {**row(0.1, 1.1), **more}]) == []
