"""Errors become one message on stderr and an exit code."""

from __future__ import annotations

from pathlib import Path

import pytest
import typer
from fake_runs import diverged

from warpsph.cli.failures import BadInput, ExitCode, reported
from warpsph.output.checkpoint import CheckpointError
from warpsph.output.errors import OutputError
from warpsph.rendering.errors import RenderError
from warpsph.scene import Problem, SceneError


def code_after(error: BaseException | None, *, verbose: bool = False) -> int:
    @reported
    def command(verbose: bool) -> None:
        if error is not None:
            raise error

    with pytest.raises(typer.Exit) as ended:
        command(verbose=verbose)
    return ended.value.exit_code


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (None, ExitCode.OK),
        (SceneError([Problem.at("spacing", "it is negative", "more than 0")]), ExitCode.BAD_INPUT),
        (BadInput("--size big"), ExitCode.BAD_INPUT),
        (RenderError("there is no field 'wetness'"), ExitCode.BAD_INPUT),
        (CheckpointError(Path("checkpoint.h5"), "it is damaged"), ExitCode.BAD_INPUT),
        (OutputError(Path("out"), "No space left on device"), ExitCode.FAILED),
        (diverged(), ExitCode.FAILED),
        (MemoryError(), ExitCode.FAILED),
        (KeyError("a defect"), ExitCode.FAILED),
        (KeyboardInterrupt(), ExitCode.INTERRUPTED),
    ],
)
def test_exit_code_says_whose_fault_it_is(error: BaseException | None, code: ExitCode) -> None:
    assert code_after(error) == code


def test_message_and_notes_go_to_stderr_without_traceback(capsys: pytest.CaptureFixture[str]) -> None:
    error = diverged()
    error.add_note("frames are kept in out/tank")
    code_after(error)
    written = capsys.readouterr()
    assert written.out == ""
    assert "particle 7 of water" in written.err
    assert written.err.endswith("frames are kept in out/tank\n")
    assert "Traceback" not in written.err


def test_defect_asks_for_a_report(capsys: pytest.CaptureFixture[str]) -> None:
    code_after(KeyError("field"))
    assert "defect of warpsph; --verbose" in capsys.readouterr().err


def test_verbose_shows_the_traceback(capsys: pytest.CaptureFixture[str]) -> None:
    code_after(KeyError("field"), verbose=True)
    assert "Traceback" in capsys.readouterr().err
