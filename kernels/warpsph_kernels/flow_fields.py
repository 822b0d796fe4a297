"""Fields that are computed from a state for output only: vorticity and the free surface."""

from functools import cache
from typing import Any, NamedTuple

import warp as wp

from warpsph_kernels.arithmetic import make_packing, make_separation
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pair_terms import make_constants_struct
from warpsph_kernels.smoothing import SMOOTHING_KERNELS

SMALLEST_DETERMINANT = 1.0e-3
"""Of the matrix of first moments, about one inside; below it the neighbours span no volume."""


class FlowFieldKernels(NamedTuple):
    """Kernels of output fields; each stands alone."""

    find_vorticity: Any
    find_free_surface: Any


@cache
def make_flow_field_kernels(options: FluidOptions) -> FlowFieldKernels:
    """Return the kernels of output fields specialised for the options."""
    arithmetic = options.arithmetic
    dim, real, vector, record = arithmetic.dimension, arithmetic.real, arithmetic.vector, arithmetic.record
    matrix = wp.types.matrix((dim, dim), real)
    curl_type = real if dim == 2 else vector
    module = f"{options.module}_fields"
    constants_type = make_constants_struct(arithmetic)
    _, unpack = make_packing(arithmetic)
    separation = make_separation(arithmetic, options.periodic)
    _, slope = SMOOTHING_KERNELS[options.smoothing].make(arithmetic)

    def curl_in_plane(gradient: matrix):
        return gradient[1, 0] - gradient[0, 1]

    def curl_in_space(gradient: matrix):
        x = gradient[2, 1] - gradient[1, 2]
        y = gradient[0, 2] - gradient[2, 0]
        z = gradient[1, 0] - gradient[0, 1]
        return vector(x, y, z)

    curl = wp.func(curl_in_plane if dim == 2 else curl_in_space)

    @wp.kernel(module=module, enable_backward=False)
    def find_vorticity(
        offset: int,
        c: constants_type,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_pressure: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        vorticity: wp.array(dtype=curl_type),
    ):
        """One particle: curl v [1/s] from the renormalised velocity gradient of the fluid, zero where it is undefined.

        grad v = (sum_b V_b v_ba (x) grad_a W_ab) (sum_b V_b x_ba (x) grad_a W_ab)^-1 (Randles & Libersky 1996): exact
        for linear fields, at a free surface too.
        """
        i = offset + wp.tid()
        x_a, v_a = unpack(position_pressure[i]), unpack(velocity_volume[i])
        moment = matrix()
        change = matrix()
        for n in range(ends[i, 0]):
            b = neighbours[i, n]
            vV_b = velocity_volume[b]
            x_ab = separation(x_a, unpack(position_pressure[b]), c.period)
            grad = vV_b[dim] * c.slope_norm * slope(wp.length(x_ab) * c.inverse_h) * x_ab
            moment -= wp.outer(x_ab, grad)
            change += wp.outer(unpack(vV_b) - v_a, grad)
        if wp.determinant(moment) > real(wp.static(SMALLEST_DETERMINANT)):
            vorticity[i] = curl(change * wp.inverse(moment))
        else:
            vorticity[i] = curl(matrix())

    @wp.kernel(module=module, enable_backward=False)
    def find_free_surface(
        offset: int,
        c: constants_type,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_pressure: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        free_surface: wp.array(dtype=real),
    ):
        """One particle: 1 at the free surface, else 0 (Marrone et al. 2010, second step).

        The normal points away from the neighbours, walls included. A particle is inside if one of them lies in the
        umbrella before it: a cone of 45 degrees up to sqrt(2) h, and beyond it the ball of radius h about the point h
        ahead.
        """
        i = offset + wp.tid()
        x_a = unpack(position_pressure[i])
        end = ends[i, 0]
        last = ends[i, ends.shape[1] - 1]
        gradient = vector()
        for n in range(last):
            b = neighbours[i, n]
            x_ab = separation(x_a, unpack(position_pressure[b]), c.period)
            V_b = c.wall_volume
            if n < end:
                V_b = velocity_volume[b][dim]
            gradient += V_b * slope(wp.length(x_ab) * c.inverse_h) * x_ab
        normal = -wp.normalize(gradient)
        h = c.smoothing_length
        is_surface = bool(True)
        for n in range(last):
            x_ba = -separation(x_a, unpack(position_pressure[neighbours[i, n]]), c.period)
            r = wp.length(x_ba)
            if r < real(wp.static(2.0**0.5)) * h:
                if wp.dot(x_ba, normal) > real(wp.static(0.5**0.5)) * r:
                    is_surface = False
            elif wp.length(x_ba - h * normal) < h:
                is_surface = False
        free_surface[i] = wp.where(is_surface, real(1.0), real(0.0))

    return FlowFieldKernels(find_vorticity, find_free_surface)
