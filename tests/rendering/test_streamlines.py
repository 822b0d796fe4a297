"""Streamlines: the velocity between particles, and lines that a picture shows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from warpsph.rendering.cache import ParticleCache, RenderedFrame, RenderedSet
from warpsph.rendering.colour import WATER, ColourScale
from warpsph.rendering.errors import RenderError
from warpsph.rendering.movie import render
from warpsph.rendering.plane import PlaneView
from warpsph.rendering.streamlines import velocity_on_grid

SPACING = 0.02


def ring(inner: float, outer: float) -> np.ndarray:
    """Lattice points (n, 2) between two radii."""
    axis = np.arange(-outer, outer + SPACING / 2, SPACING)
    points = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    radius = np.linalg.norm(points, axis=1)
    return points[(radius >= inner) & (radius <= outer)]


def test_grid_carries_a_rotation_and_leaves_out_where_there_is_no_fluid() -> None:
    position = ring(0.2, 0.5)
    rotation = np.array([[0.0, 1.0], [-1.0, 0.0]])
    x, y, velocity = velocity_on_grid(position, position @ rotation, SPACING)
    points = np.stack(np.meshgrid(x, y), axis=-1)
    radius = np.linalg.norm(points, axis=-1)
    assert np.isnan(velocity[radius < 0.2 - 2.0 * SPACING]).all()
    # Inside, the weights are those of a lattice, symmetric about the point: a linear field comes back.
    inside = (radius > 0.2 + 2.0 * SPACING) & (radius < 0.5 - 2.0 * SPACING)
    np.testing.assert_allclose(velocity[inside], (points @ rotation)[inside], atol=1e-3)


def test_lines_are_drawn_where_fluid_flows_and_only_there() -> None:
    position = np.pad(ring(0.0, 0.5), ((0, 0), (0, 1)))
    speed = np.linalg.norm(position, axis=1)
    turning = position @ np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    water = RenderedSet("water", "fluid", position, SPACING, speed, turning)
    extent = (np.array([-1.0, -1.0, 0.0]), np.array([1.0, 1.0, 0.0]))
    scale = ColourScale(0.0, 1.0, WATER, "velocity [m/s]")
    views = [PlaneView(scale, extent, (640, 360), streamlines=flag) for flag in (True, False)]
    lines, plain = (view.draw(RenderedFrame(0.0, (water,))).astype(int) for view in views)
    changed = np.abs(lines - plain).max(axis=-1) > 40
    is_water = (plain < 250).any(axis=-1)
    assert changed.sum() > 200
    assert changed[is_water].sum() > 0.95 * changed.sum()
    still = replace(water, velocity=np.zeros_like(turning))
    np.testing.assert_array_equal(views[0].draw(RenderedFrame(0.0, (still,))), plain)


def test_a_cache_reads_velocities_where_they_are_asked_for(write_run: Callable[..., Path]) -> None:
    cache = ParticleCache(write_run(2))
    (water,) = cache.frame(1, "velocity", velocities=True).of_kind("fluid")
    assert water.velocity is not None
    np.testing.assert_allclose(water.velocity, np.tile([1.0, 0.0, 0.0], (len(water.position), 1)))
    (bare,) = cache.frame(1, "velocity").of_kind("fluid")
    assert bare.velocity is None


def test_streamlines_in_space_are_refused(write_run: Callable[..., Path]) -> None:
    with pytest.raises(RenderError, match="in two dimensions"):
        render(write_run(3), frames="0", streamlines=True)
