"""The regions that particles of a scene fill, as distances from their surfaces."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np

from warpsph.sampling.distance import DistanceFunction, signed_distance
from warpsph.scene.schema import Boundary
from warpsph.scene.shapes import Shape

Period = Mapping[int, tuple[float, float]]
"""Lower and upper end [m] of each periodic axis, by the axis' index."""


def body_region(shape: Shape, period: Period) -> DistanceFunction:
    """The inside of a shape, within the period."""
    return _within(partial(signed_distance, shape), period)


def wall_region(boundary: Boundary, thickness: float, period: Period) -> DistanceFunction:
    """The inside of a solid wall, else its layers of a thickness [m]; within the period."""
    distance = partial(signed_distance, boundary.shape)
    if boundary.side == "solid":
        return _within(distance, period)
    side = 1.0 if boundary.side == "outside" else -1.0

    def layers(points: np.ndarray) -> np.ndarray:
        behind = side * distance(points)
        return np.maximum(-behind, behind - thickness)

    return _within(layers, period)


def _within(distance: DistanceFunction, period: Period) -> DistanceFunction:
    """The distance from the part of a region that lies in the period; its ends are surfaces of that part."""
    if not period:
        return distance

    def within(points: np.ndarray) -> np.ndarray:
        ends = [
            np.abs(points[:, axis] - (low + high) / 2.0) - (high - low) / 2.0
            for axis, (low, high) in period.items()
        ]
        return np.maximum.reduce([distance(points), *ends])

    return within
