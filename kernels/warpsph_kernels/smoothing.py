"""Smoothing kernels W(r, h) and their gradients.

A kernel is written by its dimensionless shape f(q), q = r/h, and slope f'(q)/q. Then, with the norm
n = alpha_d / h^d of the dimension d,

    W = n f(q),        grad_a W_ab = F x_ab  with  F = n/h^2 f'(q)/q.

The slope has no division by q left in it, so that a pair at zero distance needs no special case. Both functions
are zero beyond the support, because neighbour lists reach a little further.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic


@dataclass(frozen=True)
class SmoothingKernel:
    """A smoothing kernel: support radius in units of h, alpha_d for each dimension d, and its device functions.

    `make(arithmetic)` returns the pair of device functions (shape, slope), each of signature `real -> real`.
    """

    name: str
    support: float
    alpha: Mapping[int, float]
    make: Callable[[Arithmetic], tuple[Any, Any]]

    def norm(self, dimension: int, smoothing_length: float) -> float:
        """Return alpha_d / h^d in m^-d."""
        return self.alpha[dimension] / smoothing_length**dimension


@cache
def _make_wendland_c2(arithmetic: Arithmetic) -> tuple[Any, Any]:
    """Wendland (1995) C2: f = (1 - q/2)^4 (2 q + 1), f'/q = -5 (1 - q/2)^3 for q < 2."""
    real = arithmetic.real

    def shape(q: real):
        s = wp.max(real(1.0) - real(0.5) * q, real(0.0))
        return s * s * s * s * (real(2.0) * q + real(1.0))

    def slope(q: real):
        s = wp.max(real(1.0) - real(0.5) * q, real(0.0))
        return real(-5.0) * s * s * s

    return wp.func(shape), wp.func(slope)


@cache
def _make_wendland_c4(arithmetic: Arithmetic) -> tuple[Any, Any]:
    """Wendland (1995) C4: f = (1 - q/2)^6 (35/12 q^2 + 3 q + 1), f'/q = -7/3 (1 - q/2)^5 (5 q + 2) for q < 2."""
    real = arithmetic.real

    def shape(q: real):
        s = wp.max(real(1.0) - real(0.5) * q, real(0.0))
        s2 = s * s
        return s2 * s2 * s2 * (real(wp.static(35.0 / 12.0)) * q * q + real(3.0) * q + real(1.0))

    def slope(q: real):
        s = wp.max(real(1.0) - real(0.5) * q, real(0.0))
        s2 = s * s
        return real(wp.static(-7.0 / 3.0)) * s2 * s2 * s * (real(5.0) * q + real(2.0))

    return wp.func(shape), wp.func(slope)


@cache
def _make_cubic_spline(arithmetic: Arithmetic) -> tuple[Any, Any]:
    """Cubic spline (Monaghan & Lattanzio 1985): f = (2-q)^3/4 - (1-q)^3, each term only where it is positive."""
    real = arithmetic.real

    def shape(q: real):
        wide = wp.max(real(2.0) - q, real(0.0))
        narrow = wp.max(real(1.0) - q, real(0.0))
        return real(0.25) * wide * wide * wide - narrow * narrow * narrow

    def slope(q: real):
        wide = wp.max(real(2.0) - q, real(0.0))
        value = real(-3.0) + real(2.25) * q
        if q > real(1.0):
            value = real(-0.75) * wide * wide / q
        return value

    return wp.func(shape), wp.func(slope)


@cache
def _make_quintic_spline(arithmetic: Arithmetic) -> tuple[Any, Any]:
    """Quintic spline (Morris, Fox & Zhu 1997): f = (3-q)^5 - 6 (2-q)^5 + 15 (1-q)^5, each term where positive.

    For q < 1 the slope is that of the expanded polynomial 66 - 60 q^2 + 30 q^4 - 10 q^5.
    """
    real = arithmetic.real

    def shape(q: real):
        wide = wp.max(real(3.0) - q, real(0.0))
        middle = wp.max(real(2.0) - q, real(0.0))
        narrow = wp.max(real(1.0) - q, real(0.0))
        wide2, middle2, narrow2 = wide * wide, middle * middle, narrow * narrow
        tail = real(15.0) * narrow2 * narrow2 * narrow - real(6.0) * middle2 * middle2 * middle
        return wide2 * wide2 * wide + tail

    def slope(q: real):
        value = real(-120.0) + q * q * (real(120.0) - real(50.0) * q)
        if q > real(1.0):
            wide = wp.max(real(3.0) - q, real(0.0))
            middle = wp.max(real(2.0) - q, real(0.0))
            wide2, middle2 = wide * wide, middle * middle
            value = real(-5.0) * (wide2 * wide2 - real(6.0) * middle2 * middle2) / q
        return value

    return wp.func(shape), wp.func(slope)


_GAUSSIAN_CUT = 3.0


def _gaussian_alpha(cut: float) -> dict[int, float]:
    """One over the integral of exp(-q^2) over the disc and the ball of radius `cut`."""
    edge = math.exp(-(cut**2))
    ball = math.pi**1.5 * math.erf(cut) - 2.0 * math.pi * cut * edge
    return {2: 1.0 / (math.pi * (1.0 - edge)), 3: 1.0 / ball}


@cache
def _make_gaussian(arithmetic: Arithmetic) -> tuple[Any, Any]:
    """Gaussian (Gingold & Monaghan 1977): f = exp(-q^2), f'/q = -2 exp(-q^2), cut off at q = 3.

    The norm is that of what is left, so that the integral is one.
    """
    real = arithmetic.real

    def shape(q: real):
        value = real(0.0)
        if q < real(wp.static(_GAUSSIAN_CUT)):
            value = wp.exp(-q * q)
        return value

    def slope(q: real):
        value = real(0.0)
        if q < real(wp.static(_GAUSSIAN_CUT)):
            value = real(-2.0) * wp.exp(-q * q)
        return value

    return wp.func(shape), wp.func(slope)


SMOOTHING_KERNELS: dict[str, SmoothingKernel] = {
    kernel.name: kernel
    for kernel in (
        SmoothingKernel(
            "wendland_c2", 2.0, {2: 7.0 / (4.0 * math.pi), 3: 21.0 / (16.0 * math.pi)}, _make_wendland_c2
        ),
        SmoothingKernel(
            "wendland_c4", 2.0, {2: 9.0 / (4.0 * math.pi), 3: 495.0 / (256.0 * math.pi)}, _make_wendland_c4
        ),
        SmoothingKernel(
            "cubic_spline", 2.0, {2: 10.0 / (7.0 * math.pi), 3: 1.0 / math.pi}, _make_cubic_spline
        ),
        SmoothingKernel(
            "quintic_spline",
            3.0,
            {2: 7.0 / (478.0 * math.pi), 3: 1.0 / (120.0 * math.pi)},
            _make_quintic_spline,
        ),
        SmoothingKernel("gaussian", _GAUSSIAN_CUT, _gaussian_alpha(_GAUSSIAN_CUT), _make_gaussian),
    )
}
"""By name; `warpsph.register_smoothing_kernel` adds to it."""
