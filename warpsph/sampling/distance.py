"""Signed distance of points from the surface of a shape."""

from __future__ import annotations

from collections.abc import Callable, Sequence
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

_GRADIENT_STEP = 1e-3

DistanceFunction = Callable[[np.ndarray], np.ndarray]
"""Signed distance (n,) [m] of points (n, dimension) [m]."""


def surface_normals(shape: Shape, points: np.ndarray, spacing: float) -> np.ndarray:
    """Unit vectors (n, dim) along which the distance from a shape's surface grows fastest at points (n, dim) [m].

    The step of the central difference is a small part of the spacing [m].
    """
    dim, step = points.shape[1], _GRADIENT_STEP * spacing
    slopes = [
        signed_distance(shape, points + step * e) - signed_distance(shape, points - step * e)
        for e in np.eye(dim)
    ]
    gradient = np.stack(slopes, axis=1)
    return gradient / np.maximum(np.linalg.norm(gradient, axis=1, keepdims=True), np.finfo(float).tiny)


@singledispatch
def signed_distance(shape: Shape, points: np.ndarray) -> np.ndarray:
    """Distance (n,) [m] of points (n, dimension) [m] from the surface, negative inside.

    Exact for the primitives, meshes whose shells do not overlap, and their transforms. For unions it is exact outside,
    for intersections and differences inside; elsewhere its sign is right and its magnitude a lower bound. It never
    changes faster than the distance walked (Lipschitz constant 1).
    """
    raise TypeError(f"no signed distance is defined for {type(shape).__name__}")


@signed_distance.register
def _(shape: Box, points: np.ndarray) -> np.ndarray:
    low, high = np.array(shape.min), np.array(shape.max)
    beyond = np.abs(points - (low + high) / 2.0) - (high - low) / 2.0
    return np.linalg.norm(np.maximum(beyond, 0.0), axis=1) + np.minimum(beyond.max(axis=1), 0.0)


@signed_distance.register
def _(shape: Sphere, points: np.ndarray) -> np.ndarray:
    return np.linalg.norm(points - np.array(shape.center), axis=1) - shape.radius


@signed_distance.register
def _(shape: Cylinder, points: np.ndarray) -> np.ndarray:
    start, along = np.array(shape.start), np.subtract(shape.end, shape.start)
    length = np.linalg.norm(along)
    height = (points - start) @ (along / length)
    radial = np.linalg.norm(points - start - np.outer(height, along / length), axis=1) - shape.radius
    return _prism_distance(radial, np.abs(height - length / 2.0) - length / 2.0)


@signed_distance.register(Polygon)
@signed_distance.register(Naca)
def _(shape: Polygon | Naca, points: np.ndarray) -> np.ndarray:
    return polygon_distance(shape.outline, points)


@signed_distance.register
def _(shape: Extrusion, points: np.ndarray) -> np.ndarray:
    axis = "xyz".index(shape.axis)
    across = polygon_distance(shape.outline, np.delete(points, axis, axis=1))
    middle, half = (shape.low + shape.high) / 2.0, (shape.high - shape.low) / 2.0
    return _prism_distance(across, np.abs(points[:, axis] - middle) - half)


@signed_distance.register
def _(shape: Mesh, points: np.ndarray) -> np.ndarray:
    from warpsph.geometry.mesh_distance import mesh_distance  # with it comes Warp, which others do without

    return mesh_distance(shape.surface)(points)


@signed_distance.register
def _(shape: Plane, points: np.ndarray) -> np.ndarray:
    normal = np.array(shape.normal) / np.linalg.norm(shape.normal)
    return (points - np.array(shape.point)) @ normal


@signed_distance.register
def _(shape: Union, points: np.ndarray) -> np.ndarray:
    return np.minimum.reduce(_distances(shape.shapes, points))


@signed_distance.register
def _(shape: Intersection, points: np.ndarray) -> np.ndarray:
    return np.maximum.reduce(_distances(shape.shapes, points))


@signed_distance.register
def _(shape: Difference, points: np.ndarray) -> np.ndarray:
    removed = np.minimum.reduce(_distances(shape.subtract, points))
    return np.maximum(signed_distance(shape.base, points), -removed)


@signed_distance.register
def _(shape: Transform, points: np.ndarray) -> np.ndarray:
    rotation, displacement = placement(shape, points.shape[1])
    return shape.scale * signed_distance(shape.shape, (points - displacement) @ rotation / shape.scale)


def polygon_distance(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Signed distance (n,) of points (n, 2) from a simple polygon (m, 2), negative inside."""
    squared = np.full(len(points), np.inf)
    inside = np.zeros(len(points), dtype=bool)
    x, y = points.T
    for (ax, ay), (bx, by) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        ex, ey, px, py = bx - ax, by - ay, x - ax, y - ay
        along = np.clip((px * ex + py * ey) / (ex * ex + ey * ey), 0.0, 1.0)
        np.minimum(squared, (px - along * ex) ** 2 + (py - along * ey) ** 2, out=squared)
        left = ex * py - ey * px > 0.0
        inside ^= ((ay <= y) & (y < by) & left) | ((by <= y) & (y < ay) & ~left)
    return np.where(inside, -1.0, 1.0) * np.sqrt(squared)


def steepest_direction(distance: DistanceFunction, points: np.ndarray, step: float) -> np.ndarray:
    """Unit vectors (n, dimension) along which a distance grows fastest, by differences over `step` [m].

    Zero where the differences cancel, as in the middle between two surfaces.
    """
    offsets = step * np.eye(points.shape[1])
    differences = [distance(points + offset) - distance(points - offset) for offset in offsets]
    gradient = np.stack(differences, axis=1)
    length = np.linalg.norm(gradient, axis=1, keepdims=True)
    return np.divide(gradient, length, out=np.zeros_like(gradient), where=length > 0.0)


def _distances(shapes: Sequence[Shape], points: np.ndarray) -> list[np.ndarray]:
    return [signed_distance(shape, points) for shape in shapes]


def _prism_distance(across: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Distance from a prism, from the distances to its lateral surface and to its end planes."""
    outside = np.hypot(np.maximum(across, 0.0), np.maximum(along, 0.0))
    return outside + np.minimum(np.maximum(across, along), 0.0)
