"""Kernel sums on the host."""

import numpy as np
from particles import scene_with

from warpsph.probes.smoothing import Smoothing


def test_near_selects_by_the_nearest_image():
    scene = scene_with({"type": "volume"}, domain={"periodic": {"x": [0.0, 2.0]}})
    smoothing = Smoothing.of(scene)
    position = np.array([[1.95, 0.0], [0.05, 5.0], [0.5, 0.0]])
    assert list(smoothing.near(position, [(0, 0.0)])) == [0, 1]
    assert list(smoothing.near(position, [(0, 0.0), (1, 0.0)])) == [0]
    np.testing.assert_allclose(smoothing.separation(position[:, 0], 0.0, 0), [-0.05, 0.05, 0.5])
