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
from warpsph_kernels.lanes import make_lanes
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
    dim, real, vector, record = arithmetic.dimension, arithmetic.real, arithmetic.vector, arithmetic.record
    module = options.module_of("order")
    constants_type = make_constants_struct(arithmetic)
    _, unpack = make_packing(arithmetic)
    separation = make_separation(arithmetic, options.periodic)
    _, slope = SMOOTHING_KERNELS[options.smoothing].make(arithmetic)
    smallest_eigenvalue = make_smallest_eigenvalue(options)
    finds_surface = options.particle_order == "shifting"
    carries = options.particle_order == "transport_velocity"
    reads_shift = carries or options.density_follows
    lanes, L = make_lanes(arithmetic, options.lanes), options.lanes
    take, records, vectors, numbers = lanes.take, lanes.records, lanes.vectors, lanes.numbers
    sums_type, scalars_type, tensors_type = lanes.sums, lanes.scalars, lanes.tensors
    fold, fold_scalar, fold_tensor = lanes.fold, lanes.fold_scalar, lanes.fold_tensor

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
        v_a, dv_a = unpack(vV_a), vector(shift[i])
        rho_a = c.mass / vV_a[dim]
        concentrations = sums_type()
        carried = sums_type()
        moments = tensors_type()
        rates = scalars_type()
        end = ends[i, 0]
        n = int(0)
        while n < end:
            b = take(neighbours, i, n, end)
            xp_b = records(position_pressure, b, 0)
            vV_b = records(velocity_volume, b, 0)
            if wp.static(reads_shift):
                shifts_b = vectors(shift, b, 0)
            k = int(0)
            while k < wp.static(L):
                x_b = vector()
                v_b = vector()
                dv_b = vector()
                for d in range(wp.static(dim)):
                    x_b[d] = xp_b[k + wp.static(L * d)]
                    v_b[d] = vV_b[k + wp.static(L * d)]
                    if wp.static(reads_shift):
                        dv_b[d] = shifts_b[k + wp.static(L * d)]
                x_ab = separation(x_a, x_b, c.period)
                F = wp.where(n + k < end, c.slope_norm * slope(wp.length(x_ab) * c.inverse_h), real(0.0))
                grad = vV_b[k + wp.static(L * dim)] * F * x_ab
                if wp.static(options.density_follows):
                    rates[k] = rates[k] + wp.dot(dv_a - dv_b, grad)
                if wp.static(carries):
                    out_of_a = rho_a * wp.dot(dv_a, grad)
                    out_of_b = c.mass * F * wp.dot(dv_b, x_ab)
                for d in range(wp.static(dim)):
                    concentrations[k + wp.static(L) * d] = concentrations[k + wp.static(L) * d] + grad[d]
                    if wp.static(carries):
                        momentum = out_of_a * v_a[d] + out_of_b * v_b[d]
                        carried[k + wp.static(L) * d] = carried[k + wp.static(L) * d] + momentum
                    if wp.static(finds_surface):
                        for e in range(wp.static(dim)):
                            place = k + wp.static(L) * (wp.static(dim) * d + e)
                            moments[place] = moments[place] - x_ab[d] * grad[e]
                k += 1
            n += wp.static(L)
        n = int(end)
        end = ends[i, ends.shape[1] - 1]
        while n < end:
            b = take(neighbours, i, n, end)
            xp_b = records(position_pressure, b, 0)
            k = int(0)
            while k < wp.static(L):
                x_b = vector()
                for d in range(wp.static(dim)):
                    x_b[d] = xp_b[k + wp.static(L * d)]
                x_ab = separation(x_a, x_b, c.period)
                F = wp.where(n + k < end, c.slope_norm * slope(wp.length(x_ab) * c.inverse_h), real(0.0))
                grad = c.wall_volume * F * x_ab
                if wp.static(options.density_follows):
                    rates[k] = rates[k] + wp.dot(dv_a, grad)
                for d in range(wp.static(dim)):
                    concentrations[k + wp.static(L) * d] = concentrations[k + wp.static(L) * d] + grad[d]
                    if wp.static(finds_surface):
                        for e in range(wp.static(dim)):
                            place = k + wp.static(L) * (wp.static(dim) * d + e)
                            moments[place] = moments[place] - x_ab[d] * grad[e]
                k += 1
            n += wp.static(L)
        concentration = fold(concentrations)
        dt = real(clock[0])
        if wp.static(options.density_follows):
            time = real(wp.static(FOLLOWING_TIME)) * c.smoothing_length / c.sound_speed
            closing[i] = closing[i] + dt / (time + dt) * (fold_scalar(rates) - closing[i])
        if wp.static(finds_surface):
            coverage[i] = smallest_eigenvalue(fold_tensor(moments))
            next_shift[i] = bounded(
                c, -strength * c.smoothing_length * real(clock[wp.static(SPEED)]) * concentration, dt
            )
        else:
            push = real(2.0) * dt * strength * c.sound_speed * c.sound_speed
            next_shift[i] = bounded(c, -push * concentration, dt)
        if wp.static(carries):
            acceleration[i] = acceleration[i] + vV_a[dim] / c.mass * fold(carried)

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
        covered = real(coverage[i])
        outward_sums = sums_type()
        bareness = scalars_type()  # how much less than this one neighbours are covered
        end = ends[i, 0]
        n = int(0)
        while n < end:
            b = take(neighbours, i, n, end)
            xp_b = records(position_pressure, b, 0)
            vV_b = records(velocity_volume, b, 0)
            covered_b = numbers(coverage, b)
            k = int(0)
            while k < wp.static(L):
                x_b = vector()
                for d in range(wp.static(dim)):
                    x_b[d] = xp_b[k + wp.static(L * d)]
                x_ab = separation(x_a, x_b, c.period)
                V_b = wp.where(n + k < end, vV_b[k + wp.static(L * dim)], real(0.0))
                VF = V_b * slope(wp.length(x_ab) * c.inverse_h)
                barer = covered - covered_b[k]
                for d in range(wp.static(dim)):
                    outward_sums[k + wp.static(L) * d] = (
                        outward_sums[k + wp.static(L) * d] + barer * VF * x_ab[d]
                    )
                bareness[k] = wp.max(bareness[k], wp.where(real(0.0) > VF, barer, real(0.0)))
                k += 1
            n += wp.static(L)
        barest = real(0.0)
        k = int(0)
        while k < wp.static(L):
            barest = wp.max(barest, bareness[k])
            k += 1
        least = covered - barest
        outward = fold(outward_sums)
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
