"""Kernels of a weakly compressible fluid: momentum, continuity and the pointwise updates between them.

Records that the pair loops read: `position_pressure` (x, p), `position_density` (x, rho - rho0) and
`velocity_volume` (v, V). The rows of the neighbour list hold fluid in segment 0 and walls in segment 1.
"""

from functools import cache
from typing import Any, NamedTuple

import warp as wp

from warpsph_kernels.arithmetic import make_narrow, make_packing, make_separation, make_widen
from warpsph_kernels.lanes import make_lanes
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pair_terms import (
    DIFFUSIONS,
    PRESSURE_FORMS,
    VISCOSITIES,
    make_constants_struct,
)
from warpsph_kernels.smoothing import SMOOTHING_KERNELS
from warpsph_kernels.state import STATES
from warpsph_kernels.wall_barriers import BARRIERS


class FluidKernels(NamedTuple):
    """Kernels of the fluid, in the order of a step."""

    begin_step: Any
    accelerate: Any
    kick_and_drift: Any
    update_density: Any
    synchronise: Any


@cache
def make_pair_force(options: FluidOptions, viscous: bool) -> Any:
    """Return the device function `pair_force` of the particles a and b, divided by V_a V_b [N/m^(2 dim)].

    It changes its sign when a and b are exchanged, which is what conserves momentum to rounding. `v_ab` is the velocity
    difference that viscosity sees, `u_ab` that which a pressure form sees; they differ at walls.

    F, of the order of h^-(dim+2), comes last: in a scene of a micrometre its product with a pressure is beyond single
    precision, that with a pressure over h is not.
    """
    arithmetic = options.arithmetic
    real, vector = arithmetic.real, arithmetic.vector
    constants_type = make_constants_struct(arithmetic)
    _, slope = SMOOTHING_KERNELS[options.smoothing].make(arithmetic)
    pressure_term = PRESSURE_FORMS[options.pressure_form](arithmetic)
    viscous_term = VISCOSITIES[options.viscosity](arithmetic)

    def pair_force(c: constants_type, x_ab: vector, v_ab: vector, u_ab: vector, p_a: real, p_b: real):
        r2 = wp.dot(x_ab, x_ab)
        F = c.slope_norm * slope(wp.sqrt(r2) * c.inverse_h)
        pressure = pressure_term(c, x_ab, u_ab, r2, p_a, p_b)
        if wp.static(options.background_pressure):
            pressure += real(2.0) * c.background_pressure
        force = -pressure * x_ab
        if wp.static(viscous):
            force += viscous_term(c, x_ab, v_ab, r2)
        return F * force

    return wp.func(pair_force)


@cache
def make_pressure(options: FluidOptions) -> Any:
    """Return the device function `pressure` [Pa] of a density deviation: the state down to the tension cutoff."""
    arithmetic = options.arithmetic
    real = arithmetic.real
    constants_type = make_constants_struct(arithmetic)
    state = STATES[options.state].make(arithmetic)

    def pressure(c: constants_type, deviation: real):
        p = state(deviation, c.rest_density, c.sound_speed, c.state_parameters)
        if wp.static(options.tension_cutoff):
            p = wp.max(p, c.tension_cutoff)
        return p

    return wp.func(pressure)


