"""Where results are kept, what remains of a run that was cut short, and how to go on with it."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

from warpsph.cli.failures import BadInput
from warpsph.cli.progress import Reporter


def require_directory(path: Path) -> None:
    """Make the directory of results before anything runs; raises BadInput where that is impossible."""
    from warpsph.output.errors import OutputError
    from warpsph.output.run_directory import make_directory

    try:
        make_directory(path)
    except OutputError as error:
        raise BadInput(str(error)) from error


@contextlib.contextmanager
def stating_what_is_kept(directory: Path, resume_command: str, reporter: Reporter) -> Iterator[None]:
    """Add to every error of a run what is left of it.

    A directory that refuses the first file is bad input.
    """
    from warpsph.output.errors import OutputError

    try:
        yield
    except OutputError as error:
        if reporter.time is None:
            raise BadInput(str(error)) from error
        error.add_note(what_is_kept(directory, resume_command, reporter.time))
        raise
    except (Exception, KeyboardInterrupt) as error:
        if reporter.time is not None:
            error.add_note(what_is_kept(directory, resume_command, reporter.time))
        raise


def what_is_kept(directory: Path, resume_command: str, time: float) -> str:
    """The files that are whole, and the command that continues from the last checkpoint."""
    from warpsph.output.run_directory import RunDirectory

    files = RunDirectory(directory)
    results = [path.name for path in (files.usd, files.hdf5, files.probes) if path.exists()]
    kept = f"the run had reached t = {time:.6g} s"
    if results:
        kept += f"; what it wrote until then is kept in {directory}: {', '.join(results)}"
    if files.checkpoint.exists():
        return f"{kept}\nto go on from the last checkpoint: {resume_command}"
    return f"{kept}\nno checkpoint had been written, so a new run starts from the beginning"
