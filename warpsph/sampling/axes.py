"""Along which directions a shape has its flat faces: the lattice that fits it is turned with it."""

from __future__ import annotations

import numpy as np

from warpsph.scene.placement import placement
from warpsph.scene.shapes import Box, Extrusion, Plane, Polygon, Shape, Transform

_ALIGNED = 1e-9


def face_axes(shape: Shape, dimension: int) -> np.ndarray | None:
    """Matrix whose columns are the normals of all faces; None where faces are curved or oblique."""
    match shape:
        case Box():
            return np.eye(dimension)
        case Polygon() | Extrusion():
            return np.eye(dimension) if _along_axes(_edges(shape)) else None
        case Plane():
            return np.eye(dimension) if _along_axes(np.array([shape.normal])) else None
        case Transform():
            inner = face_axes(shape.shape, dimension)
            return None if inner is None else placement(shape, dimension)[0] @ inner
        case _:  # a combined shape, or a curved primitive, which has no parts
            return _common_axes([face_axes(part, dimension) for _, part in shape.parts()])


def own_axes(shape: Shape, dimension: int) -> np.ndarray:
    """Matrix whose columns are the coordinate axes of the shape before its transforms."""
    if isinstance(shape, Transform):
        return placement(shape, dimension)[0] @ own_axes(shape.shape, dimension)
    return np.eye(dimension)


def same_axes(first: np.ndarray, second: np.ndarray) -> bool:
    """Whether two sets of orthonormal columns are the same directions, up to order and sign."""
    return _along_axes(first.T @ second)


def _common_axes(axes: list[np.ndarray | None]) -> np.ndarray | None:
    first = axes[0] if axes else None
    if first is None or any(other is None or not same_axes(first, other) for other in axes):
        return None
    return first


def _edges(shape: Polygon | Extrusion) -> np.ndarray:
    corners = shape.outline
    return np.roll(corners, -1, axis=0) - corners


def _along_axes(vectors: np.ndarray) -> bool:
    """Whether each row (n, dimension) has all of its length in one component."""
    largest = np.abs(vectors).max(axis=1)
    return bool(np.all(np.abs(vectors).sum(axis=1) - largest <= _ALIGNED * largest))
