"""Laws of every smoothing kernel: unit integral, slope as the derivative of the shape, compact support."""

import numpy as np
import pytest
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.smoothing import SMOOTHING_KERNELS, SmoothingKernel


def on_device(function, q: np.ndarray) -> np.ndarray:
    """Values of a scalar device function in double precision."""

    @wp.kernel(module="unique", enable_backward=False)
    def evaluate(argument: wp.array(dtype=wp.float64), value: wp.array(dtype=wp.float64)):
        i = wp.tid()
        value[i] = function(argument[i])

    value = wp.zeros(len(q), dtype=wp.float64, device="cpu")
    wp.launch(evaluate, len(q), inputs=[wp.array(q, dtype=wp.float64, device="cpu"), value], device="cpu")
    return value.numpy()


@pytest.fixture(params=SMOOTHING_KERNELS.values(), ids=lambda kernel: kernel.name)
def kernel(request) -> SmoothingKernel:
    return request.param


@pytest.mark.parametrize(("dimension", "sphere"), [(2, 2.0 * np.pi), (3, 4.0 * np.pi)])
def test_integral_over_space_is_one(kernel, dimension, sphere):
    # Midpoint rule on a smooth integrand: error ~ (support / n)^2.
    n = 4000
    q = (np.arange(n) + 0.5) * kernel.support / n
    shape = on_device(kernel.make(Arithmetic(dimension, "double"))[0], q)
    integral = (
        kernel.norm(dimension, 1.0) * sphere * np.sum(shape * q ** (dimension - 1)) * kernel.support / n
    )
    assert integral == pytest.approx(1.0, abs=1e-6)


def test_slope_is_the_derivative_of_the_shape_over_q(kernel):
    shape, slope = kernel.make(Arithmetic(2, "double"))
    q = np.linspace(0.05, 0.99 * kernel.support, 50)
    step = 1e-5
    derivative = (on_device(shape, q + step) - on_device(shape, q - step)) / (2.0 * step)
    assert on_device(slope, q) * q == pytest.approx(derivative, abs=1e-8)


def test_zero_beyond_the_support(kernel):
    q = kernel.support * np.array([1.0, 1.05, 3.0])
    for function in kernel.make(Arithmetic(2, "double")):
        assert np.all(on_device(function, q) == 0.0)
