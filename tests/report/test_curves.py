"""Curves over their references: bands, lags, and which runs are shown."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from compared_scenes import tank_with

from warpsph.comparison.compare import compare_run
from warpsph.output.probes_csv import ProbesCsv
from warpsph.output.run_directory import RunDirectory
from warpsph.report.curves import Chart, charts_of, half_width
from warpsph.validation.runner import Case, CaseResult

TIMES = [0.0, 0.5, 1.0, 1.5, 2.0]
FRONT = [1.0, 1.0, 1.5, 2.0, 2.5]
SERIES = {"type": "series", "column": "front.position[m]"}


def charts(tmp_path: Path, options: tuple[str, ...] = (), **references: dict[str, Any]) -> tuple[Chart, ...]:
    """The charts of one run, whose front stands still for half a second and then runs at 1 m/s."""
    return charts_of([finished_run(tmp_path, options, **references)], tmp_path)


def finished_run(tmp_path: Path, options: tuple[str, ...], **references: dict[str, Any]) -> CaseResult:
    case = Case(tank_with(**references), options)
    directory = tmp_path / case.directory
    directory.mkdir(parents=True, exist_ok=True)
    writer = ProbesCsv(RunDirectory(directory).probes, ["front.position[m]"])
    writer.open()
    for time, position in zip(TIMES, FRONT, strict=True):
        writer.write(time, [position])
    writer.close()
    history = {"time[s]": np.array(TIMES), "front.position[m]": np.array(FRONT)}
    rows = tuple(row.as_record() for row in compare_run(case.scene, history))
    return CaseResult(case, rows)


@pytest.mark.parametrize(
    ("relative_to", "expected"), [("value", [0.2, 0.1]), ("peak", [0.2, 0.2]), (3.0, [0.3, 0.3])]
)
def test_the_band_is_relative_to_what_errors_are_divided_by(relative_to: Any, expected: list[float]) -> None:
    np.testing.assert_allclose(half_width(np.array([-2.0, 1.0]), relative_to, 0.1), expected)


def test_a_series_has_its_run_its_table_and_its_band(tmp_path: Path) -> None:
    table = {"time": [0.5, 1.5, 2.5], "value": [1.0, 2.0, 3.0]}
    (chart,) = charts(tmp_path, front=SERIES | {"table": table, "uncertainty": 0.1})
    (run,) = chart.runs
    assert (chart.x_label, chart.y_label, run.label) == ("time [s]", "front: position [m]", "0.1 m")
    assert run.y.tolist() == FRONT
    assert chart.reference is not None
    assert chart.reference.x.tolist() == [0.5, 1.5]  # the run ends at 2 s
    np.testing.assert_allclose(chart.reference.half_width, [0.1, 0.2])


def test_a_run_is_drawn_without_its_fitted_lag(tmp_path: Path) -> None:
    """The front of the reference runs from the start on: the run is 0.2 s late, as late as lags are sought."""
    table = {"time": [0.0, 0.2, 0.4, 1.0], "value": [1.0, 1.2, 1.4, 2.0]}
    result = finished_run(tmp_path, (), front=SERIES | {"table": table, "lag": "fit"})
    lag = result.rows[0]["lag"]
    assert lag > 0.1
    (chart,) = charts_of([result], tmp_path)
    np.testing.assert_allclose(chart.runs[0].x, np.array(TIMES) - lag)
    assert "without its lag" in chart.runs[0].label


def test_figures_of_a_column_share_a_chart(tmp_path: Path) -> None:
    feature = {"type": "feature", "column": "front.position[m]"}
    (chart,) = charts(
        tmp_path,
        level=feature | {"feature": "maximum", "value": 2.5, "uncertainty": 0.01},
        arrival=feature | {"feature": "arrival", "threshold": 2.0, "value": 1.5},
        period=feature | {"feature": "period", "value": 1.0},
    )
    found = [(mark.at, mark.is_time, mark.half_width) for mark in chart.marks]
    assert found == [(2.5, False, pytest.approx(0.025)), (1.5, True, 0.0)]


def test_limits_have_no_curve(tmp_path: Path) -> None:
    assert charts(tmp_path, front={"type": "limit", "column": "front.position[m]", "high": 3.0}) == ()


def test_compared_options_show_their_finest_runs(tmp_path: Path) -> None:
    table = {"time": [1.0], "value": [1.5]}
    results = [
        finished_run(tmp_path, (option,), front=SERIES | {"table": table}) for option in ("a=1", "a=2")
    ]
    (chart,) = charts_of([results[0], *results], tmp_path)
    assert [run.label for run in chart.runs] == ["a=1, 0.1 m", "a=2, 0.1 m"]


def test_a_run_that_failed_has_no_curve(tmp_path: Path) -> None:
    assert charts_of([CaseResult(Case(tank_with()), (), "diverged")], tmp_path) == ()
