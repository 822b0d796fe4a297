"""`warpsph validate`: rows, verdicts and exit codes."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import fake_runs
import pytest
from fake_runs import raising, run_that
from typer.testing import Result

Command = Callable[..., Result]


@pytest.fixture
def ending(monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[[Path], dict[str, Any]]], None]:
    """Let every run end in a given way instead of running."""

    def replace(end: Callable[[Path], dict[str, Any]]) -> None:
        monkeypatch.setattr("warpsph.solver.run.run_scene", run_that(end))

    return replace


def test_real_validation_prints_one_strict_json_object_a_row(
    warpsph: Command, scene_file: Path, tmp_path: Path
) -> None:
    result = warpsph("validate", scene_file, "--resolutions", "0.25,0.5", "--json", "--out", tmp_path / "out")
    assert result.exit_code == 0
    rows = [json.loads(line) for line in result.stdout.splitlines()]
    assert [(row["scene"], row["resolution"], row["quantity"]) for row in rows] == [
        ("tank", 0.5, "front"),
        ("tank", 0.25, "front"),
    ]
    assert all(row["holds"] is True and row["particles"] > 0 and row["wall_seconds"] > 0 for row in rows)


def test_runs_side_by_side_give_the_same_rows_in_the_same_order(
    warpsph: Command, scene_file: Path, tmp_path: Path
) -> None:
    request = ("validate", scene_file, "--resolutions", "0.25,0.5", "--json", "--threads", 1)
    alone = warpsph(*request, "--out", tmp_path / "alone")
    result = warpsph(*request, "--jobs", 2, "--out", tmp_path / "pairs")
    assert result.exit_code == alone.exit_code == 0
    assert "1/2 tank at spacing 0.5 m took" in result.stderr
    own = {"wall_seconds", "particle_steps_per_second"}
    rows, expected = (
        [
            {key: value for key, value in json.loads(line).items() if key not in own}
            for line in one.stdout.splitlines()
        ]
        for one in (result, alone)
    )
    assert rows == expected
    assert len(rows) == 2


def test_a_directory_that_cannot_be_made_is_bad_input_before_the_first_run(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    ending(raising(AssertionError("a scene was run")))
    (tmp_path / "file").write_text("kept")
    result = warpsph("validate", scene_file, "--out", tmp_path / "file")
    assert result.exit_code == 2
    assert "this is a file; allowed: a directory" in result.stderr


def test_broken_bound_fails(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    broken = {**fake_runs.REFERENCE_ROW, "error": 0.5, "holds": False}
    ending(lambda out: fake_runs.summary(broken))
    result = warpsph("validate", scene_file, "--out", tmp_path)
    assert result.exit_code == 1
    assert "NO" in result.stdout


def test_row_without_bound_fails_nothing(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    ending(lambda out: fake_runs.summary({**fake_runs.REFERENCE_ROW, "bound": None, "holds": None}))
    assert warpsph("validate", scene_file, "--out", tmp_path).exit_code == 0


def test_table_states_the_observed_order(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    errors = iter([0.08, 0.02])
    ending(lambda out: fake_runs.summary({**fake_runs.REFERENCE_ROW, "error": next(errors)}))
    result = warpsph("validate", scene_file, "--resolutions", "0.5,0.25", "--out", tmp_path)
    assert "tank, front: observed order 2.00" in result.stdout


def test_no_error_is_quoted_below_the_uncertainty_of_the_reference(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    ending(lambda out: fake_runs.summary({**fake_runs.REFERENCE_ROW, "uncertainty": 0.03}))
    result = warpsph("validate", scene_file, "--out", tmp_path)
    assert "<= 3 %" in result.stdout


def test_compared_values_run_at_every_resolution(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    ending(lambda out: fake_runs.summary())
    request = ("--resolutions", "0.5,0.25", "--compare", "numerics.kernel=wendland_c2,cubic_spline")
    result = warpsph("validate", scene_file, *request, "--json", "--out", tmp_path)
    rows = [json.loads(line) for line in result.stdout.splitlines()]
    assert [(row["options"]["numerics.kernel"], row["resolution"]) for row in rows] == [
        ("wendland_c2", 0.5),
        ("wendland_c2", 0.25),
        ("cubic_spline", 0.5),
        ("cubic_spline", 0.25),
    ]
    table = warpsph("validate", scene_file, *request, "--out", tmp_path).stdout
    assert "kernel=cubic_spline" in table
    assert "tank: numerics.kernel makes no difference" in table


@pytest.mark.parametrize(
    ("option", "told"),
    [
        ("numerics.kernel=wendland_c2,cone", "--compare numerics.kernel=cone"),
        ("numerics.colour=1,2", "--compare numerics.colour=1"),
        ("numerics.kernel=cubic_spline", "at least two different values"),
    ],
)
def test_bad_options_are_found_before_the_first_run(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None], option: str, told: str
) -> None:
    ending(raising(AssertionError("nothing may run")))
    result = warpsph("validate", scene_file, "--compare", option, "--out", tmp_path)
    assert result.exit_code == 2
    assert told in result.stderr


def test_diverged_run_fails_and_the_others_still_run(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    ends = iter([raising(fake_runs.diverged()), lambda out: fake_runs.summary()])
    ending(lambda out: next(ends)(out))
    result = warpsph("validate", scene_file, "--resolutions", "0.5,0.25", "--json", "--out", tmp_path)
    assert result.exit_code == 1
    assert [json.loads(line)["holds"] for line in result.stdout.splitlines()] == [False, True]


def test_resume_runs_only_what_is_not_there(warpsph: Command, scene_file: Path, tmp_path: Path) -> None:
    request = ("validate", scene_file, "--json", "--out", tmp_path / "out")
    first = warpsph(*request, "--resolutions", "0.5")
    second = warpsph(*request, "--resolutions", "0.5,0.25", "--resume")
    assert second.stdout.splitlines()[0] == first.stdout.strip()
    assert len(second.stdout.splitlines()) == 2
    assert second.stderr.count("kept") == 1
    changed = warpsph(*request, "--resolutions", "0.5", "--resume", "--set", "time.cfl=0.1")
    assert "kept" not in changed.stderr


@pytest.mark.parametrize("state", ["interrupted", None])
def test_resume_keeps_no_run_that_is_not_complete(
    warpsph: Command, scene_file: Path, tmp_path: Path, state: str | None
) -> None:
    request = ("validate", scene_file, "--resolutions", "0.5", "--out", tmp_path / "out")
    warpsph(*request)
    summary = tmp_path / "out/tank/0.5/summary.json"
    summary.write_text(json.dumps({"status": state}) if state else "{")
    assert "kept" not in warpsph(*request, "--resume").stderr


@pytest.mark.parametrize("spacings", ["coarse", "0.1,-1", "0.1,nan", ""])
def test_wrong_resolutions_are_bad_input(warpsph: Command, scene_file: Path, spacings: str) -> None:
    result = warpsph("validate", scene_file, "--resolutions", spacings)
    assert result.exit_code == 2
    assert "as in 0.02,0.01" in result.stderr


def test_every_scene_is_loaded_before_the_first_run(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    ending(raising(AssertionError("nothing may run")))
    assert warpsph("validate", scene_file, "missing.yaml", "--out", tmp_path).exit_code == 2
