"""Kernels that keep particles evenly spread: the velocity by which they leave the flow's, and what it carries.

Particles move with v + dv. The shift velocity dv points down the gradient of the concentration, C = sum_b V_b W_ab
over fluid and walls. With transport_velocity, the momentum that it carries through the fluid is the divergence of
rho v (x) dv (Adami, Hu & Adams 2013), summed in a form that changes its sign when a pair is exchanged. That form leaves
out v div(rho dv), which is small in the middle of fluid and not at a free surface, where it drives what is shifted
along it: shifting leaves v alone, as Sun et al. (2017) do. `shift` holds dv of the last step.
"""

from functools import cache
from typing import Any, NamedTuple

import warp as wp

from warpsph_kernels.arithmetic import make_packing, make_separation
from warpsph_kernels.clock import SPEED
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pair_terms import make_constants_struct
from warpsph_kernels.smoothing import SMOOTHING_KERNELS

LARGEST_SHIFT = 0.1
"""Of a step, in spacings."""
FOLLOWING_TIME = 50.0
"""Over which the density follows what shifts bring together, in times in which sound passes a smoothing length: about a
hundred steps. At once, the jitter of the shifts would be sound, and take energy from the flow."""
SURFACE_EIGENVALUE = 0.75
"""Smallest eigenvalue of a particle's moment matrix below which it belongs to the surface (Marrone et al. 2010)."""
SPRAY_EIGENVALUE = 0.4
"""Below it a particle has too few neighbours to be shifted at all (Sun et al. 2017)."""


class OrderKernels(NamedTuple):
    """Kernels of the particle order, in the order of a step."""

    find_order: Any
    limit_at_surface: Any


@cache
def make_smallest_eigenvalue(options: FluidOptions) -> Any:
    """Return the device function of the smallest eigenvalue of a symmetric matrix, in closed form."""
    arithmetic = options.arithmetic
    real, matrix, dim = arithmetic.real, arithmetic.matrix, arithmetic.dimension
    third = 2.0943951023931953  # 2 pi / 3

    def smallest_in_2d(m: matrix):
        mean = real(0.5) * (m[0, 0] + m[1, 1])
        half = real(0.5) * (m[0, 0] - m[1, 1])
        return mean - wp.sqrt(half * half + m[0, 1] * m[0, 1])

    def smallest_in_3d(m: matrix):
        mean = wp.trace(m) / real(3.0)
        deviator = m - mean * wp.identity(n=wp.static(dim), dtype=real)
        size = wp.sqrt(wp.ddot(deviator, deviator) / real(6.0))
        value = mean
        if size > real(1.0e-6):
            cosine = wp.clamp(wp.determinant(deviator / size) * real(0.5), real(-1.0), real(1.0))
            angle = wp.acos(cosine) / real(3.0)
            value = mean + real(2.0) * size * wp.cos(angle + real(wp.static(third)))
        return value

    return wp.func(smallest_in_2d if dim == 2 else smallest_in_3d)


