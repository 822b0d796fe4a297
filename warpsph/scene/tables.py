"""Columns of numbers from CSV files."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

import numpy as np


class TableError(ValueError):
    """A CSV file that does not hold the numbers asked of it; the text says file, line and reason."""


def read_columns(path: Path, columns: Sequence[str]) -> tuple[np.ndarray, ...]:
    """Columns (n,) in float64 of a CSV file, by the names in its header.

    The header is the first line that is neither empty nor begins with #. Raises TableError where the file
    cannot be read, a column is missing, or a value is not a finite number.
    """
    lines = _lines(path)
    if len(lines) < 2:
        raise TableError(f"{path}: it holds no header with rows below it")
    header = [name.strip() for name in lines[0][1]]
    for column in columns:
        if column not in header:
            raise TableError(f"{path}: there is no column {column!r}, only {', '.join(header)}")
    places = [header.index(column) for column in columns]
    rows = [[_number(path, number, cells, place) for place in places] for number, cells in lines[1:]]
    return tuple(np.array(rows, dtype=np.float64).T)


def _lines(path: Path) -> list[tuple[int, list[str]]]:
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise TableError(f"{path}: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise TableError(f"{path}: this is not text in UTF-8") from error
    kept = [
        (number, line)
        for number, line in enumerate(text.splitlines(), start=1)
        if line.strip() and not line.startswith("#")
    ]
    try:
        return [(number, next(csv.reader([line]))) for number, line in kept]
    except csv.Error as error:
        raise TableError(f"{path}: {error}") from error


def _number(path: Path, line: int, cells: Sequence[str], place: int) -> float:
    try:
        value = float(cells[place])
    except (IndexError, ValueError):
        found = repr(cells[place]) if place < len(cells) else "nothing"
        raise TableError(f"{path}, line {line}: {found} is not a number") from None
    if not np.isfinite(value):
        raise TableError(f"{path}, line {line}: {value} is not finite")
    return value
