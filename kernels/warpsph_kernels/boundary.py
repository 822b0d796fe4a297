"""Kernels of walls: pressure and velocity seen by the fluid, and the force on a wall.

A wall particle's row of the neighbour list holds fluid in segment 0.
"""

from functools import cache
from typing import Any, NamedTuple

import warp as wp

from warpsph_kernels.arithmetic import make_packing, make_separation
from warpsph_kernels.fluid import make_pair_force, make_pressure
from warpsph_kernels.lanes import make_lanes
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pair_terms import make_constants_struct
from warpsph_kernels.smoothing import SMOOTHING_KERNELS
from warpsph_kernels.wall_barriers import BARRIERS


class WallKernels(NamedTuple):
    """Kernels of walls, in the order of a step."""

    extrapolate: Any
    set_pressure: Any
    update_density: Any
    react: Any


@cache
def make_wall_kernels(options: FluidOptions) -> WallKernels:
    """Return the kernels of walls specialised for the options."""
    arithmetic = options.arithmetic
    dim, real, vector = arithmetic.dimension, arithmetic.real, arithmetic.vector
    record = arithmetic.record
    module = options.module
    constants_type = make_constants_struct(arithmetic)
    pack, unpack = make_packing(arithmetic)
    separation = make_separation(arithmetic, options.periodic)
    shape, slope = SMOOTHING_KERNELS[options.smoothing].make(arithmetic)
    pressure_of = make_pressure(options)
    has_viscosity = options.viscosity != "none"
    wall_force = make_pair_force(options, has_viscosity and options.wall_friction)
    barrier = BARRIERS[options.wall](arithmetic) if options.has_barrier else None
    lanes, L = make_lanes(arithmetic, options.lanes), options.lanes
    take, records, numbers = lanes.take, lanes.records, lanes.numbers
    sums_type, scalars_type, fold, fold_scalar = lanes.sums, lanes.scalars, lanes.fold, lanes.fold_scalar

    @wp.kernel(module=module, enable_backward=False)
    def extrapolate(
        offset: int,
        c: constants_type,
        first_wall: int,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        density_deviation: wp.array(dtype=real),
        acceleration: wp.array(dtype=vector),
        velocity_volume: wp.array(dtype=record),
        friction: wp.array(dtype=record),
        position_pressure: wp.array(dtype=record),
    ):
        """One wall particle: pressure and friction velocity from the fluid (Adami, Hu & Adams 2012, eqs. 23, 27).

        Repulsive walls leave out the hydrostatic part: their pressure is the mean of Liu, Shao & Chang (2012).
        """
        i = offset + wp.tid()
        w = first_wall + i
        xp_w = position_pressure[w]
        x_w = unpack(xp_w)
        weights = scalars_type()
        pressures = scalars_type()
        moments = sums_type()
        velocities = sums_type()
        end = ends[i, 0]
        n = int(0)
        while n < end:
            b = take(neighbours, i, n, end)
            xp_b = records(position_pressure, b, 0)
            deviations = numbers(density_deviation, b)
            if wp.static(options.wall_friction):
                vV_b = records(velocity_volume, b, 0)
            k = int(0)
            while k < wp.static(L):
                x_b = vector()
                for d in range(wp.static(dim)):
                    x_b[d] = xp_b[k + wp.static(L * d)]
                x_wb = separation(x_w, x_b, c.period)
                W = wp.where(n + k < end, c.norm * shape(wp.length(x_wb) * c.inverse_h), real(0.0))
                weights[k] = weights[k] + W
                pressures[k] = pressures[k] + W * xp_b[k + wp.static(L * dim)]
                m = W * (c.rest_density + deviations[k])
                for d in range(wp.static(dim)):
                    moments[k + wp.static(L * d)] = moments[k + wp.static(L * d)] + m * x_wb[d]
                    if wp.static(options.wall_friction):
                        carried = W * vV_b[k + wp.static(L * d)]
                        velocities[k + wp.static(L * d)] = velocities[k + wp.static(L * d)] + carried
                k += 1
            n += wp.static(L)
        weight = fold_scalar(weights)
        pressure = fold_scalar(pressures)
        moment = fold(moments)
        p_w = real(0.0)
        v_seen = unpack(velocity_volume[w])
        # A neighbour at the rim of the support has no weight in single precision: there is nothing to average.
        if weight > real(1.0e-6) * c.norm:
            p_w = pressure / weight
            if wp.static(options.wall != "repulsive"):
                p_w += wp.dot(c.gravity - acceleration[w], moment) / weight
            if wp.static(not options.wall_suction):
                p_w = wp.max(p_w, real(0.0))
            if wp.static(options.tension_cutoff):
                p_w = wp.max(p_w, c.tension_cutoff)
            if wp.static(options.wall_friction):
                v_seen = real(2.0) * v_seen - fold(velocities) / weight
        position_pressure[w] = pack(x_w, p_w)
        if wp.static(options.wall_friction):
            friction[i] = pack(v_seen, friction[i][dim])

    @wp.kernel(module=module, enable_backward=False)
    def set_pressure(
        offset: int,
        c: constants_type,
        clock: wp.array(dtype=wp.float64),
        first_wall: int,
        half_steps: real,
        density_rate: wp.array(dtype=real),
        velocity_volume: wp.array(dtype=record),
        friction: wp.array(dtype=record),
        density_deviation: wp.array(dtype=real),
        position_pressure: wp.array(dtype=record),
    ):
        """One dynamic wall particle: density over half a step (none if half_steps = 0), then the pressure.

        The density is kept at or above rest, so that a wall does not pull the fluid (Crespo, Gomez-Gesteira &
        Dalrymple 2007 describe the method; the floor is common practice).
        """
        i = offset + wp.tid()
        w = first_wall + i
        change = real(wp.float64(0.5) * clock[0]) * half_steps * density_rate[w]
        deviation = wp.max(density_deviation[w] + change, real(0.0))
        density_deviation[w] = deviation
        position_pressure[w] = pack(unpack(position_pressure[w]), pressure_of(c, deviation))
        if wp.static(options.wall_friction):
            friction[i] = pack(unpack(velocity_volume[w]), friction[i][dim])

    @wp.kernel(module=module, enable_backward=False)
    def update_density(
        offset: int,
        c: constants_type,
        clock: wp.array(dtype=wp.float64),
        first_wall: int,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_density: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        density_rate: wp.array(dtype=real),
        density_deviation: wp.array(dtype=real),
    ):
        """One dynamic wall particle: the continuity equation with the fluid around it, over half a step."""
        i = offset + wp.tid()
        w = first_wall + i
        x_w = unpack(position_density[w])
        v_w = unpack(velocity_volume[w])
        divergence = real(0.0)
        for n in range(ends[i, 0]):
            b = neighbours[i, n]
            vV_b = velocity_volume[b]
            x_wb = separation(x_w, unpack(position_density[b]), c.period)
            F = c.slope_norm * slope(wp.length(x_wb) * c.inverse_h)
            divergence += vV_b[dim] * F * wp.dot(v_w - unpack(vV_b), x_wb)
        rate = (c.rest_density + density_deviation[w]) * divergence
        density_rate[w] = rate
        change = real(wp.float64(0.5) * clock[0]) * rate
        density_deviation[w] = wp.max(density_deviation[w] + change, real(0.0))

    @wp.kernel(module=module, enable_backward=False)
    def react(
        offset: int,
        c: constants_type,
        first_wall: int,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_pressure: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        friction: wp.array(dtype=record),
        normal: wp.array(dtype=vector),
        force: wp.array(dtype=vector),
    ):
        """One wall particle: the force of the fluid on it [N], pair by pair the opposite of what the fluid receives."""
        i = offset + wp.tid()
        xp_w = position_pressure[first_wall + i]
        x_w, p_w = unpack(xp_w), xp_w[dim]
        total = vector()
        for n in range(ends[i, 0]):
            b = neighbours[i, n]
            xp_b = position_pressure[b]
            vV_b = velocity_volume[b]
            x_wb = separation(x_w, unpack(xp_b), c.period)
            v_wb = vector()
            if wp.static(options.wall_friction):
                v_wb = friction[i][dim] * (unpack(friction[i]) - unpack(vV_b))
            u_wb = vector()
            if wp.static(options.pressure_form == "riemann"):
                u_wb = unpack(velocity_volume[first_wall + i]) - unpack(vV_b)
            pair = wall_force(c, x_wb, v_wb, u_wb, p_w, xp_b[dim])
            if wp.static(options.has_barrier):
                pair -= barrier(c, -x_wb, normal[i])
            total += vV_b[dim] * pair
        force[i] = c.wall_volume * total

    return WallKernels(extrapolate, set_pressure, update_density, react)
