"""Errors as a person should meet them: a message on stderr and an exit code; tracebacks need --verbose."""

from __future__ import annotations

import functools
import sys
import traceback
from collections.abc import Callable
from enum import IntEnum
from typing import ParamSpec

import typer

P = ParamSpec("P")


class ExitCode(IntEnum):
    """What the shell learns."""

    OK = 0
    FAILED = 1
    BAD_INPUT = 2
    INTERRUPTED = 130


class BadInput(Exception):
    """A request that cannot be met; the text says what would be allowed."""


def reported(command: Callable[P, ExitCode | None]) -> Callable[P, None]:
    """A command that ends with its exit code and turns every exception into a message and an exit code."""

    @functools.wraps(command)
    def guarded(*args: P.args, **kwargs: P.kwargs) -> None:
        try:
            code = command(*args, **kwargs) or ExitCode.OK
        except (typer.Exit, BrokenPipeError):
            raise  # Typer ends quietly where nobody reads on, as in `warpsph schema | head`
        except (Exception, KeyboardInterrupt) as error:
            code = exit_code_of(error)
            report(error, verbose=bool(kwargs.get("verbose")))
        raise typer.Exit(code)

    return guarded


def exit_code_of(error: BaseException) -> ExitCode:
    """2 for what the user can put right in the input, 130 for Ctrl-C, 1 for everything else."""
    if isinstance(error, KeyboardInterrupt):
        return ExitCode.INTERRUPTED
    return ExitCode.BAD_INPUT if isinstance(error, _bad_input()) else ExitCode.FAILED


def report(error: BaseException, *, verbose: bool) -> None:
    """Say on stderr what went wrong and, from the error's notes, what was kept and how to go on."""
    if verbose:
        traceback.print_exception(error)
        return
    lines = [_headline(error), *getattr(error, "__notes__", ())]
    print("\n".join(lines), file=sys.stderr)


def _headline(error: BaseException) -> str:
    if isinstance(error, KeyboardInterrupt):
        return "interrupted"
    if isinstance(error, MemoryError):
        return "error: there is not enough memory"
    if isinstance(error, (*_bad_input(), *_failed_runs())):
        return f"error: {error}"
    advice = "this is a defect of warpsph; --verbose shows the traceback to report"
    return f"error: {type(error).__name__}: {error}\n{advice}"


def _bad_input() -> tuple[type[Exception], ...]:
    from warpsph.output.checkpoint import CheckpointError
    from warpsph.rendering.errors import RenderError
    from warpsph.scene.errors import SceneError

    return BadInput, SceneError, CheckpointError, RenderError


def _failed_runs() -> tuple[type[Exception], ...]:
    from warpsph.output.errors import OutputError
    from warpsph.solver.errors import SimulationDiverged
    from warpsph.validation.pilots import PlanError

    return OutputError, SimulationDiverged, PlanError
