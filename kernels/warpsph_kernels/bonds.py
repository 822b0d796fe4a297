"""Weights of reference bonds from the slope of a smoothing kernel, once a run."""

from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.smoothing import SMOOTHING_KERNELS


@cache
def make_bond_weights(dimension: int, smoothing: str) -> Any:
    """Return the kernel `bond_weights` of a smoothing kernel; double precision, since a run keeps its bonds."""
    arithmetic = Arithmetic(dimension, "double")
    real = arithmetic.real
    _, slope = SMOOTHING_KERNELS[smoothing].make(arithmetic)

    @wp.kernel(module=f"warpsph_bonds_{dimension}_{smoothing}", enable_backward=False)
    def bond_weights(
        offset: int,
        slope_norm: real,
        inverse_h: real,
        length: wp.array(dtype=real),
        weight: wp.array(dtype=real),
    ):
        """One bond: F with grad_a W_ab = F x_ab [m^-(dim+2)] from its length [m]."""
        i = offset + wp.tid()
        weight[i] = slope_norm * slope(length[i] * inverse_h)

    return bond_weights
