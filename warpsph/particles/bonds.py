"""Bonds of structures: the neighbours of each particle at rest, and the correction of their gradients."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

SINGULAR = 0.01
"""Smallest eigenvalue of a particle's moment matrix, over the largest, at which its direction still counts as seen."""

Weights = Callable[[np.ndarray], np.ndarray]
"""F [m^-(dim+2)] of bond lengths [m], where grad_a W_ab = F x_ab."""


@dataclass(frozen=True)
class Bonds:
    """Rows of neighbours of n particles, filled from the left; m is the longest row.

    neighbour: (n, m) indices; vector: (n, m, dim) X_ab [m]; weight: (n, m) w_ab = V_b F [m^-2], negative;
    ends: (n, 2) where the bonds between deformable particles end in each row, and where those with rigid particles
    behind them do; correction: (n, dim, dim) L_a [1]; normal: (n, dim) unit normal of the plane of
    the neighbours where they lie in one (in 2D: of their line), else zero;
    seen: (n,) 0 where they see even less, else 1.
    """

    neighbour: np.ndarray
    vector: np.ndarray
    weight: np.ndarray
    ends: np.ndarray
    correction: np.ndarray
    normal: np.ndarray
    seen: np.ndarray

    @property
    def count(self) -> np.ndarray:
        """Neighbours of each particle, shape (n,)."""
        return self.ends[:, 1]

    @property
    def thin(self) -> np.ndarray:
        """Whether a particle's neighbours do not span the space, shape (n,)."""
        return (self.normal != 0.0).any(axis=1) | (self.seen == 0.0)


def make_bonds(
    position: np.ndarray,
    body: np.ndarray,
    volume: np.ndarray,
    rigid: np.ndarray,
    radius: float,
    periods: Sequence[float],
    weights: Weights,
) -> Bonds:
    """Bonds within each body, none between bodies and none between rigid particles.

    Args:
        position: of all particles (n, dim) [m].
        body: number of the body of each particle (n,); several structures may be one body.
        volume: of all particles (n,) [m^dim].
        rigid: whether each particle's displacement is prescribed in all components, shape (n,). It has no strain of its
            own, so its correction is zero.
        radius: reach of a bond [m].
        periods: length of each periodic axis [m], zero along the others.
    """
    first, second = pairs_within(position, body, rigid, radius, np.asarray(periods))
    vector = nearest_image(position[first] - position[second], np.asarray(periods))
    weight = volume[second] * weights(np.linalg.norm(vector, axis=1))
    correction, normal, seen = _corrections(rigid, first, vector, weight)
    count = np.bincount(first, minlength=len(position))
    deformable = np.bincount(first[~(rigid[first] | rigid[second])], minlength=len(position))
    column = np.arange(len(first)) - np.repeat(np.cumsum(count) - count, count)
    shape = (len(position), max(int(count.max(initial=0)), 1))

    ends = np.column_stack([deformable, count])

    def rows(values: np.ndarray) -> np.ndarray:
        table = np.zeros((*shape, *values.shape[1:]), dtype=values.dtype)
        table[first, column] = values
        return table

    return Bonds(rows(second), rows(vector), rows(weight), ends, correction, normal, seen)


def pairs_within(
    position: np.ndarray, body: np.ndarray, rigid: np.ndarray, radius: float, periods: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Both directions of every pair of a body within the radius, sorted by the first particle; bonds with rigid ones
    last."""
    found = [np.empty((0, 2), dtype=np.int64)]
    for number in np.unique(body):
        members = np.flatnonzero(body == number)
        tree = periodic_tree(position[members], periods)
        found.append(members[tree.query_pairs(radius, output_type="ndarray")])
    pairs = np.concatenate(found)
    both = np.concatenate([pairs, pairs[:, ::-1]])
    both = both[~rigid[both].all(axis=1)]
    both = both[np.lexsort((both[:, 1], rigid[both].any(axis=1), both[:, 0]))]
    return both[:, 0], both[:, 1]


def periodic_tree(position: np.ndarray, periods: np.ndarray) -> cKDTree:
    """Search tree over positions (n, dim) [m] in a space of these periods (dim,) [m], zero where there is none."""
    box, repeats = np.where(periods > 0.0, periods, 0.0), periods > 0.0
    inside = np.where(repeats, np.mod(position, np.where(repeats, periods, 1.0)), position)
    # A place a rounding before zero is as far as the period, which the tree does not take.
    inside = np.where(repeats & (inside >= box), 0.0, inside)
    return cKDTree(inside, boxsize=box if box.any() else None)


def nearest_image(vector: np.ndarray, periods: np.ndarray) -> np.ndarray:
    """Separations (n, dim) [m] to the nearest image; periods (dim,) [m] are zero along axes that are not periodic."""
    lengths = np.where(periods > 0.0, periods, np.inf)
    return vector - np.where(np.isfinite(lengths), lengths, 0.0) * np.round(vector / lengths)


def _corrections(
    rigid: np.ndarray, first: np.ndarray, vector: np.ndarray, weight: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """L_a = (-sum_b w_ab X_ab (x) X_ab)^-1 over the directions that the neighbours see, and what they do not see."""
    dim = vector.shape[1]
    moment = np.zeros((len(rigid), dim, dim))
    np.add.at(moment, first, -weight[:, None, None] * vector[:, :, None] * vector[:, None, :])
    size, axes = np.linalg.eigh(moment)
    sees = size > SINGULAR * size[:, -1:]
    inverse = np.where(sees, 1.0 / np.where(sees, size, 1.0), 0.0)
    correction = np.einsum("nik,nk,njk->nij", axes, inverse, axes)
    correction[rigid] = 0.0
    blind = np.where(rigid, 0, dim - sees.sum(axis=1))
    normal = np.where((blind == 1)[:, None], axes[:, :, 0], 0.0)
    return correction, normal, np.where(blind <= 1, 1.0, 0.0)
