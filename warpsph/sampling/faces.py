"""Which faces structures show to a fluid: one a particle, or two where a body is thin; and their surface normals."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.spatial import cKDTree

from warpsph.sampling.distance import signed_distance, steepest_direction
from warpsph.scene.shapes import Shape

OCCUPIED = 0.85
"""Spacings from the place before a particle within which another takes that place (Marrone et al. 2010)."""
FACING = 0.7
"""Least cosine between a normal and a direction in which it counts as pointing."""
DISTINCT = 1e-6
"""Part of the largest eigenvalue by which it exceeds the next one where the direction across a body is unique."""
_DIFFERENCE = 1e-3


@dataclass(frozen=True)
class Faces:
    """Faces of a body, m in all.

    owner: (m,) particle of the body; side: (m, dim) unit vector to the side on which a face meets fluid, zero if all
    round; normal: (m, dim) out of the surface, zero behind it; way: (m, dim) to the mirror point before the surface
    [m]; thickness: (m,) of the body at a face with a side, infinite elsewhere [m].
    """

    owner: np.ndarray
    side: np.ndarray
    normal: np.ndarray
    way: np.ndarray
    thickness: np.ndarray


def faces_of(position: np.ndarray, shape: Shape | None, spacing: float, reach: float) -> Faces:
    """Faces of a body at rest with particles at `position` (n, dim) [m], in fluid that reaches over `reach` [m].

    A particle has two faces if surfaces that look away from each other lie on both sides of it, both less than the
    reach from it; they are found from the normals of the surface particles around it, whose direction is the first
    principal axis of sum n (x) n. Where no axis stands out, as inside a small cube, rounding would choose the sides:
    there it has one face. The first face looks to the nearer surface. The mirror points of a body of several shapes
    (None) lie before its surface particles.
    """
    normal = particle_normals(position, spacing, reach)
    axis, distinct, ahead, behind = _thin_axis(position, normal, spacing, reach)
    thin = np.flatnonzero(distinct & np.isfinite(ahead + behind))
    turn = np.where(ahead[thin] <= behind[thin], 1.0, -1.0)[:, None] * axis[thin]
    near, far = np.minimum(ahead, behind)[thin], np.maximum(ahead, behind)[thin]
    way = _way_over_particles(position, normal, spacing) if shape is None else _way(position, shape, spacing)
    first_side = np.zeros_like(position)
    first_side[thin], way[thin] = turn, 2.0 * near[:, None] * turn
    thickness = ahead + behind
    return Faces(
        owner=np.concatenate([np.arange(len(position)), thin]),
        side=np.concatenate([first_side, -turn]),
        normal=np.concatenate([_on_side(normal, first_side), _on_side(normal[thin], -turn)]),
        way=np.concatenate([way, -2.0 * far[:, None] * turn]),
        thickness=np.concatenate([thickness, thickness[thin]]),
    )


def particle_normals(position: np.ndarray, spacing: float, reach: float) -> np.ndarray:
    """Unit normals (n, dim) out of a body at its surface particles, zero for those behind.

    A normal points away from the particles around, weighted towards the near ones; the particle lies at the surface if
    no other takes the place one spacing ahead (Marrone et al. 2010, for free surfaces).
    """
    tree = cKDTree(position)
    first, second = tree.query_pairs(reach, output_type="ndarray").T
    away = position[first] - position[second]
    weight = (1.0 - np.linalg.norm(away, axis=1) / reach) ** 3
    total = _summed(first, weight[:, None] * away, len(position))
    total -= _summed(second, weight[:, None] * away, len(position))
    size = np.linalg.norm(total, axis=1, keepdims=True)
    normal = np.divide(total, size, out=np.zeros_like(total), where=size > 1e-6 * spacing)
    nearest, _ = tree.query(position + spacing * normal)
    return np.where((nearest > OCCUPIED * spacing)[:, None] & (size > 1e-6 * spacing), normal, 0.0)


def _thin_axis(
    position: np.ndarray, normal: np.ndarray, spacing: float, reach: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Direction across the body (n, dim), whether it is unique, and how far the surfaces ahead and behind are (n,) [m],
    or infinitely far."""
    count, dim = position.shape
    surface = np.flatnonzero(normal.any(axis=1))
    pairs = cKDTree(position).sparse_distance_matrix(
        cKDTree(position[surface]), reach - 0.5 * spacing, output_type="coo_matrix"
    )
    near, seen = pairs.row, surface[pairs.col]
    dyads = np.einsum("pi,pj->pij", normal[seen], normal[seen])
    moments = _summed(near, dyads.reshape(-1, dim * dim), count).reshape(count, dim, dim)
    size, axes = np.linalg.eigh(moments)
    axis, distinct = axes[:, :, -1], size[:, -1] - size[:, -2] > DISTINCT * size[:, -1]
    cosine = np.einsum("pi,pi->p", normal[seen], axis[near])
    along = np.einsum("pi,pi->p", position[seen] - position[near], axis[near])
    ends = []
    for way in (1.0, -1.0):
        facing = (way * cosine > FACING) & (way * along > -0.25 * spacing)
        end = np.full(count, np.inf)
        np.minimum.at(end, near[facing], way * along[facing] + 0.5 * spacing)
        ends.append(end)
    return axis, distinct, ends[0], ends[1]


def _on_side(normal: np.ndarray, side: np.ndarray) -> np.ndarray:
    """The normals that do not point away from the side."""
    return np.where((np.einsum("ni,ni->n", normal, side) >= -1e-6)[:, None], normal, 0.0)


def _way(position: np.ndarray, shape: Shape, spacing: float) -> np.ndarray:
    """Ways (n, dim) [m] to the mirror points before the surface of a shape."""
    distance = partial(signed_distance, shape)
    return -2.0 * distance(position)[:, None] * steepest_direction(distance, position, _DIFFERENCE * spacing)


def _way_over_particles(position: np.ndarray, normal: np.ndarray, spacing: float) -> np.ndarray:
    """The same before the plane half a spacing ahead of the nearest surface particle, across its normal."""
    surface = np.flatnonzero(normal.any(axis=1))
    nearest = surface[cKDTree(position[surface]).query(position)[1]]
    depth = np.einsum("ni,ni->n", position[nearest] - position, normal[nearest]) + 0.5 * spacing
    return 2.0 * depth[:, None] * normal[nearest]


def _summed(index: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    """Sums (count, k) of the rows of `values` (p, k) by index."""
    columns = [np.bincount(index, values[:, k], minlength=count) for k in range(values.shape[1])]
    return np.stack(columns, axis=1)
