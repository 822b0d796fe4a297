"""Which points lie near others, coarsely and at once for all of them."""

from __future__ import annotations

import itertools

import numpy as np


def cells_beside(points: np.ndarray, others: np.ndarray, edge: float) -> np.ndarray:
    """Tell for each point (n, dim) [m] whether a cell of this edge [m] that holds one of the others (m, dim) is its own
    or borders on it: true of all points that are nearer than the edge to another one, false beyond twice its diagonal.
    """
    if not len(points) or not len(others):
        return np.zeros(len(points), dtype=bool)
    with np.errstate(invalid="ignore"):  # a run that diverges is stopped elsewhere
        occupied = np.unique(np.floor(others / edge).astype(np.int64), axis=0)
        cells = np.floor(points / edge).astype(np.int64)
    shifts = np.array(list(itertools.product((-1, 0, 1), repeat=points.shape[1])))
    around = (occupied[:, None] + shifts).reshape(-1, points.shape[1])
    low, high = around.min(axis=0), around.max(axis=0)
    inside = ((cells >= low) & (cells <= high)).all(axis=1)
    strides = np.concatenate([[1], np.cumprod((high - low + 1)[:-1])])
    inside[inside] = np.isin((cells[inside] - low) @ strides, (around - low) @ strides)
    return inside
