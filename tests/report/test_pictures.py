"""What is drawn and what is not; how it looks is for eyes."""

from __future__ import annotations

import numpy as np
import pytest
from report_rows import row

from warpsph.report.curves import Chart, Curve, Mark
from warpsph.report.pictures import chart_picture, errors_picture
from warpsph.validation.study import studies_of

PNG = b"\x89PNG\r\n\x1a\n"


@pytest.mark.parametrize(
    "rows",
    [
        [row(0.1, 0.01)],
        [row(0.2, 0.0), row(0.1, 0.0)],
        [row(0.2, None, None), row(0.1, 0.01)],
        [row(0.1, 0.01), row(0.1, 0.02, quantity="level")],
    ],
)
def test_what_does_not_vary_is_not_drawn(rows: list[dict[str, object]]) -> None:
    assert errors_picture(studies_of(rows), "errors") is None


def test_errors_are_drawn_also_at_the_uncertainty_and_without_a_cost() -> None:
    rows = [row(0.2, 0.05, uncertainty=0.01), row(0.1, 0.001, uncertainty=0.01)]
    picture = errors_picture(studies_of(rows), "errors")
    assert picture is not None
    assert picture.startswith(PNG)


@pytest.mark.parametrize("count", [0, 1, 3, 100])
def test_references_of_any_length_are_drawn(count: int) -> None:
    x = np.linspace(0.0, 1.0, count)
    marks = (Mark("peak", 0.5, 0.1, is_time=True), Mark("height", 1.0, 0.0, is_time=False))
    run = Curve("0.1 m", np.array([0.0, 1.0]), np.array([np.nan, 1.0]))
    chart = Chart("a", "a", "time [s]", "height [m]", (run,), Curve("reference", x, x, 0.1 * x), marks)
    assert chart_picture(chart).startswith(PNG)
