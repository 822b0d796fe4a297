"""Figures of the plane with an outline of straight edges: shapes in two dimensions, sections of extrusions."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import BeforeValidator, Field, PrivateAttr, ValidationInfo, field_validator, model_validator

from warpsph.geometry.errors import GeometryError
from warpsph.geometry.naca import naca_outline
from warpsph.geometry.polygons import refuse_crossing
from warpsph.scene.errors import Problem
from warpsph.scene.file_shapes import FileShape, Stamp, directory_of, stamp_of
from warpsph.scene.outline_files import read_outline
from warpsph.scene.shape_model import ShapeModel
from warpsph.scene.types import FileName, Flag, PositiveReal, Real, Vector2
from warpsph.scene.units import LengthUnit, in_metres

Corners = Annotated[tuple[Vector2, ...], Field(min_length=3)]
"""Corners of a polygon in order; the last is joined to the first."""

_QUARTER_CHORD = np.array([0.25, 0.0])


def checked_corners(points: tuple[Vector2, ...] | None) -> tuple[Vector2, ...] | None:
    """The corners of a polygon, after a check that its edges do not meet."""
    if points is not None:
        refuse_crossing(points)
    return points


class Polygon(FileShape):
    """The inside of a closed polygon, given by `points` or by a `file` of them; two dimensions only."""

    type: Literal["polygon"] = "polygon"
    points: Corners | None = None
    """Corners in order [m]; the last is joined to the first; edges must not cross or touch. Default: null."""
    unit: LengthUnit = "m"
    """Length of one unit of the file: km, m, dm, cm, mm, um, ft, in, or a number [m], such as the chord where the file
    holds a section of chord 1. Only with `file`. Default: m."""
    file: FileName | None = None
    """File of the corners: .csv with the columns x and y, or .dat with an airfoil in the order of Selig or Lednicer.
    Default: null."""

    _outline: np.ndarray = PrivateAttr()

    @field_validator("points")
    @classmethod
    def _simple(cls, points: tuple[Vector2, ...] | None) -> tuple[Vector2, ...] | None:
        return checked_corners(points)

    @field_validator("file")
    @classmethod
    def _readable(cls, file: str | None, info: ValidationInfo) -> str | None:
        if file is not None and "unit" in info.data:
            _outline_of(directory_of(info.context) / file, info.data["unit"])
        return file

    @model_validator(mode="after")
    def _one_source(self) -> Self:
        if (self.points is None) == (self.file is None):
            raise ValueError("a polygon needs its points, or a file of them, and not both")
        if self.file is None and self.unit != "m":
            raise ValueError("unit is that of a file; points are in metres")
        return self

    def model_post_init(self, context: Any, /) -> None:
        super().model_post_init(context)
        from_file = self.points is None and self.file is not None
        self._outline = (
            _outline_of(self._directory / str(self.file), self.unit)
            if from_file
            else np.array(self.points or ())
        )

    @property
    def outline(self) -> np.ndarray:
        """Corners (n, 2) [m] in order."""
        return self._outline

    def dimension_problems(self, dimension: int) -> Iterator[Problem]:
        return self._exists_only_in(2, dimension, "an extrusion")


def _four_digits(value: object) -> object:
    """YAML reads 0012 as a number."""
    return f"{value:04d}" if type(value) is int and 0 <= value <= 9999 else value


class Naca(ShapeModel):
    """A NACA section of four digits (Jacobs, Ward & Pinkerton 1933), nose towards -x; two dimensions only."""

    type: Literal["naca"] = "naca"
    digits: Annotated[
        str, Field(pattern=r"^[0-9]{4}$"), BeforeValidator(_four_digits, json_schema_input_type=str | int)
    ]
    """The section, such as 0012: camber in hundredths of the chord, its place in tenths, thickness in hundredths."""
    chord: PositiveReal
    """Chord [m]."""
    position: Vector2 = (0.0, 0.0)
    """Where the quarter-chord point stands [m]. Default: [0, 0]."""
    angle_of_attack: Real = 0.0
    """Angle [degrees] by which the nose is turned up about the quarter-chord point. Default: 0."""
    closed_trailing_edge: Flag = True
    """Whether the surfaces meet in the trailing edge; false: as in the report, 2.1 % of the thickness apart.
    Default: true."""

    @field_validator("digits")
    @classmethod
    def _is_a_section(cls, digits: str) -> str:
        if digits[2:] == "00":
            raise ValueError("the last two digits are the thickness, which is not zero")
        if digits[0] != "0" and digits[1] == "0":
            raise ValueError("a section with camber, which is the first digit, needs its place, the second")
        return digits

    @property
    def outline(self) -> np.ndarray:
        """Corners (n, 2) [m] in order."""
        nose_up = -np.deg2rad(self.angle_of_attack)
        turn = np.array([[np.cos(nose_up), -np.sin(nose_up)], [np.sin(nose_up), np.cos(nose_up)]])
        corners = naca_outline(self.digits, self.closed_trailing_edge) - _QUARTER_CHORD
        return np.asarray(self.chord * corners @ turn.T + self.position)

    def dimension_problems(self, dimension: int) -> Iterator[Problem]:
        return self._exists_only_in(2, dimension, "the section of an extrusion")


Section = Annotated[Polygon | Naca, Field(discriminator="type")]
"""A figure of the plane, chosen by `type`."""


def _outline_of(path: Path, unit: LengthUnit) -> np.ndarray:
    """Corners (n, 2) [m] of a file. Raises GeometryError."""
    return _read(path, stamp_of(path)) * in_metres(unit)


@lru_cache(maxsize=16)
def _read(path: Path, stamp: Stamp | None) -> np.ndarray:
    """Corners (n, 2) of a file that has not changed, after a check that edges do not meet."""
    corners = read_outline(path)
    if len(corners) < 3:
        raise GeometryError(
            f"{path}: it holds {len(corners)} different points, and a polygon has three or more"
        )
    try:
        refuse_crossing([(float(x), float(y)) for x, y in corners])
    except GeometryError as error:
        raise GeometryError(f"{path}: {error}, counted from 0 and without repeated points") from error
    return corners
