"""The level is the depth of the pool, wherever the gauge stands and whatever else is in the air."""

import math

import numpy as np
import pytest
from particles import SPACING, disordered, fluid, frame_of, lattice, probe_of, scene_with, tank_walls, wall

DEPTH = 1.0


def gauge(at, dimension=2, **changes):
    return probe_of(scene_with({"type": "water_level", "at": list(at)}, dimension, **changes))


def pool(depth=DEPTH, dimension=2, width=2.0):
    across = [width] * (dimension - 1)
    low = [0.0] * dimension
    return lattice(low, [*across, depth]), wall(tank_walls(low, [*across, 3.0]))


@pytest.mark.parametrize("at", [(1.0,), (1.03,), (0.0,), (2.0,), (0.02,), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)])
def test_flat_pool_has_its_depth_also_at_a_wall_and_in_a_corner(at):
    """The kernel sums differ from the integrals by quadrature errors, a few percent of a spacing."""
    water, walls = pool(dimension=len(at) + 1)
    probe = gauge(at, dimension=len(at) + 1)
    assert probe.columns == ("probe.level[m]",)
    assert probe.evaluate(frame_of(fluid(water), walls))[0] == pytest.approx(DEPTH, abs=0.04 * SPACING)


def test_level_follows_the_surface_within_a_spacing():
    """Raising the pool by a tenth of a spacing raises the level by as much."""
    levels = []
    for lift in np.linspace(0.0, 1.0, 11) * SPACING:
        water, walls = pool()
        water[:, 1] *= (DEPTH + lift) / DEPTH
        levels.append(gauge((1.0,)).evaluate(frame_of(fluid(water), walls))[0] - lift)
    np.testing.assert_allclose(levels, DEPTH, atol=0.1 * SPACING)


def test_disorder_does_not_bias_the_level():
    water, walls = pool()
    levels = [
        gauge((1.0,)).evaluate(frame_of(fluid(disordered(water, 0.2, seed)), walls))[0] for seed in range(20)
    ]
    assert np.mean(levels) == pytest.approx(DEPTH, abs=0.05 * SPACING)


@pytest.mark.parametrize("layers", [1, 2, 3])
def test_thin_film_is_seen(layers):
    """Down to a single layer of particles, whose kernel sum is cut short on both sides."""
    water, walls = pool(depth=layers * SPACING)
    level = gauge((1.0,)).evaluate(frame_of(fluid(water), walls))[0]
    assert level == pytest.approx(layers * SPACING, abs=0.2 * SPACING)


def test_spray_above_the_surface_does_not_count():
    water, walls = pool()
    spray = lattice([0.9, 1.6], [1.2, 1.9])
    level = gauge((1.0,)).evaluate(frame_of(fluid(np.concatenate([water, spray])), walls))[0]
    assert level == pytest.approx(DEPTH, abs=0.04 * SPACING)


@pytest.mark.parametrize("drop", [True, False], ids=["drop falling", "nothing"])
def test_dry_gauge_reads_its_bed(drop):
    _, walls = pool()
    water = lattice([0.8, 1.0], [1.2, 1.4]) if drop else lattice([0.0, 0.0], [0.3, 0.3])
    level = gauge((1.0,)).evaluate(frame_of(fluid(water), walls))[0]
    assert level == pytest.approx(0.0, abs=0.3 * SPACING)


def test_level_above_a_hollow_obstacle_on_the_floor():
    """The bed is the obstacle's lid: no fluid stands on the floor inside."""
    obstacle = lattice([0.5, 0.0], [1.5, 1.0])
    hollow = np.all((obstacle > [0.8, 0.0]) & (obstacle < [1.2, 0.7]), axis=1)
    _, walls = pool()
    solid = np.concatenate([walls.fields["position"], obstacle[~hollow]])
    water = lattice([0.0, 1.0], [2.0, 1.5])
    level = gauge((1.0,)).evaluate(frame_of(fluid(water), wall(solid)))[0]
    assert level == pytest.approx(1.5, abs=0.04 * SPACING)


def test_full_vessel_reads_its_lid():
    water = lattice([0.0, 0.0], [2.0, 1.0])
    cells = lattice([-0.3, -0.3], [2.3, 1.3])
    shell = cells[~np.all((cells > 0.0) & (cells < [2.0, 1.0]), axis=1)]
    level = gauge((1.0,)).evaluate(frame_of(fluid(water), wall(shell)))[0]
    assert level == pytest.approx(1.0, abs=0.3 * SPACING)


def test_without_walls_the_column_starts_at_its_lowest_point_and_without_fluid_there_is_none():
    block = fluid(lattice([0.0, 2.0], [2.0, 3.0]))
    assert gauge((1.0,)).evaluate(frame_of(block))[0] == pytest.approx(3.0, abs=0.04 * SPACING)
    assert math.isnan(gauge((5.0,)).evaluate(frame_of(block))[0])


def test_gauge_follows_gravity():
    """With gravity along +x the surface is the lowest x of the fluid."""
    water, walls = pool()
    turn = np.array([[0.0, 1.0], [-1.0, 0.0]])
    turned = frame_of(fluid(water @ turn), wall(walls.fields["position"] @ turn))
    probe = gauge((1.0,), gravity=[9.81, 0.0])
    assert probe.evaluate(turned)[0] == pytest.approx(-DEPTH, abs=0.04 * SPACING)


def test_neighbours_across_a_periodic_boundary_count():
    block = fluid(lattice([0.0, 0.0], [2.0, 1.0]))
    probe = gauge((0.0,), domain={"periodic": {"x": [0.0, 2.0]}})
    assert probe.evaluate(frame_of(block))[0] == pytest.approx(1.0, abs=0.04 * SPACING)
