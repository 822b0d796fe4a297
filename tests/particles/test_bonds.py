"""Bonds against brute force, and corrections against what they promise: linear fields are exact."""

import numpy as np
import pytest

from warpsph.particles.bonds import make_bonds

SPACING, RADIUS = 0.1, 0.16


def weights(length: np.ndarray) -> np.ndarray:
    """Any negative, smooth slope that vanishes at the radius."""
    return -((1.0 - length / RADIUS) ** 2) / SPACING**4


def cloud(dim: int, count: int = 60, jitter: float = 0.3) -> np.ndarray:
    side = round(count ** (1.0 / dim))
    axes = np.meshgrid(*[SPACING * (np.arange(side) + 0.5)] * dim, indexing="ij")
    points = np.stack([axis.ravel() for axis in axes], axis=1)
    return points + np.random.default_rng(5).uniform(-jitter, jitter, points.shape) * SPACING


def bonds_of(*bodies: np.ndarray, periods=None):
    total, dim = sum(map(len, bodies)), bodies[0].shape[1]
    return make_bonds(
        np.concatenate(bodies),
        np.repeat(np.arange(len(bodies)), [len(body) for body in bodies]),
        np.full(total, SPACING**dim),
        np.zeros(total, dtype=bool),
        RADIUS,
        periods or [0.0] * dim,
        weights,
    )


def rows_of(bonds) -> list[set[int]]:
    return [set(row[:n].tolist()) for row, n in zip(bonds.neighbour, bonds.count, strict=True)]


@pytest.mark.parametrize("dim", [2, 3])
def test_neighbours_are_those_of_brute_force(dim):
    points = cloud(dim)
    distance = np.linalg.norm(points[:, None] - points[None], axis=2)
    expected = [set(np.flatnonzero((row < RADIUS) & (row > 0.0)).tolist()) for row in distance]
    assert rows_of(bonds_of(points)) == expected


@pytest.mark.parametrize("axis", [0, 1])
def test_neighbours_across_a_period_are_those_of_all_images(axis):
    points, period = cloud(2), 0.8
    points[:, axis] += 0.37  # the body lies across the edge of the period
    images = [points + period * k * np.eye(2)[axis] for k in (-1, 0, 1)]
    vectors = np.stack([points[:, None] - image[None] for image in images])
    distance = np.linalg.norm(vectors, axis=3)
    nearest = distance.argmin(axis=0)
    near = (distance.min(axis=0) < RADIUS) & ~np.eye(len(points), dtype=bool)
    bonds = bonds_of(points, periods=[period if k == axis else 0.0 for k in range(2)])
    assert rows_of(bonds) == [set(np.flatnonzero(row).tolist()) for row in near]
    for i, n in enumerate(bonds.count):
        for b, vector in zip(bonds.neighbour[i, :n], bonds.vector[i, :n], strict=True):
            assert vector == pytest.approx(vectors[nearest[i, b], i, b], abs=1e-15)


def test_bodies_that_touch_are_not_bonded():
    first = cloud(2)
    second = first + np.array([0.5 * SPACING, 0.0])
    bonds = bonds_of(first, second)
    half = len(first)
    assert all(max(row) < half for row in rows_of(bonds)[:half])
    assert all(min(row) >= half for row in rows_of(bonds)[half:])
    assert bonds.count[:half].tolist() == bonds.count[half:].tolist()


def test_each_pair_stands_in_both_rows():
    rows = rows_of(bonds_of(cloud(3)))
    assert all(a in rows[b] for a, row in enumerate(rows) for b in row)


@pytest.mark.parametrize("dim", [2, 3])
def test_the_corrected_gradient_of_a_linear_field_is_exact(dim):
    """sum_b w_ab (u_b - u_a) (x) L_a X_ab = grad u, at the surface as well."""
    points = cloud(dim, count=125)
    gradient = np.random.default_rng(7).normal(size=(dim, dim))
    field = points @ gradient.T
    bonds = bonds_of(points)
    difference = field[bonds.neighbour] - field[:, None]
    found = np.einsum("nm,nmi,nmj->nij", bonds.weight, difference, bonds.vector) @ bonds.correction
    full = ~bonds.thin
    assert full.mean() > 0.95
    assert found[full] == pytest.approx(np.tile(gradient, (full.sum(), 1, 1)), abs=1e-11)


def plane(normal_axis: int) -> np.ndarray:
    flat = cloud(2, jitter=0.0)
    return np.insert(flat, normal_axis, 0.2, axis=1)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_plane_in_three_dimensions_knows_its_normal(axis):
    bonds = bonds_of(plane(axis))
    assert bonds.thin.all()
    assert bonds.seen.all()
    assert np.abs(bonds.normal) == pytest.approx(np.tile(np.eye(3)[axis], (len(bonds.count), 1)), abs=1e-12)
    # The correction acts in the plane alone.
    assert np.einsum("nij,nj->ni", bonds.correction, bonds.normal) == pytest.approx(0.0, abs=1e-9)


def test_a_tilted_plane_is_recognised_as_well():
    c, s = np.cos(0.6), np.sin(0.6)
    turn = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    bonds = bonds_of(plane(2) @ turn.T)
    assert bonds.thin.all()
    assert np.abs(bonds.normal @ turn[:, 2]) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize(("dim", "seen"), [(2, 1.0), (3, 0.0)])
def test_a_chain_is_a_plane_in_2d_and_less_in_3d(dim, seen):
    chain = np.zeros((10, dim))
    chain[:, 0] = SPACING * np.arange(10)
    bonds = bonds_of(chain)
    assert bonds.thin.all()
    assert (bonds.seen == seen).all()
    assert (np.abs(bonds.normal).sum(axis=1) == seen).all()
    assert np.isfinite(bonds.correction).all()


def test_an_isolated_particle_sees_nothing_and_breaks_nothing():
    bonds = bonds_of(np.vstack([cloud(2), [[5.0, 5.0]]]))
    assert bonds.count[-1] == 0
    assert bonds.seen[-1] == 0.0
    assert (bonds.correction[-1] == 0.0).all()
    assert not bonds.thin[:-1].any()
