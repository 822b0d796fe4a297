"""Series references: interpolation, norms, the fitted lag, and what a run did not reach."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from compared_scenes import tank_with

from warpsph.comparison.compare import Comparison, compare_run

FRONT = "front.position[m]"
TIMES = np.linspace(0.0, 2.0, 201)


def compared(values: np.ndarray, times: np.ndarray = TIMES, **reference: Any) -> Comparison:
    scene = tank_with(front={"type": "series", "column": FRONT, **reference})
    (row,) = compare_run(scene, {"time[s]": times, FRONT: values})
    return row


def table(times: list[float], values: list[float]) -> dict[str, Any]:
    return {"table": {"time": times, "value": values}}


def test_max_norm_reports_the_worst_time() -> None:
    row = compared(TIMES, **table([0.5, 1.0, 1.5], [0.5, 1.1, 1.5]), bound=0.05)
    assert (row.value, row.reference) == pytest.approx((1.0, 1.1))
    assert row.error == pytest.approx(0.1 / 1.1)
    assert row.holds is False


def test_rms_norm_is_the_root_of_the_mean_square() -> None:
    row = compared(TIMES, **table([1.0, 2.0], [1.3, 1.6]), norm="rms", relative_to=1.0)
    assert row.error == pytest.approx(math.sqrt((0.3**2 + 0.4**2) / 2))


def test_comparison_at_other_times_interpolates_table_and_run() -> None:
    row = compared(3.0 * TIMES, **table([0.0, 2.0], [0.0, 6.0]), at=[0.333, 1.777], bound=1e-9)
    assert row.holds is True


def test_row_without_bound_has_no_verdict() -> None:
    assert compared(TIMES, **table([1.0], [1.0])).holds is None


def test_file_table_is_scaled_and_found_beside_the_scene(tmp_path: Path) -> None:
    (tmp_path / "front.csv").write_text("# measured\nT,Z\n10,100\n20,200\n")
    source = {"file": "front.csv", "time": "T", "value": "Z", "time_scale": 0.1, "value_scale": 0.01}
    scene = tank_with(tmp_path, front={"type": "series", "column": FRONT, "table": source})
    (row,) = compare_run(scene, {"time[s]": TIMES, FRONT: TIMES})
    assert [sample.reference for sample in row.samples] == pytest.approx([1.0, 2.0])
    assert row.error == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("lag", [0.12, -0.07])
def test_fitted_lag_is_found_and_removed(lag: float) -> None:
    """The run is the reference shifted by the lag, so that the error left is that of interpolation, dt^2/8 f''."""
    times = [0.3, 0.6, 0.9, 1.2, 1.5]
    row = compared((TIMES - lag) ** 2, **table(times, [t**2 for t in times]), lag="fit", relative_to=1.0)
    assert row.lag == pytest.approx(lag, abs=1e-3)
    assert row.error < 2 * 0.01**2 / 4


def test_without_lag_the_same_run_is_wrong() -> None:
    times = [0.3, 0.6, 0.9, 1.2, 1.5]
    row = compared((TIMES - 0.12) ** 2, **table(times, [t**2 for t in times]), relative_to=1.0)
    assert row.lag is None
    assert row.error == pytest.approx(1.5**2 - 1.38**2)


def test_no_lag_is_fitted_to_two_times() -> None:
    row = compared(TIMES, **table([0.5, 1.0], [0.4, 0.9]), lag="fit")
    assert row.lag is None
    assert row.note is not None
    assert "takes 3 times" in row.note


def test_lag_at_the_edge_of_the_search_is_said() -> None:
    times = [0.5, 1.0, 1.5]
    row = compared(np.maximum(TIMES - 0.45, 0.0), **table(times, times), lag="fit")
    assert row.note is not None
    assert "edge" in row.note


def test_time_that_the_run_did_not_reach_never_holds() -> None:
    short = TIMES[TIMES < 1.2]
    row = compared(short, short, **table([1.0, 1.5], [1.0, 1.5]), bound=10.0)
    assert row.holds is False
    assert row.note == "no value at t = 1.5 s; the run reached 1.19 s"


def test_table_beyond_the_end_of_the_scene_is_not_asked_for() -> None:
    row = compared(TIMES, **table([1.0, 2.0, 3.0], [1.0, 2.0, 3.0]), bound=1e-9)
    assert row.holds is True
    assert len(row.samples) == 2


def test_value_that_is_no_number_never_holds() -> None:
    row = compared(
        np.where(np.abs(TIMES - 1.0) < 1e-9, np.nan, TIMES), **table([1.0, 2.0], [1.0, 2.0]), bound=10.0
    )
    assert math.isnan(row.error)
    assert row.holds is False


def test_zero_reference_relative_to_itself_never_holds() -> None:
    row = compared(np.zeros_like(TIMES), **table([0.0, 2.0], [-1.0, 1.0]), at=[1.0], bound=10.0)
    assert row.holds is False


def test_an_unrolled_angle_goes_on_where_it_begins_anew() -> None:
    """3 rad/s for 2 s is 6 rad, which atan2 tells as 6 - 2 pi."""
    wrapped = (3.0 * TIMES + np.pi) % (2.0 * np.pi) - np.pi
    expected = table([0.5, 1.5, 2.0], [1.5, 4.5, 6.0])
    assert compared(wrapped, **expected, unroll=2.0 * np.pi, bound=1e-9).holds is True
    assert compared(wrapped, **expected, bound=1e-9).holds is False
