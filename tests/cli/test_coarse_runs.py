"""`warpsph run --plan` and `--estimate-error`: coarse runs before a run, and what its summary then says."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from fake_runs import converging, raising, run_that
from typer.testing import Result

Command = Callable[..., Result]
ASKING = "accuracy={quantity: front, within: 1%}"


def summary_of(directory: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((directory / "summary.json").read_text())
    return found


def test_real_run_with_a_second_resolution_states_its_error(
    warpsph: Command, scene_file: Path, tmp_path: Path
) -> None:
    """The coarse run is kept; the error is the change from it, since the order 1 is assumed and the ratio is 2."""
    out = tmp_path / "run"
    call = ("run", scene_file, "--set", "spacing=0.125", "--out", out, "--estimate-error")
    assert warpsph(*call).exit_code == 0
    (front,) = summary_of(out)["discretisation_error"]
    (coarse,) = summary_of(out / "pilots" / "0.25")["references"]
    (fine,) = summary_of(out)["references"]
    assert front["spacings"] == [0.25, 0.125]
    assert (front["order"], front["order_is"]) == (1.0, "assumed")
    assert front["error"] == pytest.approx(abs(fine["value"] - coarse["value"]))
    again = warpsph(*call)
    assert "kept" in again.stdout
    assert "discretisation error, estimated" in again.stdout
    assert "1.00 assumed" in again.stdout


def test_a_planned_run_takes_the_spacing_and_says_so(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    """1.25 * 0.5 h^2 <= 0.5 % of 1.008 asks for h <= 0.0898: 0.5 / 6."""
    ending(converging(2.0))
    out = tmp_path / "0.08333333333"
    half = ASKING.replace("1%", "0.5%")
    result = warpsph("run", scene_file, "--set", half, "--plan", "--estimate-error", "--out", out)
    assert result.exit_code == 0
    assert "plan       spacing 0.08333 m for front within 0.5 %" in result.stdout
    assert "accuracy   met: estimated error 0.345 %, at most 0.431 %" in result.stdout
    written = summary_of(out)
    assert written["plan"]["proposal"]["spacing"] == pytest.approx(0.5 / 6)
    assert written["plan"]["outcome"]["met"] is True
    (front,) = written["discretisation_error"]
    assert front["spacings"] == pytest.approx([0.25 / 1.5, 0.125, 0.5 / 6])
    assert (front["order"], front["order_is"]) == (pytest.approx(2.0, abs=1e-6), "observed")
    assert front["error"] == pytest.approx(0.5 * (0.5 / 6) ** 2, rel=1e-5)


def test_a_run_that_misses_its_target_says_so(
    warpsph: Command, scene_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Pilots of order 2, and a run that is off by as much as they are: its error follows from all three."""

    def disappoint(directory: Path) -> dict[str, Any]:
        pilot = directory.parent.name == "pilots"
        return converging(2.0)(directory if pilot else directory.parent / "0.2")

    monkeypatch.setattr("warpsph.solver.run.run_scene", run_that(disappoint))
    out, half = tmp_path / "run", ASKING.replace("1%", "0.5%")
    result = warpsph("run", scene_file, "--set", half, "--plan", "--out", out)
    assert result.exit_code == 0
    assert "accuracy   not met: estimated error" in result.stdout
    assert "accuracy.pilots: [0.1667, 0.1111, 0.08333]" in " ".join(result.stdout.split())
    assert summary_of(out)["plan"]["outcome"]["met"] is False


def test_a_real_planned_run_has_the_proposed_spacing(
    warpsph: Command, scene_file: Path, tmp_path: Path
) -> None:
    figure = '{column: "front.position[m]", feature: maximum}'
    asking = f"accuracy={{quantity: {figure}, within: 90%}}"
    out = tmp_path / "run"
    result = warpsph("run", scene_file, "--set", asking, "--plan", "--out", out, "--quiet")
    assert (result.exit_code, result.output) == (0, "")
    written = summary_of(out)
    assert written["spacing_m"] == written["plan"]["proposal"]["spacing"]


def test_a_run_that_cannot_be_planned_is_not_made(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    ending(converging(-1.0))
    result = warpsph("run", scene_file, "--set", ASKING, "--plan", "--out", tmp_path / "run", "--quiet")
    assert result.exit_code == 1
    assert "the pilots allow no spacing: the figure changes more" in result.stderr
    assert not (tmp_path / "run" / "summary.json").exists()


def test_a_run_without_a_plan_says_what_its_scene_asks_for(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    ending(converging(2.0))
    result = warpsph("run", scene_file, "--set", ASKING, "--out", tmp_path / "0.25")
    assert "the scene asks for front within 1 %" in result.stdout
    assert "--plan" in result.stdout


def test_the_coarse_run_must_be_possible(warpsph: Command, scene_file: Path, tmp_path: Path) -> None:
    """The tank is 1 m wide."""
    result = warpsph("run", scene_file, "--set", "spacing=0.6", "--estimate-error", "--out", tmp_path / "run")
    assert result.exit_code == 2
    assert "the coarse run at 1.2 m" in result.stderr
    assert not (tmp_path / "run").exists()


def test_the_command_that_goes_on_repeats_the_plan(
    warpsph: Command, scene_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail_in_the_end(directory: Path) -> dict[str, Any]:
        if directory.parent.name == "pilots":
            return converging(2.0)(directory)
        return raising(KeyboardInterrupt())(directory)

    monkeypatch.setattr("warpsph.solver.run.run_scene", run_that(fail_in_the_end))
    out = tmp_path / "run"
    out.mkdir()
    (out / "checkpoint.h5").touch()
    result = warpsph("run", scene_file, "--set", ASKING, "--plan", "--out", out)
    assert result.exit_code == 130
    assert "--plan --resume" in result.stderr
