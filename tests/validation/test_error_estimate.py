"""Discretisation errors of the figures of a run, against figures of known order."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from warpsph.scene import scene_from_yaml
from warpsph.validation.error_estimate import error_estimates
from warpsph.validation.pilots import FinishedRun

SCENE = """
name: tank
dimension: 2
spacing: 0.1
gravity: [0.0, -9.81]
time: {end: 2.0, frame_rate: 10}
fluids:
  water: {shape: {type: box, min: [0, 0], max: [1, 1]}, density: 1000}
probes:
  front: {type: front, axis: x}
references:
  peak: {type: feature, column: "front.position[m]", feature: maximum, source: none}
  curve:
    {type: series, column: "front.position[m]", table: {time: [1.0, 2.0], value: [1.0, 1.0]}, source: none}
  kept: {type: limit, column: "front.position[m]", high: 3.0, source: none}
accuracy:
  quantity: {column: "front.position[m]", feature: mean, window: [0.0, 2.0]}
  within: 3%
"""


def run_at(h: float, directory: Path, p: float = 1.5, peak: float | None = 0.0) -> FinishedRun:
    """peak = 2 + 4 h^p; curve = (1 + h^p, 2 - 3 h^p); the mean of the front is 1 + 2 h^p."""
    error = h**p
    rows: list[dict[str, Any]] = [
        {"quantity": "peak", "value": None if peak is None else 2.0 + 4.0 * error},
        {"quantity": "curve", "samples": [{"value": 1.0 + error}, {"value": 2.0 - 3.0 * error}]},
        {"quantity": "kept", "value": 1.0},
    ]
    own = directory / f"{h:g}"
    own.mkdir()
    front = 1.0 + 2.0 * error
    lines = "".join(f"{time},{front!r}\n" for time in (0.0, 1.0, 2.0))
    (own / "probes.csv").write_text(f"time[s],front.position[m]\n{lines}")
    return FinishedRun(scene_from_yaml(SCENE, overrides=[f"spacing={h!r}"]), {"references": rows}, own)


def test_two_other_runs_show_the_order(tmp_path: Path) -> None:
    peak, curve, mean = error_estimates(
        run_at(0.05, tmp_path), [run_at(0.2, tmp_path), run_at(0.1, tmp_path)]
    )
    h = 0.05**1.5
    assert (peak["quantity"], curve["quantity"]) == ("peak", "curve")
    assert mean["quantity"] == "mean of front.position[m]"
    assert [record["order"] for record in (peak, curve, mean)] == pytest.approx([1.5] * 3)
    assert [record["order_is"] for record in (peak, curve, mean)] == ["observed"] * 3
    assert peak["error"] == pytest.approx(4.0 * h)
    assert peak["relative_error"] == pytest.approx(4.0 * h / (2.0 + 4.0 * h))
    assert peak["uncertainty"] == pytest.approx(1.25 * peak["error"])
    assert curve["error"] == pytest.approx(((1.0 + 9.0) / 2.0) ** 0.5 * h)
    assert curve["extrapolated_value"] == pytest.approx([1.0, 2.0])
    assert mean["error"] == pytest.approx(2.0 * h)
    assert [record["unit"] for record in (peak, curve, mean)] == ["m"] * 3
    assert peak["spacings"] == [0.2, 0.1, 0.05]


def test_one_other_run_leaves_the_order_to_be_assumed(tmp_path: Path) -> None:
    """With order 1 and ratio 2 the error is the change from the coarse run."""
    peak, *_ = error_estimates(run_at(0.1, tmp_path, p=1.0), [run_at(0.2, tmp_path, p=1.0)])
    assert (peak["order"], peak["order_is"]) == (1.0, "assumed")
    assert peak["error"] == pytest.approx(0.4)
    assert peak["uncertainty"] == pytest.approx(1.2)


def test_finer_runs_tell_of_a_coarser_one(tmp_path: Path) -> None:
    """The error is that of the run itself, and not that of the finest."""
    others = [run_at(0.1, tmp_path), run_at(0.05, tmp_path)]
    peak, *_ = error_estimates(run_at(0.2, tmp_path), others)
    assert peak["error"] == pytest.approx(4.0 * 0.2**1.5)


def test_a_run_without_the_figure_gives_no_estimate(tmp_path: Path) -> None:
    peak, curve, _ = error_estimates(run_at(0.1, tmp_path), [run_at(0.2, tmp_path, peak=None)])
    assert peak["error"] is None
    assert peak["order"] is None
    assert peak["note"] == "a run has no value of it"
    assert curve["error"] is not None


def test_an_order_that_is_not_believed_is_called_assumed(tmp_path: Path) -> None:
    runs = [run_at(h, tmp_path, p=4.0) for h in (0.2, 0.1, 0.05)]
    peak, *_ = error_estimates(runs[-1], runs[:-1])
    assert (peak["order"], peak["order_is"]) == (1.0, "assumed")
    assert peak["observed_order"] == pytest.approx(4.0)
