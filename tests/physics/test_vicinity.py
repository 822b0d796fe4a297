"""Which points lie near others: none that is near is missed, none that is far is taken."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from warpsph.physics.vicinity import cells_beside


@given(st.integers(0, 2**32 - 1), st.sampled_from([2, 3]), st.floats(1e-3, 10.0))
def test_all_near_points_are_taken_and_no_far_ones(seed, dim, edge):
    rng = np.random.default_rng(seed)
    points, others = rng.uniform(-20.0, 20.0, (200, dim)), rng.uniform(-20.0, 20.0, (10, dim))
    taken = cells_beside(points, others, edge)
    distance, _ = cKDTree(others).query(points)
    assert taken[distance < edge].all()
    assert not taken[distance > 2.0 * edge * np.sqrt(dim)].any()


@pytest.mark.parametrize(("points", "others"), [(0, 3), (3, 0)])
def test_nothing_is_near_nothing(points, others):
    assert cells_beside(np.zeros((points, 2)), np.zeros((others, 2)), 1.0).tolist() == [False] * points
