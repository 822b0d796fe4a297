"""Volume is the sum of m / rho."""

import numpy as np
import pytest
from particles import DENSITY, fluid, frame_of, lattice, probe_of, scene_with


@pytest.mark.parametrize(("dimension", "unit"), [(2, "m2"), (3, "m3")])
def test_compressed_block_has_less_volume_and_as_many_particles(dimension, unit):
    position = lattice([0.0] * dimension, [1.0] * dimension)
    water = fluid(position, density=np.full(len(position), 1.25 * DENSITY))
    probe = probe_of(scene_with({"type": "volume"}, dimension))
    assert probe.columns == (f"probe.volume[{unit}]", "probe.particles[1]", "probe.removed[1]")
    probe.start(frame_of(water))
    assert probe.evaluate(frame_of(water)) == pytest.approx((0.8, len(position), 0.0))


def test_particles_that_are_gone_are_counted():
    position = lattice([0.0, 0.0], [1.0, 1.0])
    probe = probe_of(scene_with({"type": "volume"}, 2))
    probe.start(frame_of(fluid(position)))
    assert probe.evaluate(frame_of(fluid(position[3:])))[1:] == (len(position) - 3, 3.0)


def test_only_what_lies_in_the_region_counts():
    """A quarter of the block lies in the region; what leaves it counts as gone."""
    position = lattice([0.0, 0.0], [1.0, 1.0])
    region = {"min": [0.0, 0.0], "max": [0.5, 0.5]}
    probe = probe_of(scene_with({"type": "volume", "region": region}, 2))
    probe.start(frame_of(fluid(position)))
    assert probe.evaluate(frame_of(fluid(position))) == pytest.approx((0.25, 25.0, 0.0))
    assert probe.evaluate(frame_of(fluid(position + np.array([0.1, 0.0])))) == pytest.approx((0.2, 20.0, 5.0))
