"""Reach is the distance of the farthest corner of the fluid's cells."""

import math

import numpy as np
import pytest
from particles import fluid, frame_of, lattice, probe_of, scene_with


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_box_reaches_to_its_corners(dimension):
    probe = probe_of(scene_with({"type": "reach", "center": [0.5] * dimension}, dimension))
    water = fluid(lattice([0.0] * dimension, [1.0] * dimension))
    assert probe.columns == ("probe.radius[m]",)
    assert probe.evaluate(frame_of(water))[0] == pytest.approx(0.5 * math.sqrt(dimension), rel=1e-12)


def test_without_fluid_there_is_no_reach():
    probe = probe_of(scene_with({"type": "reach", "center": [0.0, 0.0]}))
    assert math.isnan(probe.evaluate(frame_of(fluid(np.empty((0, 2)))))[0])
