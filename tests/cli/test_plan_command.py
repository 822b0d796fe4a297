"""`warpsph plan`: pilots, proposals and exit codes."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import fake_runs
import pytest
from fake_runs import converging
from typer.testing import Result

Command = Callable[..., Result]
ASKING = "accuracy={quantity: front, within: 1%}"


def test_real_pilots_run_once(warpsph: Command, scene_file: Path, tmp_path: Path) -> None:
    """Another target takes the same pilots; they stay in the directory of the run, with a record of the plan."""
    figure = '{column: "front.position[m]", feature: maximum}'
    first, second = (
        warpsph(
            "plan", scene_file, "--set", f"accuracy={{quantity: {figure}, within: {within}}}", "--json",
            "--out", tmp_path / "out",
        )
        for within in ("5%", "20%")
    )  # fmt: skip
    assert "kept" not in first.stderr
    assert second.stderr.count("kept") == 3
    record = json.loads(second.stdout)
    assert record["quantity"] == "maximum of front.position[m]"
    assert record["unit"] == "m"
    assert [pilot["spacing"] for pilot in record["pilots"]] == pytest.approx([0.25, 0.25 / 1.5, 0.125])
    assert all(pilot["wall_seconds"] > 0 and pilot["memory_bytes"] > 0 for pilot in record["pilots"])
    assert record["pilots"] == json.loads(first.stdout)["pilots"]
    assert json.loads((tmp_path / "out" / "plan.json").read_text()) == record
    assert not list((tmp_path / "out").rglob("*.usdc"))


def test_a_proposal_says_spacing_error_and_cost(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    """1.25 * 0.5 h^2 <= 1 % of 1.008 asks for h <= 0.127: the finest pilot, 0.125."""
    ending(converging(2.0))
    result = warpsph("plan", scene_file, "--set", ASKING, "--out", tmp_path)
    assert result.exit_code == 0
    assert "tank: front within 1 % of its value" in result.stdout
    assert "convergence: observed order 2.00 +- 0.00" in result.stdout
    assert "proposed: spacing 0.125 m; expected error 0.775 %" in result.stdout
    assert "at most 0.969 %" in result.stdout
    assert "on cpu, 2 threads, 800 kB" in result.stdout
    assert "pilot 3/3 at spacing 0.125 m" in result.stderr


def test_pilots_that_do_not_converge_fail_with_advice(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    ending(converging(-1.0))
    result = warpsph("plan", scene_file, "--set", ASKING, "--out", tmp_path, "--quiet")
    assert result.exit_code == 1
    assert "convergence: none, diverging: observed order -1.00" in result.stdout
    assert "no spacing is proposed: the figure changes more with each finer spacing" in result.stdout
    assert "accuracy.pilots: [0.125, 0.08333, 0.0625]" in result.stdout
    assert result.stderr == ""


def test_a_pilot_without_the_figure_is_named(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    ending(lambda out: fake_runs.summary({**fake_runs.REFERENCE_ROW, "samples": [{"value": None}]}))
    result = warpsph("plan", scene_file, "--set", ASKING, "--out", tmp_path)
    assert result.exit_code == 1
    assert "the pilot at spacing 0.25 m has no value of front" in result.stderr


def test_a_scene_that_asks_for_nothing_is_bad_input(
    warpsph: Command, scene_file: Path, tmp_path: Path
) -> None:
    result = warpsph("plan", scene_file, "--out", tmp_path)
    assert result.exit_code == 2
    assert "the scene asks for no accuracy" in result.stderr
    assert "within: 3%" in result.stderr


def test_pilots_that_cannot_run_are_found_before_the_first_run(
    warpsph: Command, scene_file: Path, tmp_path: Path
) -> None:
    asking = "accuracy={quantity: front, within: 1%, pilots: [0.25, 1e-7]}"
    result = warpsph("plan", scene_file, "--set", asking, "--out", tmp_path)
    assert result.exit_code == 2
    assert "accuracy.pilots.1" in result.stderr
    assert list(tmp_path.iterdir()) == [scene_file]
