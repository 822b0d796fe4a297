"""A gauge in a wall reads the mean of the wall particles about it, and moves with the wall."""

import numpy as np
import pytest
from particles import frame_of, lattice, probe_of, scene_with, tank_walls, wall

from warpsph.scene.errors import SceneError

AT = [0.0, 0.5]


def gauge(radius=0.2, at=AT):
    return probe_of(scene_with({"type": "wall_pressure", "boundary": "tank", "at": at, "radius": radius}))


def walls(pressure, shift=(0.0, 0.0), order=slice(None)):
    position = tank_walls([0.0, 0.0], [2.0, 2.0])
    ids = np.arange(len(position))
    moved = (position + np.array(shift))[order]
    return frame_of(wall(moved, id=ids[order], pressure=pressure(position)[order]))


def depth(position):
    """Hydrostatic pressure below y = 2."""
    return 9810.0 * (2.0 - position[:, 1])


def test_hydrostatic_pressure_is_that_at_the_centre():
    """The particles lie symmetrically about the centre's height, so the mean of a linear field is exact."""
    probe = gauge()
    probe.start(walls(depth))
    assert probe.columns == ("probe.pressure[Pa]",)
    assert probe.evaluate(walls(depth))[0] == pytest.approx(9810.0 * 1.5, rel=1e-12)


def test_only_particles_within_the_radius_count():
    def far_noise(position):
        return np.where(np.linalg.norm(position - AT, axis=1) <= 0.2, 5.0, 1e9)

    probe = gauge()
    probe.start(walls(far_noise))
    assert probe.evaluate(walls(far_noise))[0] == pytest.approx(5.0, abs=1e-9)


def test_dry_wall_reads_zero():
    probe = gauge()
    dry = walls(lambda position: np.zeros(len(position)))
    probe.start(dry)
    assert probe.evaluate(dry) == (0.0,)


def test_gauge_moves_with_its_wall_whatever_the_order_of_the_particles():
    probe = gauge()
    probe.start(walls(depth))
    shuffled = np.random.default_rng(0).permutation(len(tank_walls([0.0, 0.0], [2.0, 2.0])))
    moved = walls(depth, shift=(3.0, 1.0), order=shuffled)
    assert probe.evaluate(moved)[0] == pytest.approx(9810.0 * 1.5, rel=1e-12)


def test_gauge_too_small_to_hold_a_particle_is_refused_with_the_radius_that_would_do():
    with pytest.raises(SceneError, match=r"probes\.probe\.radius.*\n.*0\.01\n.*at least 0\.0707107 m"):
        gauge(radius=0.01).start(walls(depth))


def test_gauge_in_a_floor_reads_the_pressure_at_its_surface():
    """Three layers lie within the radius; half a spacing of hydrostatics from the first one gives rho g H exactly."""
    probe = gauge(radius=0.3, at=[1.0, 0.0])
    probe.start(walls(depth))
    assert probe.evaluate(walls(depth))[0] == pytest.approx(9810.0 * 2.0, rel=1e-12)


def test_gauge_on_a_thin_obstacle_reads_its_own_side():
    """The back of a plate of three layers is a surface too, but the gauge is not before it."""
    position = lattice([1.0, 0.0], [1.3, 1.0])
    pressure = np.where(position[:, 0] < 1.1, 7.0, np.where(position[:, 0] > 1.2, 1e6, 1e3))
    plate = frame_of(wall(position, pressure=pressure))
    probe = gauge(radius=0.32, at=[1.0, 0.5])
    probe.start(plate)
    assert probe.evaluate(plate)[0] == pytest.approx(7.0, abs=1e-9)
