"""Corners of figures of the plane from files: CSV, and airfoils in the orders of Selig and Lednicer."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from warpsph.geometry.errors import GeometryError
from warpsph.scene.tables import TableError, read_columns


def read_outline(path: Path) -> np.ndarray:
    """Corners (n, 2) in order, without those that repeat the one before or the first one at the end.

    Raises GeometryError where the file cannot be read.
    """
    match path.suffix.lower():
        case ".csv":
            corners = _columns(path)
        case ".dat":
            corners = _airfoil(path)
        case suffix:
            raise GeometryError(f"{path}: a file of points ends in .csv or .dat, not in {suffix!r}")
    repeats = (corners == np.roll(corners, 1, axis=0)).all(axis=1)
    return corners[~repeats]


def _columns(path: Path) -> np.ndarray:
    try:
        return np.stack(read_columns(path, ["x", "y"]), axis=1)
    except TableError as error:
        raise GeometryError(str(error)) from error


def _airfoil(path: Path) -> np.ndarray:
    """Corners of an airfoil, all the way round.

    Selig: a title, then the points from the trailing edge over the upper surface to the nose and back below. Lednicer:
    below the title the numbers of points of the two surfaces, then the upper and the lower one, each from
    the nose backwards.
    """
    rows = _pairs(path)
    first, second = rows[0] if len(rows) else (0.0, 0.0)
    if not (first >= 2.0 and second >= 2.0 and first.is_integer() and second.is_integer()):
        return rows
    count, points = int(first), rows[1:]
    if count + int(second) != len(points):
        raise GeometryError(f"{path}: it announces {count} and {second:.0f} points and holds {len(points)}")
    return np.concatenate([points[:count][::-1], points[count:]])


def _pairs(path: Path) -> np.ndarray:
    """The pairs of numbers (n, 2) of a text; its first line may be a title, empty lines are skipped."""
    try:
        lines = path.read_text(encoding="utf-8-sig", errors="replace").splitlines()
    except OSError as error:
        raise GeometryError(f"{path}: {error.strerror or error}") from error
    rows = []
    for number, line in enumerate(lines, start=1):
        pair = _pair(line)
        if pair is not None:
            rows.append(pair)
        elif line.strip() and number > 1:
            raise GeometryError(f"{path}, line {number}: {line.strip()[:40]!r} is no pair of finite numbers")
    return np.array(rows).reshape(-1, 2)


def _pair(line: str) -> tuple[float, float] | None:
    words = line.replace(",", " ").split()
    try:
        x, y = map(float, words)
    except ValueError:
        return None
    return (x, y) if np.isfinite([x, y]).all() else None
