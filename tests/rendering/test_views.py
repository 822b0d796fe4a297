"""Frames in the plane and in space."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from warpsph.rendering.cache import RenderedFrame, RenderedSet
from warpsph.rendering.colour import WATER, ColourScale
from warpsph.rendering.plane import PlaneView
from warpsph.rendering.space import SpaceView

SCALE = ColourScale(0.0, 1.0, WATER, "velocity [m/s]")
EXTENT = (np.full(3, -0.3), np.array([1.3, 1.3, 1.0]))
SIZE = (320, 180)
SHADE = 60
"""Levels of 255 by which a body may darken what lies around it."""


def shown(view: PlaneView | SpaceView, body: RenderedSet, *others: RenderedSet) -> np.ndarray:
    """Pixels (height, width) that the body itself, not its shade, changes in a picture of the others."""
    with_body, without = view.draw(RenderedFrame(0.5, (body, *others))), view.draw(RenderedFrame(0.5, others))
    assert with_body.shape == (SIZE[1], SIZE[0], 3)
    return np.any(np.abs(with_body.astype(int) - without) > SHADE, axis=-1)


def moved(particles: RenderedSet, x: float, y: float, z: float) -> RenderedSet:
    return replace(particles, position=particles.position + np.array([x, y, z]))


def as_wall(particles: RenderedSet, name: str) -> RenderedSet:
    return replace(particles, name=name, kind="boundary", value=None)


def in_plane(particles: RenderedSet) -> RenderedSet:
    """A slice of the particles, laid into the plane z = 0 with the height along y."""
    slab = particles.position[np.abs(particles.position[:, 1] - 0.05) < 1e-6][:, [0, 2, 1]] * [1.0, 1.0, 0.0]
    return replace(particles, position=slab, value=None if particles.value is None else slab[:, 0])


@pytest.fixture
def space() -> SpaceView:
    return SpaceView(SCALE, EXTENT, SIZE, up_axis=2)


@pytest.fixture
def plane() -> PlaneView:
    return PlaneView(SCALE, EXTENT, SIZE)


def test_plane_has_the_same_scale_along_both_axes(plane: PlaneView, block: RenderedSet) -> None:
    rows, columns = np.nonzero(shown(plane, in_plane(block)))
    assert np.ptp(columns) == pytest.approx(np.ptp(rows), abs=2)


def test_plane_draws_up_upwards_and_right_to_the_right(plane: PlaneView, block: RenderedSet) -> None:
    water = in_plane(block)
    rows, columns = np.nonzero(shown(plane, water))
    higher_rows, _ = np.nonzero(shown(plane, moved(water, 0.0, 0.4, 0.0)))
    _, right_columns = np.nonzero(shown(plane, moved(water, 0.4, 0.0, 0.0)))
    assert higher_rows.mean() < rows.mean()
    assert right_columns.mean() > columns.mean()


def test_walls_of_a_tank_do_not_hide_the_water(
    space: SpaceView, plane: PlaneView, tank: RenderedSet, block: RenderedSet
) -> None:
    assert shown(space, block, tank).sum() > 0.95 * shown(space, block).sum()
    assert shown(plane, in_plane(block), in_plane(tank)).sum() > 0.95 * shown(plane, in_plane(block)).sum()


def test_obstacle_in_front_hides_the_water(space: SpaceView, tank: RenderedSet, block: RenderedSet) -> None:
    screen = [as_wall(moved(block, 0.2, -0.6, z), f"screen_{z}") for z in (0.0, 0.4)]
    assert shown(space, block, tank, *screen).sum() < 0.5 * shown(space, block, tank).sum()


def test_walls_that_moved_are_drawn_where_they_are(space: SpaceView, block: RenderedSet) -> None:
    gate = as_wall(moved(block, 1.0, 0.0, 0.0), "gate")
    raised = RenderedFrame(0.5, (block, moved(gate, 0.0, 0.0, 0.4)))
    before = space.draw(RenderedFrame(0.5, (block, gate)))
    after = space.draw(raised)
    assert not np.array_equal(before, after)
    np.testing.assert_array_equal(after, SpaceView(SCALE, EXTENT, SIZE, up_axis=2).draw(raised))


def test_colour_follows_the_value_in_the_same_way_in_every_frame(
    plane: PlaneView, block: RenderedSet
) -> None:
    water = in_plane(block)
    still, fast = (replace(water, value=np.full(len(water.position), speed)) for speed in (0.0, 1.0))
    inside = shown(plane, water)
    dark, light = (plane.draw(RenderedFrame(0.5, (body,)))[inside].mean() for body in (still, fast))
    assert light > dark + 50


def test_fluid_without_the_field_is_still_drawn(
    space: SpaceView, plane: PlaneView, block: RenderedSet
) -> None:
    assert shown(space, replace(block, value=None)).any()
    assert shown(plane, replace(in_plane(block), value=None)).any()
