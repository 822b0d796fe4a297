"""Open boundaries: values at stations on their patches, and what the particles behind them are given.

A patch has the normal n into the domain; d = (x - center) . n is the depth inside, negative in the buffer. Particles in
a buffer carry the index of its patch as `tag`, others -1.
"""

from functools import cache
from typing import Any, NamedTuple

import warp as wp

from warpsph_kernels.arithmetic import make_packing, make_separation
from warpsph_kernels.cells import make_cell_functions, make_grid_struct
from warpsph_kernels.channel_fit import fit_types, make_fit
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pair_terms import make_constants_struct
from warpsph_kernels.patch import FULL, make_across, make_below_level, make_patch_struct
from warpsph_kernels.smoothing import SMOOTHING_KERNELS
from warpsph_kernels.state import STATES

VELOCITY, PRESSURE, ZERO_GRADIENT, NON_REFLECTING = range(4)
"""Kinds of open boundaries."""
SMALLEST_COVERAGE = 0.25
"""Part of the support of a station that fluid fills, from which on more than a mean is fitted."""
COVERED_DEPTH = 1.6
"""Depth below a surface, in smoothing lengths, from which on a particle has its full coverage."""
NEWTON_STEPS = 4
"""From a pressure to its density: the first guess is off by a few per cent, and each step squares the error. What is
out of all range is left to what stops such a run."""


class OpenBoundaryKernels(NamedTuple):
    """Kernels of open boundaries, in the order of a step."""

    find_inside: Any
    average: Any
    decide: Any
    impose: Any
    hold_motion: Any
    hold_density: Any
    cover: Any


