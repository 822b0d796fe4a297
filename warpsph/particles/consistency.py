"""Gradients of scattered particles that are consistent with their integration.

A uniform stress must exert no force inside a body. With the gradient H_a = sum_b (u_b - u_a) (x) d_ab, the stresses P_a
exert the forces V_a f_a = sum_b (V_a P_a d_ab - V_b P_b d_ba); so for every particle inside

    sum_b (V_a d_ab - V_b d_ba) = 0,

as the faces of a closed surface sum up to zero. The corrected kernel gradients d_ab = w_ab L_a X_ab obey it on a
lattice, and miss it where particles are scattered. Here they change as little as possible, so that it holds and the
gradient of a linear field stays exact: V_a d_ab += o_ab r_ab, o_ab = V_a |w_ab|, with the misfit r_ab of the
weighted linear fit of a field mu around a, the same fit that gives H. Then the misfits do no work on linear fields,
and mu solves
K mu = -(the sums above), where K is the symmetric operator of the misfits' energy. The condition is that of
variationally consistent integration (Chen, Hillman & Rueter 2013); this way to meet it, which keeps one gradient for
strain and force and with it the energy, is worked out here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array, diags_array
from scipy.sparse.linalg import cg, splu

from warpsph.particles.bonds import Bonds, nearest_image, pairs_within

SAME_VECTOR = 1e-3
"""Bond vectors that differ by less are one, in spacings."""
SURFACE_REACH = 1.9
"""Radius of the neighbourhood that tells surface from inside, in spacings: with the corners of the cells around."""
FREE_VIEW = 0.65
"""Cosine of the half angle of the cone without neighbours that a particle at a surface looks into. Inside of a lattice
it is at least 0.88, and about 0.8 with a jitter of a fifth of the spacing; on a face it is 0, and 0.4 with jitter."""
VIEWS = {2: 32, 3: 128}
"""Directions that are tried."""
LARGEST_FACTORED = 20_000


@dataclass(frozen=True)
class Gradients:
    """Gradient vectors [1/m] of both ends of every bond, in the rows of the bonds.

    own: (n, m, dim) d_ab; other: (n, m, dim) -V_b / V_a d_ba, so that f_a = sum_b (P_a own_ab + P_b other_ab).
    """

    own: np.ndarray
    other: np.ndarray


def is_scattered(bonds: Bonds, body: slice, radius: float, spacing: float) -> bool:
    """Whether the deformable particles of a body have more different bond vectors than a lattice within the radius."""
    present = np.arange(bonds.neighbour.shape[1]) < bonds.ends[body, :1]
    vectors = np.unique(np.rint(bonds.vector[body][present] / (SAME_VECTOR * spacing)), axis=0)
    dim, reach = bonds.vector.shape[2], int(np.ceil(radius / spacing))
    steps = np.stack(np.meshgrid(*[np.arange(-reach, reach + 1)] * dim), axis=-1).reshape(-1, dim)
    lattice = np.linalg.norm(steps, axis=1) <= radius / spacing + SAME_VECTOR
    return len(vectors) > int(lattice.sum()) - 1


def consistent_gradients(
    position: np.ndarray,
    body: np.ndarray,
    volume: np.ndarray,
    rigid: np.ndarray,
    bonds: Bonds,
    spacing: float,
    periods: Sequence[float],
) -> Gradients:
    """Gradients of the bonds for which a uniform stress exerts no force on particles inside.

    Args:
        position: of all particles at rest (n, dim) [m].
        body: number of the body of each particle (n,).
        volume: of all particles (n,) [m^dim].
        rigid: whether each particle has no strain of its own, shape (n,).
        periods: length of each periodic axis [m], zero along the others.
    """
    particles, dim = len(volume), bonds.vector.shape[2]
    first = np.repeat(np.arange(particles), bonds.count)
    present = np.arange(bonds.neighbour.shape[1]) < bonds.count[:, None]
    second, vector, weight = bonds.neighbour[present], bonds.vector[present], bonds.weight[present]
    twin = _reverse(first, second)
    fitted = weight[:, None] * np.einsum("mij,mj->mi", bonds.correction[first], vector)
    area = volume[first, None] * fitted
    open_faces = np.zeros((particles, dim))
    np.add.at(open_faces, first, area - area[twin])
    misfit = _misfit(first, second, vector, fitted, particles)
    strength = volume[first] * np.abs(weight) * ~rigid[first]
    inside = ~rigid & ~sees_out(position, body, spacing, periods)
    field = _solve(misfit, strength, open_faces, inside)
    area += strength[:, None] * (misfit @ field)
    own = np.zeros_like(bonds.vector)
    other = np.zeros_like(bonds.vector)
    own[present] = area / volume[first, None]
    other[present] = -area[twin] / volume[first, None]
    return Gradients(own, other)


def _reverse(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Place of the bond b-a of every bond a-b."""
    size = int(first.max(initial=0)) + 1
    keys = first * size + second
    order = np.argsort(keys)
    return order[np.searchsorted(keys[order], second * size + first)]


