"""probes.csv: one row a sample, the time first, columns named `probe.quantity[unit]`."""

import contextlib
import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import TextIO

from warpsph.output.atomic import write_atomically
from warpsph.output.errors import OutputError, reason_of
from warpsph.output.writer import Writer

TIME_COLUMN = "time[s]"


class ProbesCsv(Writer):
    """Writer of probe samples; every row is on disk as soon as it is written."""

    def __init__(self, path: Path, columns: Sequence[str]) -> None:
        """`columns` are those of all probes in order, without the time."""
        self._path = path
        self._header = [TIME_COLUMN, *columns]
        self._file: TextIO | None = None

    def open(self, resume_time: float | None = None) -> None:
        """Start anew, or continue an existing file after `resume_time` [s], dropping what lies later.

        Raises OutputError if the file cannot be written, or has other columns than this run.
        """
        rows = [] if resume_time is None or not self._path.exists() else self._rows_until(resume_time)
        write_atomically(self._path, _csv_text([self._header, *rows]).encode())
        try:
            self._file = self._path.open("a", encoding="utf-8", newline="")
        except OSError as error:
            raise OutputError(self._path, f"cannot write: {reason_of(error)}") from error

    def write(self, time: float, values: Sequence[float]) -> None:
        """Add the sample of one time [s]; `values` in the order of the columns. Raises OutputError."""
        if self._file is None:
            raise ValueError("open() comes before write()")
        if len(values) != len(self._header) - 1:
            raise ValueError(f"{len(values)} values for {len(self._header) - 1} columns")
        try:
            self._file.write(_csv_text([[repr(float(number)) for number in (time, *values)]]))
            self._file.flush()
        except OSError as error:
            raise OutputError(self._path, f"cannot write: {reason_of(error)}") from error

    def close(self) -> None:
        """Close the file; a row that `write` could not write is dropped."""
        if self._file is not None:
            with contextlib.suppress(OSError):
                self._file.close()
            self._file = None

    def _rows_until(self, time: float) -> list[list[str]]:
        """Complete rows up to and including a time; a row cut short by a crash has no line end."""
        text = self._path.read_text(encoding="utf-8")
        header, *rows = list(csv.reader(text[: text.rfind("\n") + 1].splitlines())) or [[]]
        if header != self._header:
            reason = f"cannot continue: its columns are {header}, those of this run {self._header}"
            raise OutputError(self._path, reason)
        return [row for row in rows if float(row[0]) <= time]


def read_probes(path: Path) -> dict[str, list[float]]:
    """Columns of a probes.csv by name, the time among them."""
    with path.open(encoding="utf-8", newline="") as file:
        header, *rows = list(csv.reader(file))
    return {name: [float(row[i]) for row in rows] for i, name in enumerate(header)}


def _csv_text(rows: Sequence[Sequence[str]]) -> str:
    buffer = io.StringIO()
    csv.writer(buffer, lineterminator="\n").writerows(rows)
    return buffer.getvalue()
