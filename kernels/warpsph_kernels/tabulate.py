"""Values of a formula at many arguments, in double precision: what the host needs of device code."""

from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic


@cache
def make_kernel_table(function: Any) -> Any:
    """Return the kernel (q, value) that evaluates a part of a smoothing kernel."""

    @wp.kernel(module="unique", enable_backward=False)
    def tabulate(q: wp.array(dtype=wp.float64), value: wp.array(dtype=wp.float64)):
        i = wp.tid()
        value[i] = function(q[i])

    return tabulate


def make_state_table(function: Any, arithmetic: Arithmetic) -> Any:
    """Return the kernel (e, parameters, p) that evaluates a state for rho0 = 1, c0 = 1 and strains e."""
    vector = arithmetic.parameters

    @wp.kernel(module="unique", enable_backward=False)
    def tabulate(
        strain: wp.array(dtype=wp.float64), parameters: vector, pressure: wp.array(dtype=wp.float64)
    ):
        i = wp.tid()
        pressure[i] = function(strain[i], wp.float64(1.0), wp.float64(1.0), parameters)

    return tabulate
