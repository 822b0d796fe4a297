"""Density by summation: for space that is filled, or inside of a fluid whose surface keeps the continuity equation."""

from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import make_packing, make_separation
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pair_terms import make_constants_struct
from warpsph_kernels.smoothing import SMOOTHING_KERNELS

COVERED, UNCOVERED = 0.98, 0.93
"""Divergence of the position over the dimension (Lee et al. 2008; one where the support is full) from which on the
mixed form sums, and down to which it leaves the density to the continuity equation alone."""


@cache
def make_sum_density(options: FluidOptions) -> Any:
    """Return the kernel of the density sum specialised for the options."""
    arithmetic = options.arithmetic
    dim, real, record = arithmetic.dimension, arithmetic.real, arithmetic.record
    constants_type = make_constants_struct(arithmetic)
    _, unpack = make_packing(arithmetic)
    separation = make_separation(arithmetic, options.periodic)
    shape, slope = SMOOTHING_KERNELS[options.smoothing].make(arithmetic)
    mixed = options.density == "mixed"

    @wp.kernel(module=options.module_of("summation"), enable_backward=False)
    def sum_density(
        offset: int,
        c: constants_type,
        lattice_sum: wp.float64,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_pressure: wp.array(dtype=record),
        density_deviation: wp.array(dtype=real),
    ):
        """One particle: rho_a = sum_b m W_ab (Monaghan 1992) over fluid and walls, with the mass of a spacing.

        `lattice_sum` is sum_b dp^d W_ab on the lattice, so that a lattice has the density at rest. The sum is made in
        double precision, because what matters of it is the small rest beside one.
        """
        i = offset + wp.tid()
        x_a = unpack(position_pressure[i])
        total = wp.float64(shape(real(0.0)))  # a list does not hold the particle itself
        divergence = real(0.0)
        for n in range(ends[i, ends.shape[1] - 1]):
            x_ab = separation(x_a, unpack(position_pressure[neighbours[i, n]]), c.period)
            r = wp.length(x_ab)
            total += wp.float64(shape(r * c.inverse_h))
            if wp.static(mixed):
                divergence -= c.slope_norm * slope(r * c.inverse_h) * r * r
        filling = total * wp.float64(c.norm * c.wall_volume) / lattice_sum
        summed = real(wp.float64(c.rest_density) * (filling - wp.float64(1.0)))
        if wp.static(mixed):
            covered = divergence * c.wall_volume / real(wp.static(dim))
            weight = (covered - real(wp.static(UNCOVERED))) / real(wp.static(COVERED - UNCOVERED))
            weight = wp.clamp(weight, real(0.0), real(1.0))
            summed = density_deviation[i] + weight * (summed - density_deviation[i])
        density_deviation[i] = summed

    return sum_density
