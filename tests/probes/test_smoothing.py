"""Kernel sums on the host."""

import numpy as np
import pytest
from particles import scene_with
from scipy.integrate import quad

from warpsph.probes.smoothing import KERNELS, Smoothing


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_kernel_integrates_to_one(kernel, dimension):
    def shell(q):
        area = 2.0 * np.pi * q if dimension == 2 else 4.0 * np.pi * q**2
        return area * float(KERNELS[kernel](np.array(q), dimension))

    assert quad(shell, 0.0, 10.0, points=[1.0, 2.0, 3.0])[0] == pytest.approx(1.0, rel=1e-8)


def test_near_selects_by_the_nearest_image():
    scene = scene_with({"type": "volume"}, domain={"periodic": {"x": [0.0, 2.0]}})
    smoothing = Smoothing.of(scene)
    position = np.array([[1.95, 0.0], [0.05, 5.0], [0.5, 0.0]])
    assert list(smoothing.near(position, [(0, 0.0)])) == [0, 1]
    assert list(smoothing.near(position, [(0, 0.0), (1, 0.0)])) == [0]
    np.testing.assert_allclose(smoothing.separation(position[:, 0], 0.0, 0), [-0.05, 0.05, 0.5])
