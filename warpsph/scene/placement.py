"""Where a transformed shape stands: its rotation and displacement as matrices."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from warpsph.scene.shapes import Transform


def rotation_matrix(angle: float, axis: Sequence[float] | np.ndarray | None, dimension: int) -> np.ndarray:
    """Matrix (dimension, dimension) of a rotation by `angle` [rad], right-handed about `axis` in 3D.

    Rodrigues' formula, with the axis normalised; in 2D the axis is z.
    """
    direction = np.array([0.0, 0.0, 1.0] if axis is None else axis)
    spin = cross_matrix(direction / np.linalg.norm(direction))
    matrix = np.eye(3) + np.sin(angle) * spin + (1.0 - np.cos(angle)) * spin @ spin
    return matrix[:dimension, :dimension]


def cross_matrix(vector: np.ndarray) -> np.ndarray:
    """Matrix (3, 3) that takes r to vector x r, for a vector (3,)."""
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def placement(transform: Transform, dimension: int) -> tuple[np.ndarray, np.ndarray]:
    """Rotation (dimension, dimension) and displacement (dimension,) [m] of a transform.

    A point y of the inner shape goes to x = scale * rotation @ y + displacement.
    """
    rotation, displacement = np.eye(dimension), np.zeros(dimension)
    if transform.rotate is not None:
        turn = transform.rotate
        rotation = rotation_matrix(np.deg2rad(turn.angle), turn.axis, dimension)
        if turn.center is not None:
            displacement = turn.center - rotation @ turn.center
    if transform.translate is not None:
        displacement = displacement + transform.translate
    return rotation, displacement
