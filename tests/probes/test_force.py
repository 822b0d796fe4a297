"""Force and torque are the sums of mechanics."""

import numpy as np
import pytest
from particles import frame_of, lattice, probe_of, scene_with, wall


def load(dimension=2, about=None):
    return probe_of(scene_with({"type": "force", "boundary": "tank", "about": about}, dimension))


@pytest.mark.parametrize("dimension", [2, 3])
def test_force_is_the_sum_and_torque_the_sum_of_arm_times_force(dimension):
    random = np.random.default_rng(1)
    position, force = random.normal(size=(2, 50, dimension))
    about = random.normal(size=dimension)
    probe = load(dimension, list(about))
    frame = frame_of(wall(position, force=force))
    probe.start(frame)
    arm = np.pad(position - about, ((0, 0), (0, 3 - dimension)))
    torque = np.cross(arm, np.pad(force, ((0, 0), (0, 3 - dimension)))).sum(axis=0)
    expected = [*force.sum(axis=0), *(torque[2:] if dimension == 2 else torque)]
    np.testing.assert_allclose(probe.evaluate(frame), expected, rtol=1e-12)


def test_columns_are_per_metre_of_depth_in_the_plane():
    assert load(2).columns == ("probe.force_x[N/m]", "probe.force_y[N/m]", "probe.torque_z[N m/m]")
    assert load(3).columns[3:] == ("probe.torque_x[N m]", "probe.torque_y[N m]", "probe.torque_z[N m]")


def test_torque_is_about_the_centre_of_mass_at_the_start():
    """A uniform force on a body that has moved by d has the torque d x F about where it was."""
    body = lattice([0.0, 0.0], [1.0, 1.0])
    force = np.tile([0.0, 2.0], (len(body), 1))
    probe = load()
    probe.start(frame_of(wall(body)))
    assert probe.evaluate(frame_of(wall(body, force=force)))[2] == pytest.approx(0.0, abs=1e-9)
    moved = frame_of(wall(body + np.array([0.5, 0.0]), force=force))
    assert probe.evaluate(moved)[2] == pytest.approx(0.5 * 2.0 * len(body))


def test_force_before_the_start_is_refused():
    with pytest.raises(ValueError, match="start"):
        load().evaluate(frame_of(wall(lattice([0.0, 0.0], [1.0, 1.0]))))
