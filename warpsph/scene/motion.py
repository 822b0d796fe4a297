"""Prescribed motion of walls.

A wall moves by a list of motions, applied in the order of the list, each to the body as the motions before
it have left it; centres and axes are fixed in space. Every motion counts its displacement from time zero, so
that the wall stands where its shape says when the run begins.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Annotated, Literal, Self

from pydantic import Field, ValidationInfo, field_validator, model_validator

from warpsph.scene.errors import Problem
from warpsph.scene.shapes import axis_problems
from warpsph.scene.types import (
    Axis,
    FileName,
    NonNegativeReal,
    PositiveReal,
    Real,
    SceneModel,
    Vector,
    Vector3,
)


class MotionModel(SceneModel):
    """Base of all motions."""

    def dimension_problems(self, dimension: int) -> Iterator[Problem]:
        """What, beside the length of its vectors, cannot stand in this dimension; keys are relative."""
        yield from ()


class TurningMotion(MotionModel):
    """Base of the motions that can turn the body about a point fixed in space."""

    center: Vector | None = None
    """Fixed point of the rotation [m]. Default: null."""
    axis: Vector3 | None = None
    """Direction of the rotation axis, of any length; in three dimensions only. Default: null."""

    @field_validator("axis")
    @classmethod
    def _not_zero(cls, axis: Vector3 | None) -> Vector3 | None:
        if axis is not None and math.hypot(*axis) == 0.0:
            raise ValueError("the axis must not be zero")
        return axis

    def turns(self) -> bool:
        """Whether the motion rotates the body."""
        raise NotImplementedError

    @model_validator(mode="after")
    def _rotation_is_complete(self) -> Self:
        if self.turns() and self.center is None:
            raise ValueError("a rotation needs its center")
        if not self.turns() and (self.center is not None or self.axis is not None):
            raise ValueError("center and axis have no effect without a rotation")
        return self

    def dimension_problems(self, dimension: int) -> Iterator[Problem]:
        if self.turns():
            yield from axis_problems(self.axis, dimension)


class Sinusoid(TurningMotion):
    """Oscillation: amplitude ramp (sin(2 pi frequency (t - start) + phase) - sin(phase)) from `start` on."""

    type: Literal["sinusoid"] = "sinusoid"
    translation: Vector | None = None
    """Amplitude of the displacement [m]. Default: null."""
    rotation: Real | None = None
    """Amplitude of the rotation [degrees]; needs `center`, in three dimensions `axis`. Default: null."""
    frequency: PositiveReal
    """Frequency [Hz]."""
    phase: Real = 0.0
    """Phase at `start` [degrees]. Default: 0."""
    start: NonNegativeReal = 0.0
    """Time at which the motion begins [s]. Default: 0."""
    ramp: NonNegativeReal = 0.0
    """Time over which the amplitude grows smoothly from zero [s]. Default: 0."""

    def turns(self) -> bool:
        return self.rotation is not None

    @model_validator(mode="after")
    def _moves(self) -> Self:
        if self.translation is None and self.rotation is None:
            raise ValueError("a sinusoid needs a translation, a rotation, or both")
        return self


class Linear(MotionModel):
    """Translation at a constant velocity between `start` and `end`."""

    type: Literal["linear"] = "linear"
    velocity: Vector
    """Velocity [m/s]."""
    start: NonNegativeReal = 0.0
    """Time at which the motion begins [s]. Default: 0."""
    end: PositiveReal | None = None
    """Time at which the motion stops [s]; null: never. Default: null."""

    @field_validator("end")
    @classmethod
    def _after_start(cls, end: float | None, info: ValidationInfo) -> float | None:
        return _checked_end(end, info)


class Sliding(MotionModel):
    """The wall's surface slides in itself at a constant velocity, like a belt or an endless lid: its particles have
    this velocity and stay where they are. Between `start` and `end`."""

    type: Literal["sliding"] = "sliding"
    velocity: Vector
    """Velocity of the surface [m/s], along the wall."""
    start: NonNegativeReal = 0.0
    """Time at which the motion begins [s]. Default: 0."""
    end: PositiveReal | None = None
    """Time at which the motion stops [s]; null: never. Default: null."""

    @field_validator("end")
    @classmethod
    def _after_start(cls, end: float | None, info: ValidationInfo) -> float | None:
        return _checked_end(end, info)


class SteadyRotation(TurningMotion):
    """Rotation at a constant rate between `start` and `end`."""

    type: Literal["rotation"] = "rotation"
    rate: Real
    """Rate of rotation [degrees/s], counter-clockwise in two dimensions, right-handed about `axis`."""
    start: NonNegativeReal = 0.0
    """Time at which the motion begins [s]. Default: 0."""
    end: PositiveReal | None = None
    """Time at which the motion stops [s]; null: never. Default: null."""

    @field_validator("end")
    @classmethod
    def _after_start(cls, end: float | None, info: ValidationInfo) -> float | None:
        return _checked_end(end, info)

    def turns(self) -> bool:
        return True


class Table(TurningMotion):
    """Motion from the columns of a CSV file; before its first and after its last time the body rests."""

    type: Literal["table"] = "table"
    file: FileName
    """CSV file whose first row names the columns, relative to the directory of the scene file."""
    time: str
    """Column with the time [s]; strictly increasing."""
    translation: Annotated[Mapping[Axis, str], Field(min_length=1)] | None = None
    """Columns with the displacement along the axes [m]. Default: null."""
    rotation: str | None = None
    """Column with the angle [degrees]; needs `center`, in three dimensions `axis`. Default: null."""
    interpolation: Literal["cubic", "linear"] = "cubic"
    """Between the rows: cubic spline (smooth velocity) or straight lines. Default: cubic."""

    def turns(self) -> bool:
        return self.rotation is not None

    @model_validator(mode="after")
    def _moves(self) -> Self:
        if self.translation is None and self.rotation is None:
            raise ValueError("a table needs columns for a translation, for a rotation, or for both")
        return self

    def dimension_problems(self, dimension: int) -> Iterator[Problem]:
        yield from super().dimension_problems(dimension)
        if dimension == 2 and "z" in (self.translation or {}):
            yield Problem.at("translation.z", "there is no z in two dimensions", "x, y")


Motion = Annotated[Sinusoid | Linear | Sliding | SteadyRotation | Table, Field(discriminator="type")]
"""A prescribed motion, chosen by `type`."""


def _checked_end(end: float | None, info: ValidationInfo) -> float | None:
    start = info.data.get("start")
    if end is not None and start is not None and end <= start:
        raise ValueError(f"end must be greater than start = {start:g}")
    return end
