"""Shapes of fluids, walls and structures: solids described by their surface, and their combinations."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, ValidationInfo, field_validator, model_validator

from warpsph.scene.errors import Problem
from warpsph.scene.mesh_shape import Mesh
from warpsph.scene.sections import Corners, Naca, Polygon, Section, checked_corners
from warpsph.scene.shape_model import ShapeModel
from warpsph.scene.types import Axis, Components, PositiveReal, Real, SceneModel, Vector, Vector2, Vector3


class Bounds(SceneModel):
    """A region with faces along the axes, given by two opposite corners."""

    min: Vector
    """Corner with the smallest coordinates [m]."""
    max: Vector
    """Corner with the largest coordinates [m]; greater than `min` in every component."""

    @field_validator("max")
    @classmethod
    def _greater_than_min(cls, high: Components, info: ValidationInfo) -> Components:
        return _checked_upper_corner(info.data.get("min"), high)


class Box(ShapeModel):
    """A box with faces along the axes (a rectangle in two dimensions)."""

    type: Literal["box"] = "box"
    min: Vector
    """Corner with the smallest coordinates [m]."""
    max: Vector
    """Corner with the largest coordinates [m]; greater than `min` in every component."""

    @field_validator("max")
    @classmethod
    def _greater_than_min(cls, high: Components, info: ValidationInfo) -> Components:
        return _checked_upper_corner(info.data.get("min"), high)


class Sphere(ShapeModel):
    """A sphere (a disc in two dimensions)."""

    type: Literal["sphere"] = "sphere"
    center: Vector
    """Centre [m]."""
    radius: PositiveReal
    """Radius [m]."""


class Cylinder(ShapeModel):
    """A circular cylinder with flat ends; three dimensions only."""

    type: Literal["cylinder"] = "cylinder"
    start: Vector3
    """Centre of the one end [m]."""
    end: Vector3
    """Centre of the other end [m]; differs from `start`."""
    radius: PositiveReal
    """Radius [m]."""

    @field_validator("end")
    @classmethod
    def _away_from_start(cls, end: Vector3, info: ValidationInfo) -> Vector3:
        if end == info.data.get("start"):
            raise ValueError("end equals start, so the cylinder has no length")
        return end

    def dimension_problems(self, dimension: int) -> Iterator[Problem]:
        return self._exists_only_in(3, dimension, "a sphere (which is a disc)")


class Extrusion(ShapeModel):
    """A prism: a polygon, given by `points` or as a `section`, extended along an axis; three dimensions only."""

    type: Literal["extrusion"] = "extrusion"
    points: Corners | None = None
    """Corners of the cross-section [m]: (y, z) for axis x, (x, z) for axis y, (x, y) for axis z. Default: null."""
    section: Section | None = None
    """The cross-section as a figure of the plane, in the same coordinates. Default: null."""
    axis: Axis
    """Axis along which the cross-section is extended."""
    low: Real
    """Smallest coordinate along the axis [m]."""
    high: Real
    """Largest coordinate along the axis [m]; greater than `low`."""

    @field_validator("points")
    @classmethod
    def _simple(cls, points: tuple[Vector2, ...] | None) -> tuple[Vector2, ...] | None:
        return checked_corners(points)

    @field_validator("high")
    @classmethod
    def _greater_than_low(cls, high: float, info: ValidationInfo) -> float:
        low = info.data.get("low")
        if low is not None and high <= low:
            raise ValueError(f"high must be greater than low = {low:g}")
        return high

    def dimension_problems(self, dimension: int) -> Iterator[Problem]:
        return self._exists_only_in(3, dimension, "a polygon")

    @model_validator(mode="after")
    def _one_section(self) -> Self:
        if (self.points is None) == (self.section is None):
            raise ValueError("an extrusion needs the points of its cross-section, or a section, and not both")
        return self

    @property
    def outline(self) -> np.ndarray:
        """Corners (n, 2) [m] of the cross-section in order."""
        return np.array(self.points or ()) if self.section is None else self.section.outline


class Plane(ShapeModel):
    """The half-space behind a plane.

    A floor is a plane with its normal upwards and `side: inside`: layers behind the plane, fluid before it.
    """

    type: Literal["plane"] = "plane"
    point: Vector
    """Any point of the plane [m]."""
    normal: Vector
    """Direction out of the half-space; its length does not matter."""
    bounds: Bounds | None = None
    """Extent of a wall: layers where the nearest point of the plane lies in this region. Default: null."""

    @field_validator("normal")
    @classmethod
    def _not_zero(cls, normal: Components) -> Components:
        _refuse_zero(normal, "the normal")
        return normal


class Union(ShapeModel):
    """Everything that lies in any of the shapes."""

    type: Literal["union"] = "union"
    shapes: Annotated[tuple[Shape, ...], Field(min_length=1)]
    """The shapes to unite."""

    def parts(self) -> Iterator[tuple[str, Shape]]:
        return _indexed("shapes", self.shapes)


class Intersection(ShapeModel):
    """What all the shapes have in common."""

    type: Literal["intersection"] = "intersection"
    shapes: Annotated[tuple[Shape, ...], Field(min_length=1)]
    """The shapes to intersect."""

    def parts(self) -> Iterator[tuple[str, Shape]]:
        return _indexed("shapes", self.shapes)


class Difference(ShapeModel):
    """A shape with others cut out of it."""

    type: Literal["difference"] = "difference"
    base: Shape
    """The shape to cut from."""
    subtract: Annotated[tuple[Shape, ...], Field(min_length=1)]
    """The shapes to take away."""

    def parts(self) -> Iterator[tuple[str, Shape]]:
        yield "base", self.base
        yield from _indexed("subtract", self.subtract)


class Rotation(SceneModel):
    """A turn about a fixed point (and, in three dimensions, about an axis through it)."""

    angle: Real
    """Angle [degrees], counter-clockwise in two dimensions, right-handed about `axis` in three."""
    axis: Vector3 | None = None
    """Direction of the axis, of any length; required in three dimensions, left out in two."""
    center: Vector | None = None
    """Fixed point [m]; null: the origin. Default: null."""

    @field_validator("axis")
    @classmethod
    def _not_zero(cls, axis: Vector3 | None) -> Vector3 | None:
        if axis is not None:
            _refuse_zero(axis, "the axis")
        return axis

    def dimension_problems(self, dimension: int) -> Iterator[Problem]:
        """A rotation needs its axis in three dimensions and has none in two; keys are relative."""
        yield from axis_problems(self.axis, dimension)


class Transform(ShapeModel):
    """A shape scaled about the origin, then rotated, then translated."""

    type: Literal["transform"] = "transform"
    shape: Shape
    """The shape to move."""
    scale: PositiveReal = 1.0
    """Factor on all lengths, about the origin [1]. Default: 1."""
    rotate: Rotation | None = None
    """Rotation, after scaling. Default: none."""
    translate: Vector | None = None
    """Displacement [m], after scaling and rotating. Default: none."""

    @model_validator(mode="after")
    def _does_something(self) -> Self:
        if self.scale == 1.0 and self.rotate is None and self.translate is None:
            raise ValueError("a transform needs at least one of scale, rotate and translate")
        return self

    def parts(self) -> Iterator[tuple[str, Shape]]:
        yield "shape", self.shape

    def dimension_problems(self, dimension: int) -> Iterator[Problem]:
        yield from super().dimension_problems(dimension)
        if self.rotate is not None:
            for problem in self.rotate.dimension_problems(dimension):
                yield replace(problem, key=f"rotate.{problem.key}")


Shape = Annotated[
    Box
    | Sphere
    | Cylinder
    | Polygon
    | Naca
    | Extrusion
    | Plane
    | Mesh
    | Union
    | Intersection
    | Difference
    | Transform,
    Field(discriminator="type"),
]
"""A solid, chosen by `type`."""

for _model in (Union, Intersection, Difference, Transform):
    _model.model_rebuild()


def axis_problems(axis: Vector3 | None, dimension: int) -> Iterator[Problem]:
    """The problem of a rotation axis that is missing in three dimensions or given in two."""
    if dimension == 3 and axis is None:
        yield Problem.at("axis", "a rotation in three dimensions needs its axis", "three numbers")
    if dimension == 2 and axis is not None:
        yield Problem.at("axis", "a rotation in two dimensions has no axis", "leave it out", axis)


def _indexed(key: str, shapes: Sequence[Shape]) -> Iterator[tuple[str, Shape]]:
    return ((f"{key}.{index}", shape) for index, shape in enumerate(shapes))


def _refuse_zero(vector: Sequence[float], name: str) -> None:
    if math.hypot(*vector) == 0.0:
        raise ValueError(f"{name} must not be zero")


def _checked_upper_corner(low: Components | None, high: Components) -> Components:
    """`high`, after a check against the lower corner (None where that was refused itself)."""
    if low is None:
        return high
    if len(low) != len(high):
        raise ValueError(f"max has {len(high)} components and min has {len(low)}")
    for axis, lower, upper in zip("xyz", low, high, strict=False):
        if upper <= lower:
            raise ValueError(f"max must be greater than min in {axis}, but {upper:g} <= {lower:g}")
    return high
