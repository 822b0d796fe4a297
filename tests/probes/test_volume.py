"""Volume is the sum of m / rho."""

import numpy as np
import pytest
from particles import DENSITY, fluid, frame_of, lattice, probe_of, scene_with


@pytest.mark.parametrize(("dimension", "unit"), [(2, "m2"), (3, "m3")])
def test_compressed_block_has_less_volume_and_as_many_particles(dimension, unit):
    position = lattice([0.0] * dimension, [1.0] * dimension)
    water = fluid(position, density=np.full(len(position), 1.25 * DENSITY))
    probe = probe_of(scene_with({"type": "volume"}, dimension))
    assert probe.columns == (f"probe.volume[{unit}]", "probe.particles[1]")
    assert probe.evaluate(frame_of(water)) == pytest.approx((0.8, len(position)))
