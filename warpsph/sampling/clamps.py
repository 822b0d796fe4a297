"""Which particles are clamped, and where they stand: on the surface of their clamp, if they are next to free ones."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from warpsph.sampling.distance import signed_distance, surface_normals
from warpsph.sampling.loads import inside
from warpsph.scene.schema import Scene
from warpsph.scene.shapes import Shape

CLOSEST = 0.5
"""Distance from free particles, in spacings, that a clamped particle keeps: that of a cell's centre from its face."""


def clamped(scene: Scene, structure: str, position: np.ndarray) -> np.ndarray:
    """Which particles (n, dim) [m] of a structure a clamp holds in all components, shape (n,)."""
    held = np.zeros(len(position), dtype=bool)
    for clamp in scene.structures[structure].clamps.values():
        if clamp.is_whole:
            held |= inside(clamp.region, position, scene.spacing)
    return held


def onto_surface(region: Shape, position: np.ndarray, clamped: np.ndarray, spacing: float) -> np.ndarray:
    """Positions (n, dim) [m] in which the outermost clamped particles have moved to the surface of the region.

    A clamp holds what lies behind its surface. Held in the centres of their cells, half a spacing behind it, particles
    would let the material begin to yield there, as if a beam were longer by a part of the spacing: an error of first
    order. None comes nearer to a free particle than half a spacing.

    Args:
        clamped: whether each particle belongs to the clamp, shape (n,).
    """
    moved = position.copy()
    if clamped.all() or not clamped.any():
        return moved
    distance, _ = cKDTree(position[~clamped]).query(position[clamped])
    depth = np.maximum(-signed_distance(region, position[clamped]), 0.0)
    room = distance - CLOSEST * spacing
    way = np.where((depth <= spacing) & (room > 0.0), np.minimum(depth, room), 0.0)
    moved[clamped] += way[:, None] * surface_normals(region, position[clamped], spacing)
    return moved
