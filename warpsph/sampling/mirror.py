"""Where wall particles have their mirror points in the fluid."""

from __future__ import annotations

from functools import partial

import numpy as np

from warpsph.sampling.distance import signed_distance, steepest_direction
from warpsph.sampling.regions import Period
from warpsph.scene.schema import Boundary
from warpsph.scene.shapes import Box, Shape
from warpsph.scene.types import AXES

_DIFFERENCE = 1e-3
"""Step of the differences of the distance, in spacings."""
_FAR = 100.0
"""How far a face that carries no wall is moved away, in spacings and beside the diagonal of its box."""


def mirror_ways(boundary: Boundary, position: np.ndarray, spacing: float, period: Period) -> np.ndarray:
    """The way (n, dimension) [m] from wall particles (n, dimension) [m] to their mirror points beyond the surface.

    It goes through the nearest point of the surface: at an edge, across the edge. Zero in the middle between two
    surfaces.
    """
    distance = partial(signed_distance, _without_ends(boundary, spacing, period))
    normal = steepest_direction(distance, position, _DIFFERENCE * spacing)
    return -2.0 * distance(position)[:, None] * normal


def _without_ends(boundary: Boundary, spacing: float, period: Period) -> Shape:
    """The boundary's shape; of a box, open faces and the ends of a period that it fills are moved far away."""
    shape = boundary.shape
    if not isinstance(shape, Box):
        return shape
    low, high = np.array(shape.min), np.array(shape.max)
    far = np.linalg.norm(high - low) + _FAR * spacing
    for axis, (start, end) in period.items():
        if low[axis] <= start + spacing and high[axis] >= end - spacing:
            low[axis], high[axis] = low[axis] - far, high[axis] + far
    for face in boundary.open:
        axis = AXES.index(face[0])
        if face.endswith("min"):
            low[axis] -= far
        else:
            high[axis] += far
    return Box(min=tuple(low), max=tuple(high))
