"""Open boundaries: planar patches through which fluid enters and leaves."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

from pydantic import Field, field_validator, model_validator

from warpsph.scene.expressions import Expression, VectorField
from warpsph.scene.types import (
    Components,
    FileName,
    Flag,
    Name,
    NonNegativeReal,
    PositiveReal,
    Real,
    SceneModel,
    Vector,
)


class PatchShape(SceneModel):
    """A planar patch: a segment in two dimensions, a rectangle or a disc in three."""

    center: Vector
    """Its middle [m]."""
    normal: Vector
    """Direction into the domain; its length does not matter."""
    width: PositiveReal | None = None
    """Length of a segment [m]; in two dimensions. Default: null."""
    size: tuple[PositiveReal, PositiveReal] | None = None
    """Lengths of the sides of a rectangle [m]; in three dimensions. Default: null."""
    along: Vector | None = None
    """Direction of the first side of a rectangle, across the normal; null: the part across the normal of the first
    coordinate axis that is not along it. Default: null."""
    radius: PositiveReal | None = None
    """Radius of a disc [m]; in three dimensions. Default: null."""

    @field_validator("normal", "along")
    @classmethod
    def _not_zero(cls, direction: Components | None) -> Components | None:
        if direction is not None and math.hypot(*direction) == 0.0:
            raise ValueError("a direction must not be zero")
        return direction

    @model_validator(mode="after")
    def _one_extent(self) -> Self:
        given = [key for key in ("width", "size", "radius") if getattr(self, key) is not None]
        if len(given) != 1:
            raise ValueError("a patch needs one of width (a segment), size (a rectangle) and radius (a disc)")
        if self.along is not None and self.size is None:
            raise ValueError("along has no effect without the size of a rectangle")
        return self


class UniformVelocity(SceneModel):
    """The same normal velocity everywhere."""

    type: Literal["uniform"] = "uniform"
    speed: Real
    """Velocity along the normal [m/s]; negative: out of the domain."""


class ParabolicVelocity(SceneModel):
    """A parabola that is zero at the edges: of a segment and a disc that of developed laminar flow, of a rectangle
    the product of two. It is scaled so that the particles bring in the flow rate that is asked for."""

    type: Literal["parabolic"] = "parabolic"
    mean: Real | None = None
    """Mean velocity along the normal [m/s]. Default: null."""
    flow_rate: Real | None = None
    """Volume that enters a second [m3/s; m2/s in 2D]. Default: null."""

    @model_validator(mode="after")
    def _one_strength(self) -> Self:
        if (self.mean is None) == (self.flow_rate is None):
            raise ValueError("a parabola needs its mean, or its flow_rate, and not both")
        return self


class ExpressionVelocity(SceneModel):
    """A velocity as formulas."""

    type: Literal["expression"] = "expression"
    value: VectorField
    """Components [m/s], each a number or an expression in x, y, z [m] and t [s]."""


class TableVelocity(SceneModel):
    """Normal velocity at points from a CSV file, interpolated linearly."""

    type: Literal["table"] = "table"
    file: FileName
    """CSV file with the columns x, y, in three dimensions z [m], of points on the patch, and a column of the speed."""
    speed: str = "speed"
    """Column with the velocity along the normal [m/s]. Default: speed."""


PatchVelocity = Annotated[
    UniformVelocity | ParabolicVelocity | ExpressionVelocity | TableVelocity, Field(discriminator="type")
]


class HistoryTable(SceneModel):
    """A factor over time from a CSV file, interpolated linearly."""

    file: FileName
    """CSV file whose first row names the columns."""
    time: str = "time"
    """Column with the time [s]; strictly increasing. Default: time."""
    value: str = "value"
    """Column with the factor [1]. Default: value."""
    repeat: Flag = False
    """Repeat the table with its own duration, as a cardiac cycle; else its ends hold. Default: false."""


History = Expression | HistoryTable


class _OpenBoundary(SceneModel):
    shape: PatchShape
    """Where fluid enters or leaves; the buffer lies behind it, and walls beside it go on behind it."""
    fluid: Name | None = None
    """Fluid that the buffer holds at the start; null: the only one. Default: null."""


class _Driven(_OpenBoundary):
    history: History | None = None
    """Factor of what is prescribed [1]: an expression in t [s], or a table. Default: null."""
    ramp: NonNegativeReal = 0.0
    """Time over which what is prescribed grows smoothly from zero [s]. Default: 0."""


class VelocityBoundary(_Driven):
    """The velocity is prescribed; the pressure is that of the fluid inside, or that of a water level."""

    type: Literal["velocity"] = "velocity"
    velocity: PatchVelocity
    """Velocity on the patch."""
    level: Real | None = None
    """Height of a free surface in its section, as a coordinate against gravity [m]: the pressure is hydrostatic below,
    and nothing enters above; null: the section is full. Default: null."""

    @model_validator(mode="after")
    def _parabola_is_full(self) -> Self:
        if self.level is not None and isinstance(self.velocity, ParabolicVelocity):
            raise ValueError(
                "a parabola is zero at the edges of a full section, which one with a level is not"
            )
        return self


class PressureBoundary(_Driven):
    """The pressure is prescribed; the velocity is that of the fluid inside, along the normal where fluid enters."""

    type: Literal["pressure"] = "pressure"
    pressure: Real | Expression | None = None
    """Pressure [Pa]: a number, or an expression in x, y, z [m] and t [s]; null: that of the level. Default: null."""
    level: Real | None = None
    """Height of a free surface to hold, as a coordinate against gravity [m]: the pressure is hydrostatic below it and
    nought above; null: there is none. Default: null."""

    @model_validator(mode="after")
    def _one_pressure(self) -> Self:
        if (self.pressure is None) == (self.level is None):
            raise ValueError("it needs its pressure, or its level, and not both")
        if self.level is not None and (self.history is not None or self.ramp > 0.0):
            raise ValueError("history and ramp have no effect on a level")
        return self


class ZeroGradientBoundary(_OpenBoundary):
    """Pressure and velocity are those of the fluid inside; only the mean pressure is drawn towards a value."""

    type: Literal["zero_gradient"] = "zero_gradient"
    pressure: Real = 0.0
    """Mean pressure [Pa]. Default: 0."""
    relaxation: Annotated[Real, Field(gt=0.0, le=1.0)] = 0.1
    """Part of the difference of the mean pressure that the buffer leaves out [1]. Default: 0.1."""


class NonReflectingBoundary(_OpenBoundary):
    """Sound waves leave: what they bring is split into characteristics, and nothing comes back."""

    type: Literal["non_reflecting"] = "non_reflecting"
    pressure: Real = 0.0
    """Pressure of the undisturbed flow [Pa]. Default: 0."""
    averaging_time: Literal["auto"] | PositiveReal = "auto"
    """Time over which the undisturbed velocity is averaged [s]; auto: that in which sound crosses the particles'
    extent. Default: auto."""


OpenBoundary = Annotated[
    VelocityBoundary | PressureBoundary | ZeroGradientBoundary | NonReflectingBoundary,
    Field(discriminator="type"),
]
"""An open boundary, chosen by `type`."""
