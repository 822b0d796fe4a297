"""`warpsph run`: what it prints, what it leaves, and how it ends."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import fake_runs
import pytest
from fake_runs import raising, run_that
from typer.testing import Result

from warpsph.output.errors import OutputError

Command = Callable[..., Result]


@pytest.fixture
def ending(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """Let the run end in a given way instead of running."""

    def replace(end: Callable[[Path], dict[str, Any]], **options: Any) -> None:
        monkeypatch.setattr("warpsph.solver.run.run_scene", run_that(end, **options))

    return replace


def test_real_run_leaves_its_files_and_shows_the_comparison(
    warpsph: Command, scene_file: Path, tmp_path: Path
) -> None:
    out = tmp_path / "run"
    result = warpsph("run", scene_file, "--out", out, "--threads", 1)
    assert result.exit_code == 0
    names = {path.name for path in out.iterdir()}
    assert {"scene.yaml", "summary.json", "probes.csv", "particles.usdc", "checkpoint.h5"} <= names
    assert str(out) in result.stdout
    assert "particle-steps/s" in result.stdout
    assert "yes" in result.stdout


def test_quiet_run_prints_nothing(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    ending(lambda out: fake_runs.summary())
    result = warpsph("run", scene_file, "--out", tmp_path / "run", "--quiet")
    assert (result.exit_code, result.output) == (0, "")


def test_summary_states_cost_steps_warnings_and_errors(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    ending(lambda out: fake_runs.summary())
    shown = warpsph("run", scene_file, "--out", tmp_path / "run").stdout
    for part in (
        "0:01:15 on cpu, 2 threads",
        "2.5 M particle-steps/s",
        "acoustic 97%",
        "[of a test]",
        "1 %",
        "25 %",
    ):
        assert part in shown


def test_diverged_run_fails_and_says_what_is_kept(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    ending(raising(fake_runs.diverged()))
    result = warpsph("run", scene_file, "--out", tmp_path / "run")
    assert result.exit_code == 1
    assert "particle 7 of water" in result.stderr
    assert f"kept in {tmp_path / 'run'}: probes.csv" in result.stderr
    assert "no checkpoint had been written" in result.stderr


def test_interrupted_run_names_the_command_that_goes_on(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    def interrupt(out: Path) -> dict[str, Any]:
        (out / "checkpoint.h5").touch()
        raise KeyboardInterrupt

    ending(interrupt)
    out = tmp_path / "a run"
    result = warpsph("run", scene_file, "--out", out, "--set", "spacing=0.5", "--threads", 1)
    assert result.exit_code == 130
    assert "reached t = 0.012 s" in result.stderr
    again = f"warpsph run {scene_file} --out '{out}' --set spacing=0.5 --threads 1 --resume"
    assert again in result.stderr


def test_directory_that_cannot_be_written_is_bad_input_but_a_full_disk_a_failed_run(
    warpsph: Command, scene_file: Path, tmp_path: Path, ending: Callable[..., None]
) -> None:
    error = OutputError(tmp_path, "cannot write: No space left on device")
    ending(raising(error), steps=False)
    assert warpsph("run", scene_file, "--out", tmp_path / "run").exit_code == 2
    ending(raising(error))
    assert warpsph("run", scene_file, "--out", tmp_path / "run").exit_code == 1


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--set", "spacing=-1"], "allowed: a number greater than 0"),
        (["--set", "spacing"], "key=value or key.sub=value"),
        (["--device", "cuda:77"], "there is no such device; there are"),
        (["--resume"], "checkpoint"),
    ],
)
def test_bad_request_is_explained(
    warpsph: Command, scene_file: Path, tmp_path: Path, arguments: list[str], said: str
) -> None:
    result = warpsph("run", scene_file, "--out", tmp_path / "run", *arguments)
    assert result.exit_code == 2
    assert said in result.stderr


def test_scene_goes_to_its_own_directory_by_default(
    warpsph: Command,
    scene_file: Path,
    tmp_path: Path,
    ending: Callable[..., None],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    ending(lambda out: fake_runs.summary())
    assert warpsph("run", scene_file).exit_code == 0
    assert (tmp_path / "out" / "tank" / "probes.csv").exists()
    assert warpsph("run", scene_file, "--set", "output.directory=elsewhere").exit_code == 0
    assert (tmp_path / "elsewhere" / "probes.csv").exists()


def test_rendering_without_its_extra_is_refused_before_the_run(
    warpsph: Command, scene_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("warpsph.rendering.extra.find_spec", lambda module: None)
    result = warpsph("run", scene_file, "--out", tmp_path / "run", "--render")
    assert result.exit_code == 2
    assert 'pip install "warpsph[render]"' in result.stderr
    assert not (tmp_path / "run").exists()
