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


WENDLAND_C2 = SmoothingKernel(
    name="wendland_c2",
    support=2.0,
    alpha={2: 7.0 / (4.0 * math.pi), 3: 21.0 / (16.0 * math.pi)},
    make=_make_wendland_c2,
)

SMOOTHING_KERNELS = {kernel.name: kernel for kernel in (WENDLAND_C2,)}
