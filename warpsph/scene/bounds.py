"""How far a shape reaches in a direction."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from functools import singledispatch

import numpy as np

from warpsph.scene.placement import placement
from warpsph.scene.shapes import (
    Box,
    Cylinder,
    Difference,
    Extrusion,
    Intersection,
    Mesh,
    Naca,
    Plane,
    Polygon,
    Shape,
    Sphere,
    Transform,
    Union,
)

Interval = tuple[float, float]

_PARALLEL = 1e-12


def bounding_box(shape: Shape, rotation: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corner (dimension,) [m] of a box around the shape; infinite where the shape is.

    With a `rotation` (dimension, dimension), the corners are coordinates along its columns instead of along
    the axes. The box is tight for all shapes except intersections and differences, which it encloses.
    """
    directions = np.eye(dimension_of(shape)) if rotation is None else rotation.T
    low, high = np.transpose([extent(shape, direction) for direction in directions])
    return low, high


def dimension_of(shape: Shape) -> int:
    """2 or 3, from the vectors of the shape."""
    match shape:
        case Box():
            return len(shape.min)
        case Sphere():
            return len(shape.center)
        case Plane():
            return len(shape.point)
        case Polygon() | Naca():
            return 2
        case Cylinder() | Extrusion() | Mesh():
            return 3
        case _:
            return dimension_of(next(shape.parts())[1])


@singledispatch
def extent(shape: Shape, direction: np.ndarray) -> Interval:
    """Smallest and largest x . direction over the points x of the shape [m]; infinite where the shape is."""
    raise TypeError(f"no extent is defined for {type(shape).__name__}")


@extent.register
def _(shape: Box, direction: np.ndarray) -> Interval:
    ends = np.sort([direction * shape.min, direction * shape.max], axis=0).sum(axis=1)
    return ends[0], ends[1]


@extent.register
def _(shape: Sphere, direction: np.ndarray) -> Interval:
    middle, reach = np.dot(shape.center, direction), shape.radius * np.linalg.norm(direction)
    return middle - reach, middle + reach


@extent.register
def _(shape: Cylinder, direction: np.ndarray) -> Interval:
    along = np.subtract(shape.end, shape.start)
    along /= np.linalg.norm(along)
    reach = shape.radius * np.linalg.norm(direction - np.dot(direction, along) * along)
    ends = np.dot([shape.start, shape.end], direction)
    return ends.min() - reach, ends.max() + reach


@extent.register(Polygon)
@extent.register(Naca)
def _(shape: Polygon | Naca, direction: np.ndarray) -> Interval:
    return _range(shape.outline @ direction)


@extent.register
def _(shape: Mesh, direction: np.ndarray) -> Interval:
    return _range(shape.surface.vertices @ direction)


@extent.register
def _(shape: Extrusion, direction: np.ndarray) -> Interval:
    axis = "xyz".index(shape.axis)
    across = shape.outline @ np.delete(direction, axis)
    return _range(np.add.outer(across, direction[axis] * np.array([shape.low, shape.high])))


@extent.register
def _(shape: Plane, direction: np.ndarray) -> Interval:
    normal = np.array(shape.normal) / np.linalg.norm(shape.normal)
    along = np.dot(direction, normal)
    if np.linalg.norm(direction - along * normal) > _PARALLEL * np.linalg.norm(direction):
        return -math.inf, math.inf
    surface = float(np.dot(shape.point, direction))
    return (-math.inf, surface) if along > 0.0 else (surface, math.inf)


@extent.register
def _(shape: Union, direction: np.ndarray) -> Interval:
    lows, highs = zip(*_extents(shape.shapes, direction), strict=True)
    return min(lows), max(highs)


@extent.register
def _(shape: Intersection, direction: np.ndarray) -> Interval:
    lows, highs = zip(*_extents(shape.shapes, direction), strict=True)
    return max(lows), min(highs)


@extent.register
def _(shape: Difference, direction: np.ndarray) -> Interval:
    return extent(shape.base, direction)


@extent.register
def _(shape: Transform, direction: np.ndarray) -> Interval:
    rotation, displacement = placement(shape, len(direction))
    low, high = extent(shape.shape, rotation.T @ direction)
    shift = np.dot(direction, displacement)
    return shape.scale * low + shift, shape.scale * high + shift


def _extents(shapes: Sequence[Shape], direction: np.ndarray) -> Iterable[Interval]:
    return [extent(shape, direction) for shape in shapes]


def _range(values: np.ndarray) -> Interval:
    return values.min(), values.max()
