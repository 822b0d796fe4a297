"""What particles can tell about their place: spray or bulk, tank or obstacle, inside or outside of a wall."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from warpsph.rendering.cache import RenderedSet

_CUBE, _CUBE_DIAGONAL = 27, 1.75
"""A particle and its neighbours on a lattice, and how far they reach in diameters."""

_OFF_CENTRE = 0.1
"""Diameters by which a surface particle lies off the middle of its neighbours."""


def neighbour_counts(particles: RenderedSet) -> np.ndarray:
    """Neighbours (n,) within the diagonal of a lattice cell."""
    tree = cKDTree(particles.position)
    near = _CUBE_DIAGONAL * particles.diameter
    return tree.query_ball_point(particles.position, near, workers=-1, return_length=True) - 1


def encloses(walls: RenderedSet, fluids: Sequence[RenderedSet]) -> bool:
    """Whether most of the fluid lies inside the box around the walls, as in a tank; so do walls without fluid."""
    if not fluids:
        return True
    low, high = walls.position.min(axis=0), walls.position.max(axis=0)
    position = np.concatenate([fluid.position for fluid in fluids])
    return bool(np.mean(np.all((position > low) & (position < high), axis=1)) > 0.5)


def inner_layer(walls: RenderedSet) -> np.ndarray:
    """Positions of those particles of a tank that face its middle; all of them if it has but one layer."""
    x = walls.position
    near = _CUBE_DIAGONAL * walls.diameter
    _, neighbours = cKDTree(x).query(x, k=_CUBE, distance_upper_bound=near, workers=-1)
    known = neighbours < len(x)
    total = np.where(known[..., None], x[np.where(known, neighbours, 0)], 0.0).sum(axis=1)
    away_from_neighbours = x - total / known.sum(axis=1, keepdims=True)
    is_surface = np.linalg.norm(away_from_neighbours, axis=1) > _OFF_CENTRE * walls.diameter
    towards_middle = 0.5 * (x.min(axis=0) + x.max(axis=0)) - x
    faces_middle = np.einsum("ij,ij->i", away_from_neighbours, towards_middle) > 0.0
    inner = x[is_surface & faces_middle]
    return inner if len(inner) else x
