"""Evening out where particles of different origin meet."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial import cKDTree

from warpsph.sampling.distance import signed_distance
from warpsph.sampling.packing import away_from, filled, pushed_inside, thinned
from warpsph.scene.shapes import Box, Polygon

POINTS = arrays(np.float64, st.tuples(st.integers(1, 40), st.just(2)), elements=st.floats(0.0, 3.0))


def square_lattice(cells: int) -> np.ndarray:
    return np.stack(np.meshgrid(*[np.arange(cells) + 0.5] * 2), axis=-1).reshape(-1, 2)


def everywhere(points: np.ndarray) -> np.ndarray:
    return np.ones(len(points), dtype=bool)


@given(POINTS)
def test_thinned_points_keep_their_distance_and_cover_those_left_out(points: np.ndarray) -> None:
    kept = thinned(points, 0.5)
    assert np.array_equal(kept[0], points[0])
    assert len(cKDTree(kept).query_pairs(0.5 - 1e-12)) == 0
    assert cKDTree(kept).query(points)[0].max() <= 0.5


@given(POINTS, POINTS)
def test_away_from_leaves_out_exactly_the_near_ones(points: np.ndarray, others: np.ndarray) -> None:
    distances = np.linalg.norm(points[:, None] - others[None], axis=2).min(axis=1)
    kept = away_from(points, others, 0.5)
    assert np.array_equal(kept, points[distances >= 0.5])


def test_a_lattice_has_no_holes() -> None:
    lattice = square_lattice(6)
    assert len(filled(lattice, 1.0, everywhere)) == len(lattice)


def test_a_missing_particle_is_put_back() -> None:
    lattice = square_lattice(6)
    missing = lattice[14]
    repaired = filled(np.delete(lattice, 14, axis=0), 1.0, everywhere)
    assert len(repaired) == len(lattice)
    assert repaired[-1] == pytest.approx(missing)


def test_a_hole_outside_the_region_stays() -> None:
    lattice = np.delete(square_lattice(6), 14, axis=0)
    assert len(filled(lattice, 1.0, lambda points: points[:, 0] > 4.0)) == len(lattice)


@pytest.mark.parametrize("points", [np.zeros((1, 2)), np.arange(5.0)[:, None] * [1.0, 1.0]])
def test_too_few_points_or_a_line_of_them_enclose_nothing(points: np.ndarray) -> None:
    assert filled(points, 0.1, everywhere) is points


def test_points_near_the_surface_are_moved_down_to_the_depth() -> None:
    box = Box(min=(0.0, 0.0), max=(4.0, 4.0))
    points = np.array([[2.0, 0.1], [0.05, 0.2], [2.0, 2.0]])
    moved, fits = pushed_inside(points, lambda at: signed_distance(box, at), 0.25, 1.0)
    assert fits.all()
    assert signed_distance(box, moved) == pytest.approx([-0.25, -0.25, -2.0], abs=1e-9)
    assert moved[0] == pytest.approx([2.0, 0.25])


def test_points_in_a_narrow_wedge_do_not_fit() -> None:
    wedge = Polygon(points=((0.0, 0.0), (10.0, -0.5), (10.0, 0.5)))
    points = np.array([[0.5, 0.0], [9.0, 0.4]])
    _, fits = pushed_inside(points, lambda at: signed_distance(wedge, at), 0.25, 1.0)
    assert list(fits) == [False, True]