@cache
def make_fluid_kernels(options: FluidOptions) -> FluidKernels:
    """Return the kernels of the fluid specialised for the options."""
    arithmetic = options.arithmetic
    dim, real, vector = arithmetic.dimension, arithmetic.real, arithmetic.vector
    record, point = arithmetic.record, arithmetic.point
    module = options.module
    constants_type = make_constants_struct(arithmetic)
    pack, unpack = make_packing(arithmetic)
    narrow, widen = make_narrow(arithmetic), make_widen(arithmetic)
    separation = make_separation(arithmetic, options.periodic)
    _, slope = SMOOTHING_KERNELS[options.smoothing].make(arithmetic)
    pressure = make_pressure(options)
    diffusion = DIFFUSIONS[options.density_diffusion](arithmetic)
    has_viscosity = options.viscosity != "none"
    fluid_force = make_pair_force(options, has_viscosity)
    wall_force = make_pair_force(options, has_viscosity and options.wall_friction)
    has_walls = options.wall != "none"
    shifts = options.particle_order != "none"
    barrier = BARRIERS[options.wall](arithmetic) if options.has_barrier else None
    lanes, L = make_lanes(arithmetic, options.lanes), options.lanes
    take, records, vectors, fold = lanes.take, lanes.records, lanes.vectors, lanes.fold
    sums_type, scalars_type, fold_scalar = lanes.sums, lanes.scalars, lanes.fold_scalar

    @wp.kernel(module=module, enable_backward=False)
    def begin_step(
        offset: int,
        c: constants_type,
        clock: wp.array(dtype=wp.float64),
        origin: point,
        density_rate: wp.array(dtype=real),
        shift: wp.array(dtype=vector),
        position: wp.array(dtype=point),
        density_deviation: wp.array(dtype=real),
        velocity_volume: wp.array(dtype=record),
        position_pressure: wp.array(dtype=record),
    ):
        """One particle: drift and update the density over half a step, then the pressure and the volume.

        `shift` [m/s] is what the particle's own velocity has beside that of the flow.
        """
        i = offset + wp.tid()
        half_step = wp.float64(0.5) * clock[0]
        v = unpack(velocity_volume[i])
        x = position[i] + half_step * widen(v)
        if wp.static(shifts):
            x += half_step * widen(shift[i])
        deviation = density_deviation[i] + real(half_step) * density_rate[i]
        position[i] = x
        density_deviation[i] = deviation
        velocity_volume[i] = pack(v, c.mass / (c.rest_density + deviation))
        position_pressure[i] = pack(narrow(x, origin), pressure(c, deviation))

    @wp.kernel(module=module, enable_backward=False)
    def synchronise(
        offset: int,
        c: constants_type,
        origin: point,
        position: wp.array(dtype=point),
        density_deviation: wp.array(dtype=real),
        velocity_volume: wp.array(dtype=record),
        position_pressure: wp.array(dtype=record),
        position_density: wp.array(dtype=record),
    ):
        """One particle: bring every record to the time of position and density, without advancing them."""
        i = offset + wp.tid()
        deviation = density_deviation[i]
        x = narrow(position[i], origin)
        position_pressure[i] = pack(x, pressure(c, deviation))
        position_density[i] = pack(x, deviation)
        velocity_volume[i] = pack(unpack(velocity_volume[i]), c.mass / (c.rest_density + deviation))

    @wp.kernel(module=module, enable_backward=False)
    def accelerate(
        offset: int,
        c: constants_type,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_pressure: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        friction: wp.array(dtype=record),
        wall_normal: wp.array(dtype=vector),
        first_wall: int,
        acceleration: wp.array(dtype=vector),
    ):
        """One particle: dv_a/dt = g + V_a/m_a sum_b V_b f_ab over fluid and walls.

        The pressure part in volume form is that of Colagrossi & Landrini (2003). `friction` holds the
        velocity that viscosity sees at a wall particle, and 1 where the wall is no-slip, else 0; `wall_normal` is zero
        behind the surface of a wall.
        """
        i = offset + wp.tid()
        xp_a = position_pressure[i]
        vV_a = velocity_volume[i]
        x_a, p_a = unpack(xp_a), xp_a[dim]
        v_a, V_a = unpack(vV_a), vV_a[dim]
        sums = sums_type()
        end = ends[i, 0]
        n = int(0)
        while n < end:
            b = take(neighbours, i, n, end)
            xp_b = records(position_pressure, b, 0)
            vV_b = records(velocity_volume, b, 0)
            k = int(0)
            while k < wp.static(L):
                x_b = vector()
                v_b = vector()
                for d in range(wp.static(dim)):
                    x_b[d] = xp_b[k + wp.static(L * d)]
                    v_b[d] = vV_b[k + wp.static(L * d)]
                V_b = wp.where(n + k < end, vV_b[k + wp.static(L * dim)], real(0.0))
                x_ab = separation(x_a, x_b, c.period)
                v_ab = v_a - v_b
                force = V_b * fluid_force(c, x_ab, v_ab, v_ab, p_a, xp_b[k + wp.static(L * dim)])
                for d in range(wp.static(dim)):
                    sums[k + wp.static(L * d)] = sums[k + wp.static(L * d)] + force[d]
                k += 1
            n += wp.static(L)
        if wp.static(has_walls):
            n = int(end)
            end = ends[i, 1]
            while n < end:
                b = take(neighbours, i, n, end)
                xp_b = records(position_pressure, b, 0)
                if wp.static(options.wall_friction):
                    friction_b = records(friction, b, first_wall)
                if wp.static(options.pressure_form == "riemann"):
                    vV_b = records(velocity_volume, b, 0)
                if wp.static(options.has_barrier):
                    normals = vectors(wall_normal, b, first_wall)
                k = int(0)
                while k < wp.static(L):
                    x_b = vector()
                    v_ab = vector()
                    u_ab = vector()
                    normal_b = vector()
                    for d in range(wp.static(dim)):
                        x_b[d] = xp_b[k + wp.static(L * d)]
                        if wp.static(options.wall_friction):
                            rough = friction_b[k + wp.static(L * dim)]
                            v_ab[d] = rough * (v_a[d] - friction_b[k + wp.static(L * d)])
                        if wp.static(options.pressure_form == "riemann"):
                            u_ab[d] = v_a[d] - vV_b[k + wp.static(L * d)]
                        if wp.static(options.has_barrier):
                            normal_b[d] = normals[k + wp.static(L * d)]
                    x_ab = separation(x_a, x_b, c.period)
                    force = wall_force(c, x_ab, v_ab, u_ab, p_a, xp_b[k + wp.static(L * dim)])
                    if wp.static(options.has_barrier):
                        force += barrier(c, x_ab, normal_b)
                    force *= wp.where(n + k < end, c.wall_volume, real(0.0))
                    for d in range(wp.static(dim)):
                        sums[k + wp.static(L * d)] = sums[k + wp.static(L * d)] + force[d]
                    k += 1
                n += wp.static(L)
        total = fold(sums)
        acceleration[i] = c.gravity + V_a / c.mass * total

    @wp.kernel(module=module, enable_backward=False)
    def kick_and_drift(
        offset: int,
        clock: wp.array(dtype=wp.float64),
        origin: point,
        acceleration: wp.array(dtype=vector),
        density_deviation: wp.array(dtype=real),
        next_shift: wp.array(dtype=vector),
        shift: wp.array(dtype=vector),
        position: wp.array(dtype=point),
        velocity_volume: wp.array(dtype=record),
        position_density: wp.array(dtype=record),
    ):
        """One particle: velocity over the whole step, position over its second half, with a new shift velocity."""
        i = offset + wp.tid()
        step = clock[0]
        vV = velocity_volume[i]
        v = unpack(vV) + real(step) * acceleration[i]
        x = position[i] + wp.float64(0.5) * step * widen(v)
        if wp.static(shifts):
            dv = next_shift[i]
            shift[i] = dv
            x += wp.float64(0.5) * step * widen(dv)
        position[i] = x
        velocity_volume[i] = pack(v, vV[dim])
        position_density[i] = pack(narrow(x, origin), density_deviation[i])

    @wp.kernel(module=module, enable_backward=False)
    def update_density(
        offset: int,
        c: constants_type,
        clock: wp.array(dtype=wp.float64),
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_density: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        density_gradient: wp.array(dtype=vector),
        closing: wp.array(dtype=real),
        density_rate: wp.array(dtype=real),
        density_deviation: wp.array(dtype=real),
    ):
        """One particle: drho_a/dt = rho_a sum_b V_b v_ab . grad_a W_ab + diffusion, then rho over half a step.

        The sum runs over fluid and walls, the diffusion over fluid only (Antuono et al. 2010), who also take away the
        mean of the pair's renormalised `density_gradient` [kg/m^(dim+1)]. `closing` [1/s] is the rate at which shifts
        bring particles together, where the density follows it.
        """
        i = offset + wp.tid()
        xd_a = position_density[i]
        x_a, deviation_a = unpack(xd_a), xd_a[dim]
        v_a = unpack(velocity_volume[i])
        divergences = scalars_type()
        diffusions = scalars_type()
        gradient_a = vector()
        if wp.static(options.density_diffusion == "delta_sph"):
            gradient_a = vector(density_gradient[i])
        end = ends[i, 0]
        n = int(0)
        while n < end:
            b = take(neighbours, i, n, end)
            xd_b = records(position_density, b, 0)
            vV_b = records(velocity_volume, b, 0)
            if wp.static(options.density_diffusion == "delta_sph"):
                gradients = vectors(density_gradient, b, 0)
            k = int(0)
            while k < wp.static(L):
                x_b = vector()
                v_b = vector()
                gradient_b = vector()
                for d in range(wp.static(dim)):
                    x_b[d] = xd_b[k + wp.static(L * d)]
                    v_b[d] = vV_b[k + wp.static(L * d)]
                    if wp.static(options.density_diffusion == "delta_sph"):
                        gradient_b[d] = gradients[k + wp.static(L * d)]
                V_b = wp.where(n + k < end, vV_b[k + wp.static(L * dim)], real(0.0))
                x_ab = separation(x_a, x_b, c.period)
                VF = V_b * c.slope_norm * slope(wp.length(x_ab) * c.inverse_h)
                divergences[k] = divergences[k] + VF * wp.dot(v_a - v_b, x_ab)
                excess = diffusion(c, x_ab, deviation_a, xd_b[k + wp.static(L * dim)])
                if wp.static(options.density_diffusion == "delta_sph"):
                    excess -= wp.dot(gradient_a + gradient_b, x_ab)
                if wp.static(options.density_diffusion != "none"):
                    diffusions[k] = diffusions[k] + VF * excess
                k += 1
            n += wp.static(L)
        if wp.static(has_walls):
            n = int(end)
            end = ends[i, 1]
            while n < end:
                b = take(neighbours, i, n, end)
                xd_b = records(position_density, b, 0)
                vV_b = records(velocity_volume, b, 0)
                k = int(0)
                while k < wp.static(L):
                    x_b = vector()
                    v_b = vector()
                    for d in range(wp.static(dim)):
                        x_b[d] = xd_b[k + wp.static(L * d)]
                        v_b[d] = vV_b[k + wp.static(L * d)]
                    V_b = wp.where(n + k < end, c.wall_volume, real(0.0))
                    x_ab = separation(x_a, x_b, c.period)
                    F = c.slope_norm * slope(wp.length(x_ab) * c.inverse_h)
                    divergences[k] = divergences[k] + V_b * F * wp.dot(v_a - v_b, x_ab)
                    k += 1
                n += wp.static(L)
        divergence = fold_scalar(divergences)
        diffused = fold_scalar(diffusions)
        if wp.static(options.density_follows):
            divergence += closing[i]
        rate = (c.rest_density + deviation_a) * divergence + c.diffusion * diffused
        density_rate[i] = rate
        density_deviation[i] = deviation_a + real(wp.float64(0.5) * clock[0]) * rate

    return FluidKernels(begin_step, accelerate, kick_and_drift, update_density, synchronise)
