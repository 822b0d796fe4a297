"""`warpsph validate --hard`: rows, table, page and exit codes."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

from warpsph.validation.hard import suite
from warpsph.validation.hard.case import Figure, HardCase, Machine

Command = Callable[..., Result]


def kept(machine: Machine) -> list[Figure]:
    """A case that holds <well>."""
    return [Figure("distance", 0.25, 0.5, "dp"), Figure("warnings", 1.0, 1.0, at_least=True)]


def broken(machine: Machine) -> list[Figure]:
    """A case that does not."""
    return [Figure("leaks", 2.0, 0.0)]


def never(machine: Machine) -> list[Figure]:
    """A case that must not be run."""
    raise AssertionError("a case was run")


@pytest.fixture(autouse=True)
def two_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(suite, "HARD_CASES", (HardCase(kept), HardCase(broken)))


def test_one_strict_json_object_a_figure(warpsph: Command, tmp_path: Path) -> None:
    result = warpsph("validate", "--hard", "--json", "--threads", 1, "--out", tmp_path)
    assert result.exit_code == 1
    rows = [json.loads(line) for line in result.stdout.splitlines()]
    assert [(row["case"], row["figure"], row["holds"]) for row in rows] == [
        ("kept", "distance", True),
        ("kept", "warnings", True),
        ("broken", "leaks", False),
    ]
    assert all(row["threads"] == 1 and row["seconds"] >= 0.0 for row in rows)
    assert json.loads((tmp_path / "hard.json").read_text())["figures"] == rows
    assert not (tmp_path / "hard.html").exists()


def test_a_table_with_figures_bounds_and_verdicts(warpsph: Command, tmp_path: Path) -> None:
    result = warpsph("validate", "kept", "--hard", "--out", tmp_path)
    assert result.exit_code == 0
    assert "0.25 dp" in result.stdout
    assert "at most 0.5 dp" in result.stdout
    assert "at least 1" in result.stdout
    assert "leaks" not in result.stdout


def test_a_page_that_says_what_holds(warpsph: Command, tmp_path: Path) -> None:
    warpsph("validate", "--hard", "--report", "--out", tmp_path)
    page = (tmp_path / "hard.html").read_text()
    assert "1 of 2 cases keep their bounds." in page
    assert "A case that holds &lt;well&gt;." in page


def test_a_directory_that_cannot_be_made_is_bad_input_before_the_first_case(
    warpsph: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(suite, "HARD_CASES", (HardCase(never),))
    (tmp_path / "file").write_text("kept")
    result = warpsph("validate", "--hard", "--out", tmp_path / "file" / "results")
    assert result.exit_code == 2
    assert "file/results: cannot write: Not a directory" in result.stderr
    assert "defect" not in result.stderr


def test_a_name_that_there_is_not(warpsph: Command, tmp_path: Path) -> None:
    result = warpsph("validate", "dam_break_2d", "--hard", "--out", tmp_path)
    assert result.exit_code == 2
    assert "--hard dam_break_2d: no such hard case; there are broken, kept" in result.stderr


@pytest.mark.parametrize(
    "option",
    [
        ("--quick",),
        ("--resolutions", "0.1"),
        ("--compare", "time.cfl=0.2,0.3"),
        ("--set", "spacing=1"),
        ("--resume",),
        ("--jobs", "2"),
    ],
)
def test_options_of_scenes_are_refused(warpsph: Command, tmp_path: Path, option: tuple[str, ...]) -> None:
    result = warpsph("validate", "--hard", *option, "--out", tmp_path)
    assert result.exit_code == 2
    assert f"{option[0]} is of no use with --hard" in result.stderr
