"""The renormalised density gradient that density diffusion takes away (Antuono et al. 2010)."""

from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import make_packing, make_separation
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pair_terms import make_constants_struct
from warpsph_kernels.renormalisation import make_correction
from warpsph_kernels.smoothing import SMOOTHING_KERNELS


@cache
def make_density_gradient(options: FluidOptions) -> Any:
    """Return the kernel of the density gradient specialised for the options."""
    arithmetic = options.arithmetic
    dim, vector, matrix, record = (
        arithmetic.dimension,
        arithmetic.vector,
        arithmetic.matrix,
        arithmetic.record,
    )
    constants_type = make_constants_struct(arithmetic)
    _, unpack = make_packing(arithmetic)
    separation = make_separation(arithmetic, options.periodic)
    _, slope = SMOOTHING_KERNELS[options.smoothing].make(arithmetic)
    correction = make_correction(arithmetic)

    @wp.kernel(module=options.module_of("density_gradient"), enable_backward=False)
    def density_gradient(
        offset: int,
        c: constants_type,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_density: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        gradient: wp.array(dtype=vector),
    ):
        """One particle: grad rho [kg/m^(dim+1)] over the fluid around it, exact for linear densities."""
        i = offset + wp.tid()
        xd_a = position_density[i]
        x_a = unpack(xd_a)
        total = vector()
        moment = matrix()
        for n in range(ends[i, 0]):
            b = neighbours[i, n]
            xd_b = position_density[b]
            x_ab = separation(x_a, unpack(xd_b), c.period)
            grad = velocity_volume[b][dim] * c.slope_norm * slope(wp.length(x_ab) * c.inverse_h) * x_ab
            total += (xd_b[dim] - xd_a[dim]) * grad
            moment -= wp.outer(x_ab, grad)
        gradient[i] = correction(moment) * total

    return density_gradient