@cache
def make_order_kernels(options: FluidOptions) -> OrderKernels:
    """Return the kernels of the particle order specialised for the options."""
    arithmetic = options.arithmetic
    dim, real, vector, matrix = arithmetic.dimension, arithmetic.real, arithmetic.vector, arithmetic.matrix
    record = arithmetic.record
    module = options.module_of("order")
    constants_type = make_constants_struct(arithmetic)
    _, unpack = make_packing(arithmetic)
    separation = make_separation(arithmetic, options.periodic)
    _, slope = SMOOTHING_KERNELS[options.smoothing].make(arithmetic)
    smallest_eigenvalue = make_smallest_eigenvalue(options)
    finds_surface = options.particle_order == "shifting"
    carries = options.particle_order == "transport_velocity"

    def bounded(c: constants_type, dv: vector, dt: real):
        largest = real(wp.static(LARGEST_SHIFT)) / (c.inverse_spacing * dt)
        return dv * wp.min(real(1.0), largest / wp.max(wp.length(dv), real(1.0e-20)))

    bounded = wp.func(bounded)

    @wp.kernel(module=module, enable_backward=False)
    def find_order(
        offset: int,
        c: constants_type,
        clock: wp.array(dtype=wp.float64),
        strength: real,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_pressure: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        shift: wp.array(dtype=vector),
        next_shift: wp.array(dtype=vector),
        coverage: wp.array(dtype=real),
        closing: wp.array(dtype=real),
        acceleration: wp.array(dtype=vector),
    ):
        """One particle: the momentum that dv carries, where it carries any, and the next dv.

        transport_velocity: dv = -2 dt p_b / rho grad C with the background pressure p_b = `strength` rho0 c0^2 (Adami,
        Hu & Adams 2013); shifting: dv = -`strength` h v grad C with the largest speed v of all (Sun et al. 2017), and
        the smallest eigenvalue of the moment matrix as `coverage`, about one inside. `closing`: running mean of
        -div dv [1/s], where the density follows it.
        """
        i = offset + wp.tid()
        x_a, vV_a = unpack(position_pressure[i]), velocity_volume[i]
        v_a, dv_a = unpack(vV_a), shift[i]
        rho_a = c.mass / vV_a[dim]
        concentration = vector()
        carried = vector()
        moment = matrix()
        rate = real(0.0)
        end = ends[i, 0]
        for n in range(end):
            b = neighbours[i, n]
            vV_b = velocity_volume[b]
            x_ab = separation(x_a, unpack(position_pressure[b]), c.period)
            F = c.slope_norm * slope(wp.length(x_ab) * c.inverse_h)
            grad = vV_b[dim] * F * x_ab
            concentration += grad
            if wp.static(options.density_follows):
                rate += wp.dot(dv_a - shift[b], grad)
            if wp.static(carries):
                v_b = unpack(vV_b)
                carried += rho_a * wp.dot(dv_a, grad) * v_a + c.mass * F * wp.dot(shift[b], x_ab) * v_b
            if wp.static(finds_surface):
                moment -= wp.outer(x_ab, grad)
        for n in range(end, ends[i, ends.shape[1] - 1]):
            x_ab = separation(x_a, unpack(position_pressure[neighbours[i, n]]), c.period)
            grad = c.wall_volume * c.slope_norm * slope(wp.length(x_ab) * c.inverse_h) * x_ab
            concentration += grad
            if wp.static(options.density_follows):
                rate += wp.dot(dv_a, grad)
            if wp.static(finds_surface):
                moment -= wp.outer(x_ab, grad)
        dt = real(clock[0])
        if wp.static(options.density_follows):
            time = real(wp.static(FOLLOWING_TIME)) * c.smoothing_length / c.sound_speed
            closing[i] = closing[i] + dt / (time + dt) * (rate - closing[i])
        if wp.static(finds_surface):
            coverage[i] = smallest_eigenvalue(moment)
            next_shift[i] = bounded(
                c, -strength * c.smoothing_length * real(clock[wp.static(SPEED)]) * concentration, dt
            )
        else:
            push = real(2.0) * dt * strength * c.sound_speed * c.sound_speed
            next_shift[i] = bounded(c, -push * concentration, dt)
        if wp.static(carries):
            acceleration[i] = acceleration[i] + vV_a[dim] / c.mass * carried

    @wp.kernel(module=module, enable_backward=False)
    def limit_at_surface(
        offset: int,
        c: constants_type,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_pressure: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        coverage: wp.array(dtype=real),
        next_shift: wp.array(dtype=vector),
    ):
        """One particle: near a surface it is not shifted out of it, at the surface only along it, in spray not at all.

        The normal points down the gradient of the coverage (Marrone et al. 2010; the rules are those of Sun et al. 2017
        and 2019).
        """
        i = offset + wp.tid()
        x_a = unpack(position_pressure[i])
        covered = coverage[i]
        least = covered
        outward = vector()
        for n in range(ends[i, 0]):
            b = neighbours[i, n]
            x_ab = separation(x_a, unpack(position_pressure[b]), c.period)
            VF = velocity_volume[b][dim] * slope(wp.length(x_ab) * c.inverse_h)
            outward -= (coverage[b] - covered) * VF * x_ab
            if real(0.0) > VF:
                least = wp.min(least, coverage[b])
        dv = next_shift[i]
        if least < real(wp.static(SURFACE_EIGENVALUE)):
            normal = wp.normalize(outward)
            along = wp.dot(dv, normal)
            if covered < real(wp.static(SURFACE_EIGENVALUE)) or along > real(0.0):
                dv -= along * normal
        if covered < real(wp.static(SPRAY_EIGENVALUE)):
            dv = vector()
        next_shift[i] = dv

    return OrderKernels(find_order, limit_at_surface)
