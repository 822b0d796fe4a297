"""Even distances where particles of different origin meet: neither too close nor too far apart."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.spatial import Delaunay, QhullError, cKDTree

from warpsph.sampling.distance import DistanceFunction, steepest_direction

# In units of the spacing. Regular layers keep 1; what meets at an angle cannot, and keeps these.
CLOSEST = 0.7
SURFACE_CLEARANCE = 0.25

_HOLE_OF_LATTICE = {2: np.sqrt(2.0) / 2.0, 3: np.sqrt(3.0) / 2.0}
_HOLE_TOLERANCE = 1.1
_FILL_ROUNDS = 4
_PUSHES = 4


def thinned(points: np.ndarray, distance: float) -> np.ndarray:
    """The points (n, dimension) without those that lie closer than `distance` to an earlier, kept one."""
    keep = np.ones(len(points), dtype=bool)
    pairs = (
        cKDTree(points).query_pairs(distance, output_type="ndarray") if len(points) else np.empty((0, 2), int)
    )
    for first, second in pairs[np.lexsort(pairs.T[::-1])]:
        if keep[first]:
            keep[second] = False
    return points[keep]


def away_from(points: np.ndarray, others: np.ndarray, distance: float) -> np.ndarray:
    """The points (n, dimension) that lie at least `distance` away from all the others (m, dimension)."""
    if len(points) == 0 or len(others) == 0:
        return points
    nearest, _ = cKDTree(others).query(points, distance_upper_bound=distance)
    return points[np.isinf(nearest)]


def filled(
    points: np.ndarray,
    spacing: float,
    region: Callable[[np.ndarray], np.ndarray],
    near: np.ndarray | None = None,
) -> np.ndarray:
    """The points (n, dimension) and more of them in the holes that are wider than those of a lattice.

    A hole is an empty sphere through the neighbours around it; its centre must lie in the `region`. `near`
    marks the points between which holes are sought (default: all).
    """
    sought = points if near is None else points[near]
    widest = _HOLE_TOLERANCE * _HOLE_OF_LATTICE[points.shape[1]] * spacing
    for _ in range(_FILL_ROUNDS):
        centers = _holes(sought, widest, 2.0 * spacing)
        centers = away_from(centers[region(centers)], points, widest)
        if len(centers) == 0:
            break
        added = thinned(centers, widest)
        points, sought = np.concatenate([points, added]), np.concatenate([sought, added])
    return points


def _holes(points: np.ndarray, narrowest: float, widest: float) -> np.ndarray:
    """Centres (m, dimension) of the empty spheres between points, of radii in the range, widest first."""
    dimension = points.shape[1]
    try:
        corners = points[Delaunay(points).simplices]
    except (QhullError, ValueError):  # too few points, or all on a line or plane: nothing lies between them
        return np.empty((0, dimension))
    edges = corners[:, 1:] - corners[:, :1]
    solid = np.abs(np.linalg.det(edges)) > 1e-9 * narrowest**dimension
    edges, apex = edges[solid], corners[solid, 0]
    offsets = np.linalg.solve(edges, 0.5 * (edges**2).sum(axis=2)[..., None])[..., 0]
    radius = np.linalg.norm(offsets, axis=1)
    chosen = np.flatnonzero((radius > narrowest) & (radius < widest))
    chosen = chosen[np.argsort(-radius[chosen], kind="stable")]
    return apex[chosen] + offsets[chosen]


def pushed_inside(
    points: np.ndarray, distance: DistanceFunction, depth: float | np.ndarray, spacing: float
) -> tuple[np.ndarray, np.ndarray]:
    """The points (n, dimension), those less than `depth` [m] (one, or (n,)) below the surface moved there.

    The second result (n,) is false for points in a wedge too narrow for that.
    """
    points = points.copy()
    excess = distance(points) + depth
    for _ in range(_PUSHES):
        above = np.flatnonzero(excess > 0.0)
        if len(above) == 0:
            break
        direction = steepest_direction(distance, points[above], 1e-4 * spacing)
        points[above] -= excess[above, None] * direction
        excess = distance(points) + depth
    return points, excess <= 0.5 * SURFACE_CLEARANCE * spacing
