"""Faces of bodies too small to say which way is across them do not depend on rounding."""

import numpy as np
import pytest

from warpsph.sampling.faces import faces_of
from warpsph.scene.shapes import Box

REACH = 3.0
"""Of the default kernel, in spacings."""


def lattice(*cells):
    return np.stack(np.meshgrid(*[np.arange(n) + 0.5 for n in cells], indexing="ij"), axis=-1).reshape(
        -1, len(cells)
    )


def faces(points, cells):
    return faces_of(points, Box(min=(0.0,) * len(cells), max=tuple(map(float, cells))), 1.0, REACH)


@pytest.mark.parametrize("cells", [(3, 3), (4, 4), (5, 5), (4, 9), (4, 4, 4), (4, 4, 9), (3, 3, 3)])
def test_sides_survive_rounding(cells):
    points = lattice(*cells)
    shift = np.random.default_rng(1).uniform(-1e-12, 1e-12, points.shape)
    exact, off = faces(points, cells), faces(points + shift, cells)
    assert np.array_equal(exact.owner, off.owner)
    # Which of its two faces a particle in the middle counts first is a matter of rounding.
    for owner in range(len(points)):
        sides = [set(map(tuple, (one.side[one.owner == owner] + 10.0).round(6))) for one in (exact, off)]
        assert sides[0] == sides[1]


@pytest.mark.parametrize(("cells", "double"), [((5, 5), 4), ((3, 12), 36), ((6, 6), 0)])
def test_two_faces_need_one_way_across(cells, double):
    """In the middle of a square there is none: of five cells four particles have one, which are off the middle."""
    points = lattice(*cells)
    assert len(faces(points, cells).owner) == len(points) + double
