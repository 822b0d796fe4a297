"""Which particles of a set lie at its surface."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

_ADJACENT = 1.2
"""Farther than the next cell of a lattice, nearer than the one across an edge, in spacings."""


def at_surface(points: np.ndarray, spacing: float) -> np.ndarray:
    """Whether a face of a particle's cell is free, shape (n,); points (n, dim) [m] on a lattice of that spacing.

    Layers that follow a curved surface have fewer neighbours at these distances than a lattice, or as many; of those a
    part of the inside counts as surface, too.
    """
    tree = cKDTree(points)
    neighbours = tree.query_ball_point(points, _ADJACENT * spacing, return_length=True) - 1
    return np.asarray(neighbours < 2 * points.shape[1])
