"""Where fluid meets walls that do not follow its lattice."""

from __future__ import annotations

from functools import partial

import numpy as np
from scipy.spatial import cKDTree

from warpsph.sampling.distance import DistanceFunction, signed_distance
from warpsph.sampling.packing import CLOSEST, SURFACE_CLEARANCE, pushed_inside
from warpsph.sampling.walls import beyond_open_faces
from warpsph.scene.schema import Boundary
from warpsph.scene.structures import Structure

# In units of the spacing: farther than any point inside a wall from the next wall particle, nearer than the
# fluid on the same lattice.
_NEAR = 0.9


def as_wall(structure: Structure) -> Boundary:
    """A structure at rest as the wall that it is to a fluid."""
    return Boundary(shape=structure.shape, side="solid")


def inside_wall(points: np.ndarray, boundary: Boundary, wall: np.ndarray, spacing: float) -> np.ndarray:
    """The points (n, dimension) [m] that lie inside the wall deeper than can be evened out."""
    near = points[_near(points, boundary, wall, spacing)]
    return near[_distance_behind_surface(boundary)(near) > SURFACE_CLEARANCE * spacing]


def clear_of_wall(points: np.ndarray, boundary: Boundary, wall: np.ndarray, spacing: float) -> np.ndarray:
    """The points (n, dimension) [m], those on the wall's surface moved a quarter of the spacing off it.

    Cells cut by an oblique or curved surface belong to the fluid if their centre does, so that its volume is
    right; this keeps the centres from coming too close to the first layer. Cells in a wedge narrower than
    themselves are left out.
    """
    near = _near(points, boundary, wall, spacing)
    if len(near) == 0:
        return points
    behind = _distance_behind_surface(boundary)
    moved, fits = pushed_inside(points[near], behind, SURFACE_CLEARANCE * spacing, spacing)
    moved, fits_too = pushed_inside(moved, behind, _clear_depth(moved, behind, wall, spacing), spacing)
    result = points.copy()
    result[near] = moved
    keep = np.ones(len(points), dtype=bool)
    keep[near] = fits & fits_too
    return result[keep]


def _clear_depth(
    points: np.ndarray, behind: DistanceFunction, wall: np.ndarray, spacing: float
) -> np.ndarray:
    """How far (n,) [m] off the surface the points are, plus what they lack to the nearest wall particle.

    Only walls thinner than the spacing have particles that near behind their surface; elsewhere it is -inf.
    """
    nearest, _ = cKDTree(wall).query(points)
    lacking = CLOSEST * spacing - nearest
    return np.where(lacking > 0.0, lacking - behind(points), -np.inf)


def _near(points: np.ndarray, boundary: Boundary, wall: np.ndarray, spacing: float) -> np.ndarray:
    """Indices of the points with a wall particle nearer than the lattice would have it."""
    if len(points) == 0 or len(wall) == 0:
        return np.empty(0, dtype=np.intp)
    nearest, _ = cKDTree(wall).query(points, distance_upper_bound=_NEAR * spacing, workers=-1)
    near = np.flatnonzero(np.isfinite(nearest))
    return near[~beyond_open_faces(points[near], boundary, 0.0)]


def _distance_behind_surface(boundary: Boundary) -> DistanceFunction:
    """Distance of points behind the surface of a wall, negative on the fluid's side."""
    distance = partial(signed_distance, boundary.shape)
    return distance if boundary.side == "outside" else lambda points: -distance(points)
