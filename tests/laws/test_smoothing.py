"""Smoothing kernels on the host: unit integral, and the same values as on the device."""

import numpy as np
import pytest
import warp as wp
from scipy.integrate import quad
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.smoothing import SMOOTHING_KERNELS

from warpsph.laws.smoothing import SMOOTHING_LAWS


@pytest.mark.parametrize("kernel", SMOOTHING_LAWS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_kernel_integrates_to_one(kernel, dimension):
    def shell(q):
        area = 2.0 * np.pi * q if dimension == 2 else 4.0 * np.pi * q**2
        return area * float(SMOOTHING_LAWS[kernel].value(np.array(q), dimension))

    assert quad(shell, 0.0, 10.0, points=[1.0, 2.0, 3.0])[0] == pytest.approx(1.0, rel=1e-8)


@pytest.mark.parametrize("kernel", SMOOTHING_LAWS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_host_and_device_agree(kernel, dimension):
    law, device_kernel = SMOOTHING_LAWS[kernel], SMOOTHING_KERNELS[kernel]
    shape = device_kernel.make(Arithmetic(dimension, "double"))[0]

    @wp.kernel(module="unique", enable_backward=False)
    def evaluate(argument: wp.array(dtype=wp.float64), value: wp.array(dtype=wp.float64)):
        i = wp.tid()
        value[i] = shape(argument[i])

    q = np.linspace(0.0, 1.1 * law.support, 400)
    value = wp.zeros(len(q), dtype=wp.float64, device="cpu")
    wp.launch(evaluate, len(q), inputs=[wp.array(q, dtype=wp.float64, device="cpu"), value], device="cpu")
    on_device = device_kernel.norm(dimension, 1.0) * value.numpy()
    # The terms of the quintic spline reach 3^5 and cancel.
    assert on_device == pytest.approx(law.value(q, dimension), abs=1e-13)