@cache
def make_open_boundary_kernels(options: FluidOptions) -> OpenBoundaryKernels:
    """Return the kernels of open boundaries specialised for the options."""
    arithmetic = options.arithmetic
    dim, real, vector = arithmetic.dimension, arithmetic.real, arithmetic.vector
    record = arithmetic.record
    terms = 4 if dim == 2 else 7
    column = wp.types.vector(terms, real)
    pair, counts_type = wp.types.vector(2, real), wp.types.vector(2, wp.int32)
    patch_type = make_patch_struct(options)
    constants_type, grid_type = make_constants_struct(arithmetic), make_grid_struct(arithmetic)
    pack, unpack = make_packing(arithmetic)
    separation = make_separation(arithmetic, options.periodic)
    shape, _ = SMOOTHING_KERNELS[options.smoothing].make(arithmetic)
    wrap, cell_of, row_base = make_cell_functions(arithmetic)
    state = STATES[options.state].make(arithmetic)
    stiffening = STATES[options.state].make_stiffening(arithmetic)
    fit = make_fit(arithmetic)
    system, columns = fit_types(arithmetic)
    rows = 3 ** (dim - 1)
    across, below_level = make_across(options), make_below_level(options)
    module = options.module_of("open_boundary")

    @wp.func
    def deviation_of(p: real, c: constants_type):
        deviation = p / (c.sound_speed * c.sound_speed)
        for _ in range(wp.static(NEWTON_STEPS)):
            excess = state(deviation, c.rest_density, c.sound_speed, c.state_parameters) - p
            slope = stiffening(deviation, c.rest_density, c.sound_speed, c.state_parameters)
            deviation -= excess / (c.sound_speed * c.sound_speed * slope)
            deviation = wp.clamp(deviation, real(-0.9) * c.rest_density, real(0.9) * c.rest_density)
        return deviation

    @wp.func
    def basis_of(patch: patch_type, y: vector):
        """1, n, s, s^2; in three dimensions 1, n, s, t, s^2, t^2, s t; of a way y over h."""
        basis = column()
        basis[0] = real(1.0)
        basis[1] = wp.dot(y, patch.normal)
        s = across(patch, y)
        basis[2] = s[0]
        if wp.static(dim == 2):
            basis[3] = s[0] * s[0]
        else:
            basis[3] = s[1]
            basis[4] = s[0] * s[0]
            basis[wp.static(terms - 2)] = s[1] * s[1]
            basis[wp.static(terms - 1)] = s[0] * s[1]
        return basis

    @wp.kernel(module=module, enable_backward=False)
    def find_inside(
        offset: int,
        c: constants_type,
        grid: grid_type,
        start: wp.array(dtype=wp.int32),
        patches: wp.array(dtype=patch_type),
        patch_of: wp.array(dtype=wp.int32),
        place: wp.array(dtype=vector),
        tag: wp.array(dtype=wp.int32),
        position_pressure: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        inside: wp.array(dtype=record),
        slope: wp.array(dtype=real),
        filling: wp.array(dtype=real),
    ):
        """One station: velocity and pressure of the fluid inside, the pressure carried on to the patch.

        `place` lies one smoothing length inside. There a polynomial, linear along the normal and quadratic across it,
        is fitted to the particles of the domain, without those of buffers, by least squares with the weights V_b W_b
        (moving least squares, Lancaster & Salkauskas 1981): exact for the parabola of a channel, which a linear one
        would make lower, and what enters would brake the flow. `slope` is dp/dn, `filling` the part of the support that
        fluid fills. The cells are those of the last lists:
        no particle has moved more than half the skin since.
        """
        i = offset + wp.tid()
        x_g = place[i]
        patch = patches[patch_of[i]]
        moments = system()
        right = columns()
        cell = cell_of(x_g, grid)
        for row in range(wp.static(rows)):
            base = row_base(cell, row, grid)
            for r in range(3):
                bucket = base + wrap(cell[0] - 1 + r, grid.cells[0])
                for b in range(start[bucket], start[bucket + 1]):
                    if tag[b] < 0:
                        xp_b = position_pressure[b]
                        x_bg = -separation(x_g, unpack(xp_b), c.period) * c.inverse_h
                        vV_b = velocity_volume[b]
                        weight = vV_b[wp.static(dim)] * c.norm * shape(wp.length(x_bg))
                        if weight > real(0.0):
                            basis = basis_of(patch, x_bg)
                            values = record()
                            for k in range(wp.static(dim)):
                                values[k] = vV_b[k]
                            values[wp.static(dim)] = xp_b[wp.static(dim)]
                            moments += weight * wp.outer(basis, basis)
                            right += weight * wp.outer(basis, values)
        found = record()
        dp = real(0.0)
        # A neighbour at the rim of the support has no weight in single precision: there is nothing to fit.
        if moments[0, 0] > real(wp.static(SMALLEST_COVERAGE)):
            solved = fit(moments, right)
            for k in range(wp.static(dim + 1)):
                found[k] = solved[0, k]
            dp = solved[1, wp.static(dim)] * c.inverse_h
            found[wp.static(dim)] = found[wp.static(dim)] - dp * c.smoothing_length
        elif moments[0, 0] > real(1.0e-6):
            for k in range(wp.static(dim + 1)):
                found[k] = right[0, k] / moments[0, 0]
        inside[i] = found
        slope[i] = dp
        filling[i] = moments[0, 0]

    @wp.kernel(module=module, enable_backward=False)
    def average(
        offset: int,
        patches: wp.array(dtype=patch_type),
        weight: wp.array(dtype=real),
        hydrostatic: wp.array(dtype=real),
        inside: wp.array(dtype=record),
        mean_pressure: wp.array(dtype=real),
    ):
        """One patch: mean pressure of the fluid inside over its stations, beside that of a water level [Pa]."""
        k = offset + wp.tid()
        patch = patches[k]
        total = real(0.0)
        for j in range(patch.counts[0] * patch.counts[1]):
            i = patch.first_station + j
            total += weight[i] * (inside[i][wp.static(dim)] - hydrostatic[i])
        mean_pressure[k] = total / patch.area

    @wp.kernel(module=module, enable_backward=False)
    def decide(
        offset: int,
        c: constants_type,
        clock: wp.array(dtype=wp.float64),
        patches: wp.array(dtype=patch_type),
        patch_of: wp.array(dtype=wp.int32),
        prescribed: wp.array(dtype=record),
        inside: wp.array(dtype=record),
        filling: wp.array(dtype=real),
        lower: wp.array(dtype=wp.int32),
        hydrostatic: wp.array(dtype=real),
        mean_pressure: wp.array(dtype=real),
        undisturbed: wp.array(dtype=vector),
        imposed: wp.array(dtype=record),
    ):
        """One station: velocity and pressure on the patch, from what is prescribed and what the fluid inside has.

        Fluid enters along the normal unless its velocity is prescribed. non_reflecting: with u along the normal and
        the undisturbed u_0, p_0, the wave that leaves is J = p - p_0 - rho c (u - u_0), and the one that enters is
        nought, so that p = p_0 + J / 2 and u = u_0 - J / (2 rho c) (Lastiwka, Basa & Quinlan 2009); u_0 is a running
        mean (Negi, Ramachandran & Haftu 2020). `lower`: the next station below in a section with a water level, else
        -1. A station above the surface takes the velocity of the highest one in fluid: a particle at the surface lies
        between the two. The pressure of a level is `hydrostatic`, negative above it; where the velocity is prescribed
        the fluid inside may stand higher or lower, and its mean is kept.
        """
        i = offset + wp.tid()
        k = patch_of[i]
        patch = patches[k]
        wet = i
        while filling[wet] < real(wp.static(SMALLEST_COVERAGE)) and lower[wet] >= 0:
            wet = lower[wet]
        v, p = unpack(inside[wet]), inside[i][wp.static(dim)]
        step = real(clock[0])
        if patch.kind == wp.static(VELOCITY):
            v = unpack(prescribed[i])
        else:
            if patch.kind == wp.static(PRESSURE):
                p = prescribed[i][wp.static(dim)]
            if patch.kind == wp.static(ZERO_GRADIENT):
                p -= patch.relaxation * (mean_pressure[k] - patch.pressure)
            if patch.kind == wp.static(NON_REFLECTING):
                rho_c = c.rest_density * c.sound_speed
                still = v
                if step > real(0.0):
                    still = undisturbed[i] + step / (patch.averaging_time + step) * (v - undisturbed[i])
                undisturbed[i] = still
                wave = p - patch.pressure - rho_c * wp.dot(v - still, patch.normal)
                change = -wave / (real(2.0) * rho_c) - wp.dot(v - still, patch.normal)
                p = patch.pressure + real(0.5) * wave
                v += change * patch.normal
            u = wp.dot(v, patch.normal)
            if u > real(0.0):
                v = u * patch.normal
        if patch.level < real(wp.static(FULL)):
            p = hydrostatic[i]
            if patch.kind == wp.static(VELOCITY):
                p += mean_pressure[k]
        imposed[i] = pack(v, p)

    @wp.kernel(module=module, enable_backward=False)
    def impose(
        offset: int,
        c: constants_type,
        patches: wp.array(dtype=patch_type),
        tagged: wp.array(dtype=wp.int32),
        tag: wp.array(dtype=wp.int32),
        imposed: wp.array(dtype=record),
        slope: wp.array(dtype=real),
        velocity_volume: wp.array(dtype=record),
        density_deviation: wp.array(dtype=real),
        position_pressure: wp.array(dtype=record),
    ):
        """One particle of a buffer: velocity, pressure and density, linear between stations and along the normal; with
        a water level the pressure does not change along the normal, and is nought above the surface."""
        i = tagged[offset + wp.tid()]
        patch = patches[tag[i]]
        x = unpack(position_pressure[i])
        away = separation(x, patch.center, c.period)
        s = across(patch, away)
        low = counts_type()
        part = pair()
        for k in range(wp.static(dim - 1)):
            g = (s[k] + patch.half[k]) / patch.cell[k] - real(0.5)
            low[k] = wp.clamp(int(wp.floor(g)), 0, wp.max(patch.counts[k] - 2, 0))
            part[k] = wp.clamp(g - real(low[k]), real(-0.5), real(1.5))
        values = record()
        steepness = real(0.0)
        for corner in range(wp.static(2 ** (dim - 1))):
            first = wp.min(low[0] + corner % 2, patch.counts[0] - 1)
            second = wp.min(low[1] + corner // 2, patch.counts[1] - 1)
            w = wp.where(corner % 2 == 0, real(1.0) - part[0], part[0])
            w *= wp.where(corner // 2 == 0, real(1.0) - part[1], part[1])
            station = patch.first_station + first * patch.counts[1] + second
            values += w * imposed[station]
            steepness += w * slope[station]
        p = values[wp.static(dim)] + steepness * wp.dot(away, patch.normal)
        if patch.level < real(wp.static(FULL)):
            p = wp.max(values[wp.static(dim)], real(0.0))
        deviation = deviation_of(p, c)
        density_deviation[i] = deviation
        velocity_volume[i] = pack(unpack(values), c.mass / (c.rest_density + deviation))
        position_pressure[i] = pack(x, p)

    @wp.kernel(module=module, enable_backward=False)
    def hold_motion(
        offset: int,
        patches: wp.array(dtype=patch_type),
        tagged: wp.array(dtype=wp.int32),
        tag: wp.array(dtype=wp.int32),
        shifts: int,
        velocity_volume: wp.array(dtype=record),
        acceleration: wp.array(dtype=vector),
        next_shift: wp.array(dtype=vector),
    ):
        """One particle of a buffer: no force changes its velocity. Where particles are shifted, it moves along the
        patch no faster than it leaves: nothing spreads what the flow along a patch brings together where it turns back,
        while what leaves faster is gone before.
        """
        i = tagged[offset + wp.tid()]
        acceleration[i] = vector()
        if shifts > 0:
            v = unpack(velocity_volume[i])
            normal = patches[tag[i]].normal
            along = v - wp.dot(v, normal) * normal
            leaving = wp.max(-wp.dot(v, normal), real(0.0))
            kept = wp.min(leaving / wp.max(wp.length(along), real(1.0e-20)), real(1.0))
            next_shift[i] = (kept - real(1.0)) * along

    @wp.kernel(module=module, enable_backward=False)
    def hold_density(
        offset: int,
        tagged: wp.array(dtype=wp.int32),
        position_density: wp.array(dtype=record),
        density_rate: wp.array(dtype=real),
        density_deviation: wp.array(dtype=real),
    ):
        """One particle of a buffer: the density that was imposed, which its record still holds, and no rate."""
        i = tagged[offset + wp.tid()]
        density_rate[i] = real(0.0)
        density_deviation[i] = position_density[i][wp.static(dim)]

    @wp.kernel(module=module, enable_backward=False)
    def cover(
        offset: int,
        c: constants_type,
        patches: wp.array(dtype=patch_type),
        tagged: wp.array(dtype=wp.int32),
        tag: wp.array(dtype=wp.int32),
        position_pressure: wp.array(dtype=record),
        coverage: wp.array(dtype=real),
    ):
        """One particle of a buffer: the fluid goes on behind it, so that it belongs to no surface but that at the level
        of its patch, where it has the coverage of a particle in a half-space of fluid, to 0.04: one half at the
        surface, one from 1.6 h below."""
        i = tagged[offset + wp.tid()]
        patch = patches[tag[i]]
        s = below_level(patch, separation(unpack(position_pressure[i]), patch.center, c.period))
        part = wp.clamp(s * c.inverse_h / real(wp.static(COVERED_DEPTH)), real(0.0), real(1.0))
        coverage[i] = real(0.5) + real(0.5) * part * part * (real(3.0) - real(2.0) * part)

    return OpenBoundaryKernels(
        find_inside,
        average,
        decide,
        impose,
        hold_motion,
        hold_density,
        cover,
    )