def _misfit(
    first: np.ndarray, second: np.ndarray, vector: np.ndarray, fitted: np.ndarray, particles: int
) -> csr_array:
    """Operator (bonds, n): of a field f, (f_a - f_b) - grad f_a . X_ab with the fitted gradient."""
    bonds, shape = np.arange(len(first)), (len(first), particles)
    ones = np.ones(len(first))
    difference = csr_array((ones, (bonds, first)), shape=shape) - csr_array(
        (ones, (bonds, second)), shape=shape
    )
    gradients = [
        csr_array((-fitted[:, k], (first, bonds)), shape=shape[::-1]) @ difference
        for k in range(vector.shape[1])
    ]
    fit = sum(diags_array(vector[:, k]) @ gradient[first] for k, gradient in enumerate(gradients))
    return csr_array(difference - fit)


def sees_out(position: np.ndarray, body: np.ndarray, spacing: float, periods: Sequence[float]) -> np.ndarray:
    """Whether a particle has a cone without neighbours of its body before it, as at a surface, shape (n,)."""
    lengths = np.asarray(periods)
    none_rigid = np.zeros(len(position), dtype=bool)
    first, second = pairs_within(position, body, none_rigid, SURFACE_REACH * spacing, lengths)
    vector = nearest_image(position[second] - position[first], lengths)
    vector /= np.linalg.norm(vector, axis=1, keepdims=True)
    narrowest = np.ones(len(position))
    for direction in _directions(position.shape[1]):
        nearest = np.full(len(position), -1.0)
        np.maximum.at(nearest, first, vector @ direction)
        narrowest = np.minimum(narrowest, nearest)
    return narrowest < FREE_VIEW


def _directions(dim: int) -> np.ndarray:
    """Unit vectors spread evenly; in space along a Fibonacci spiral."""
    count = VIEWS[dim]
    k = np.arange(count)
    if dim == 2:
        return np.column_stack([np.cos(2.0 * np.pi * k / count), np.sin(2.0 * np.pi * k / count)])
    height, turn = (2.0 * k + 1.0) / count - 1.0, k * np.pi * (3.0 - np.sqrt(5.0))
    radius = np.sqrt(1.0 - height**2)
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), height])


def _solve(misfit: csr_array, strength: np.ndarray, open_faces: np.ndarray, inside: np.ndarray) -> np.ndarray:
    """The field (n, dim), zero outside of the inside, with K field = -open_faces there."""
    field = np.zeros_like(open_faces)
    chosen = np.flatnonzero(inside)
    if len(chosen) == 0:
        return field
    part = csr_array(misfit[:, chosen])
    matrix = csr_array(part.T @ (diags_array(strength) @ part))
    right = -open_faces[chosen]
    if len(chosen) <= LARGEST_FACTORED:
        field[chosen] = splu(matrix.tocsc()).solve(right)
        return field
    scale = diags_array(1.0 / matrix.diagonal())
    for k in range(right.shape[1]):
        field[chosen, k], _ = cg(matrix, right[:, k], rtol=1e-13, M=scale)
    return field
