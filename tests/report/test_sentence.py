"""The sentence of a scene, from rows made by hand."""

from __future__ import annotations

import pytest
from report_rows import row

from warpsph.report.sentence import sentence_of
from warpsph.report.words import machine, percent, quoted_error, wall_time
from warpsph.validation.convergence import NOTE


def test_error_price_and_cost_of_half_the_error() -> None:
    """Order 2 in the error, 3 in the cost: 2^(3/2) = 2.8."""
    rows = [row(0.2, 0.052, 5.0), row(0.1, 0.013, 40.0)]
    assert (
        sentence_of(rows)
        == "Front within 1.3 % for 40 s on one thread; halving the error takes 2.8 times the work."
    )


def test_scatter_gives_a_range() -> None:
    """Order 3/2 +- 0.289 and cost order 3: 4 times, from 3.2 to 5.6."""
    rows = [row(1.0, 0.4, 1.0), row(0.5, 0.2, 8.0), row(0.25, 0.05, 64.0)]
    assert sentence_of(rows).endswith("halving the error takes 4 times the work (3.2 to 5.6).")


def test_it_speaks_of_the_worst_quantity_at_the_finest_resolution() -> None:
    rows = [
        row(0.2, 0.3, 5.0),
        row(0.2, 0.04, 5.0, quantity="wave_height"),
        row(0.1, 0.01, 40.0),
        row(0.1, 0.02, 40.0, quantity="wave_height"),
    ]
    expected = "Wave height within 2 % and one more quantity closer, for 40 s on one thread; "
    assert sentence_of(rows) == f"{expected}halving the error takes 8 times the work."


def test_nothing_is_claimed_below_the_uncertainty_of_the_reference() -> None:
    rows = [row(0.2, 0.05, 5.0, uncertainty=0.01), row(0.1, 0.002, uncertainty=0.01)]
    expected = "Front within 1 %, as close as the reference is known, for 40 s on one thread."
    assert sentence_of(rows) == expected


@pytest.mark.parametrize(
    ("rows", "told"),
    [
        ([row(0.1, 0.02)], "one resolution does not show"),
        ([row(0.2, 0.02, 5.0), row(0.1, 0.03)], "the error does not clearly fall"),
        ([row(0.2, 0.0201, 5.0), row(0.1, 0.02)], "takes more than 1000 times the work"),
    ],
)
def test_it_says_why_there_is_no_price(rows: list[dict[str, object]], told: str) -> None:
    assert told in sentence_of(rows)


def test_of_compared_options_the_best_is_named() -> None:
    rows = [
        row(0.1, 0.03, options={"kernel": "a"}),
        row(0.1, 0.02, options={"kernel": "b"}),
        row(0.1, None, None, options={"kernel": "c"}, device=None, threads=None),
    ]
    assert sentence_of(rows).startswith("With kernel=b: front within 2 % for 40 s on one thread")


def test_broken_bounds_are_named() -> None:
    limit = {"error_unit": "kg/s", "bound": 0.0, "quantity": "momentum_x"}
    rows = [row(0.1, 0.3, bound=0.1, holds=False), row(0.1, 0.02, holds=False, **limit)]
    assert sentence_of(rows).endswith("beyond its bound: front (30 %, bound 10 %), momentum x by 0.02 kg/s.")


def test_limits_alone() -> None:
    limit = {"error_unit": "kg/s", "bound": 0.0}
    rows = [
        row(0.1, 0.0, holds=True, quantity="a", **limit),
        row(0.1, 0.0, holds=True, quantity="b", **limit),
    ]
    assert sentence_of(rows) == "All 2 limits kept for 40 s on one thread."


def test_a_change_with_the_resolution_is_no_error_against_a_reference() -> None:
    rows = [row(0.2, None, bound=None, holds=None), row(0.1, 0.03, note=NOTE)]
    assert sentence_of(rows) == "Front changed by 3 % in the last refinement for 40 s on one thread."


def test_bounded_quantities_come_first_and_larger_errors_are_named() -> None:
    free = {"quantity": "experiment", "bound": None, "holds": None}
    rows = [row(0.2, 0.02, 5.0), row(0.2, 0.2, 5.0, **free), row(0.1, 0.005), row(0.1, 0.22, **free)]
    expected = "Front within 0.5 % for 40 s on one thread; halving the error takes 2.8 times the work; "
    assert sentence_of(rows) == f"{expected}without a bound: experiment 22 %."


def test_what_breaks_its_bound_is_not_within_anything() -> None:
    assert sentence_of([row(0.1, 0.3, bound=0.1, holds=False)]).startswith("Front off by 30 % for 40 s")


def test_a_run_that_diverged() -> None:
    rows = [row(0.2, 0.1), row(0.1, None, None, device=None, threads=None)]
    assert sentence_of(rows) == "The run at spacing 0.1 m did not come to its end; without a value: front."


def test_a_figure_that_is_missing_is_named() -> None:
    expected = "No figure that could be compared for 40 s on one thread; without a value: front."
    assert sentence_of([row(0.1, None)]) == expected


def test_words() -> None:
    assert [wall_time(s) for s in (0.723, 40.2, 119.0, 7200.0)] == ["0.72 s", "40 s", "2 min", "2 h"]
    assert [percent(e) for e in (0.0131, 0.5, 1.904)] == ["1.3 %", "50 %", "190 %"]
    assert [machine("cpu", 1), machine("cpu", 4), machine("cuda:0", 16)] == [
        "one thread",
        "4 threads",
        "cuda:0",
    ]
    assert quoted_error(row(0.1, 0.001, uncertainty=0.01)) == "<= 1 %"
    assert quoted_error(row(0.1, 0.013, uncertainty=0.01)) == "1.3 %"
    assert quoted_error(row(0.1, None)) == "-"
    assert quoted_error(row(0.1, 0.001, uncertainty=0.01) | {"error_unit": "m"}) == "<= 0.01 m"


def test_without_a_bound_an_error_is_what_it_is_off_by() -> None:
    """A reference that is known no better than that still makes it something to be within."""
    free = {"bound": None, "holds": None}
    assert sentence_of([row(0.1, 18.7, **free)]).startswith("Front off by 1870 % for 40 s")
    assert sentence_of([row(0.1, 0.01, uncertainty=0.2, **free)]).startswith("Front within 20 %, as close as")
