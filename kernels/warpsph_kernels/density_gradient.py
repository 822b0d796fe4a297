"""The renormalised density gradient that density diffusion takes away (Antuono et al. 2010)."""

from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import make_packing, make_separation
from warpsph_kernels.lanes import make_lanes
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pair_terms import make_constants_struct
from warpsph_kernels.renormalisation import make_correction
from warpsph_kernels.smoothing import SMOOTHING_KERNELS


@cache
def make_density_gradient(options: FluidOptions) -> Any:
    """Return the kernel of the density gradient specialised for the options."""
    arithmetic = options.arithmetic
    dim, real, vector, record = arithmetic.dimension, arithmetic.real, arithmetic.vector, arithmetic.record
    constants_type = make_constants_struct(arithmetic)
    _, unpack = make_packing(arithmetic)
    separation = make_separation(arithmetic, options.periodic)
    _, slope = SMOOTHING_KERNELS[options.smoothing].make(arithmetic)
    correction = make_correction(arithmetic)
    lanes, L = make_lanes(arithmetic, options.lanes), options.lanes
    take, records, fold, fold_tensor = lanes.take, lanes.records, lanes.fold, lanes.fold_tensor
    sums_type, tensors_type = lanes.sums, lanes.tensors

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
        x_a, deviation_a = unpack(xd_a), xd_a[dim]
        sums = sums_type()
        moments = tensors_type()
        end = ends[i, 0]
        n = int(0)
        while n < end:
            b = take(neighbours, i, n, end)
            xd_b = records(position_density, b, 0)
            vV_b = records(velocity_volume, b, 0)
            k = int(0)
            while k < wp.static(L):
                x_b = vector()
                for d in range(wp.static(dim)):
                    x_b[d] = xd_b[k + wp.static(L * d)]
                V_b = wp.where(n + k < end, vV_b[k + wp.static(L * dim)], real(0.0))
                x_ab = separation(x_a, x_b, c.period)
                grad = V_b * c.slope_norm * slope(wp.length(x_ab) * c.inverse_h) * x_ab
                rise = xd_b[k + wp.static(L * dim)] - deviation_a
                for d in range(wp.static(dim)):
                    sums[k + wp.static(L) * d] = sums[k + wp.static(L) * d] + rise * grad[d]
                    for e in range(wp.static(dim)):
                        place = k + wp.static(L) * (wp.static(dim) * d + e)
                        moments[place] = moments[place] - x_ab[d] * grad[e]
                k += 1
            n += wp.static(L)
        gradient[i] = correction(fold_tensor(moments)) * fold(sums)

    return density_gradient
