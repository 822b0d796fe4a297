"""Voids are the empty balls between particles."""

import numpy as np
import pytest
from particles import SPACING, fluid, frame_of, lattice, probe_of, scene_with, wall

VOIDS = {"type": "voids"}
AROUND = {"type": "voids", "region": {"min": [0.0, 0.0], "max": [1.5, 1.5]}}


def with_hole(cells: int) -> np.ndarray:
    """A square of 15 x 15 particles without the `cells` x `cells` in its middle."""
    position = lattice([0.0, 0.0], [1.5, 1.5])
    return position[np.abs(position - 0.75).max(axis=1) > 0.5 * cells * SPACING]


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_lattice_leaves_half_the_diagonal_of_a_cell(dimension):
    water = fluid(lattice([0.0] * dimension, [1.0] * dimension))
    probe = probe_of(scene_with(VOIDS, dimension))
    assert probe.columns == ("probe.radius[1]", f"probe.volume[m{dimension}]")
    assert probe.evaluate(frame_of(water)) == pytest.approx((0.5 * dimension**0.5, 0.0))


def test_one_particle_that_is_missing_leaves_a_ball_of_one_spacing():
    assert probe_of(scene_with(VOIDS)).evaluate(frame_of(fluid(with_hole(1)))) == pytest.approx((1.0, 0.0))


@pytest.mark.parametrize(("size", "cells"), [(1.5, 14.0), (1.59, 8.0), (2.1, 0.0)])
def test_a_hole_of_three_by_three(size, cells):
    """Its largest ball touches (2, 0), (0, 2) ..., between which lies a square of 8 cells. The ball through (2, 0),
    (2, 1), (1, 2) and (0, 2) has the radius sqrt(2.5) = 1.58 and an area of 1.5 cells, four times."""
    probe = probe_of(scene_with(VOIDS | {"size": size}))
    expected = (2.0, cells * SPACING**2)
    assert probe.evaluate(frame_of(fluid(with_hole(3)))) == pytest.approx(expected)


def test_a_hole_across_the_end_of_a_period():
    position = np.mod(with_hole(3) + np.array([0.73, 0.21]), 1.5)
    periodic = {"domain": {"periodic": {"x": (0.0, 1.5), "y": (0.0, 1.5)}}, "boundaries": {}}
    values = probe_of(scene_with(VOIDS, **periodic)).evaluate(frame_of(fluid(position)))
    assert values == pytest.approx((2.0, 14.0 * SPACING**2))


def test_particles_of_walls_fill_a_hole_and_their_inside_does_not_count():
    """A hollow obstacle: a ring of wall particles, one layer, around 3 x 3 empty cells."""
    water = with_hole(5)
    ring = with_hole(3)
    ring = ring[np.abs(ring - 0.75).max(axis=1) < 2.5 * SPACING]
    values = probe_of(scene_with(VOIDS)).evaluate(frame_of(fluid(water), wall(ring)))
    assert values == pytest.approx((0.5**0.5, 0.0))


def test_only_balls_in_the_region_count():
    free = np.concatenate([with_hole(1), [[3.0, 0.75]]])
    assert probe_of(scene_with(VOIDS)).evaluate(frame_of(fluid(free)))[0] > 5.0
    assert probe_of(scene_with(AROUND)).evaluate(frame_of(fluid(free)))[0] == pytest.approx(1.0)
