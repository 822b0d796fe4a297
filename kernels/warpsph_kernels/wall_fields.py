"""Fields of no-slip walls that are computed from a state for output only: viscous force and wall shear stress."""

from functools import cache
from typing import Any, NamedTuple

import warp as wp

from warpsph_kernels.arithmetic import make_packing, make_separation
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pair_terms import VISCOSITIES, make_constants_struct
from warpsph_kernels.smoothing import SMOOTHING_KERNELS

SMALLEST_DETERMINANT = 1.0e-6
"""Of the moments of the fit at a wall, over those of a neighbour at one h in every direction; below it the neighbours
do not determine a gradient. Full half supports have some 1e-4."""


class WallFieldKernels(NamedTuple):
    """Kernels of output fields; each stands alone."""

    find_viscous_force: Any
    find_shear_stress: Any


@cache
def make_wall_field_kernels(options: FluidOptions) -> WallFieldKernels:
    """Return the kernels of the fields of walls specialised for the options."""
    arithmetic = options.arithmetic
    dim, real, vector, record = arithmetic.dimension, arithmetic.real, arithmetic.vector, arithmetic.record
    unknowns = wp.types.vector(dim + 1, real)
    moments = wp.types.matrix((dim + 1, dim + 1), real)
    velocities = wp.types.matrix((dim + 1, dim), real)
    module = options.module_of("wall_fields")
    constants_type = make_constants_struct(arithmetic)
    pack, unpack = make_packing(arithmetic)
    separation = make_separation(arithmetic, options.periodic)
    shape, slope = SMOOTHING_KERNELS[options.smoothing].make(arithmetic)
    viscous_term = VISCOSITIES[options.viscosity](arithmetic)

    @wp.kernel(module=module, enable_backward=False)
    def find_viscous_force(
        offset: int,
        c: constants_type,
        first_wall: int,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_pressure: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        friction: wp.array(dtype=record),
        force: wp.array(dtype=vector),
    ):
        """One wall particle: the viscous part of the force of the fluid on it [N], pair by pair as the fluid has it."""
        i = offset + wp.tid()
        x_w = unpack(position_pressure[first_wall + i])
        total = vector()
        if wp.static(options.wall_friction):
            for n in range(ends[i, 0]):
                b = neighbours[i, n]
                vV_b = velocity_volume[b]
                x_wb = separation(x_w, unpack(position_pressure[b]), c.period)
                r2 = wp.dot(x_wb, x_wb)
                v_wb = friction[i][dim] * (unpack(friction[i]) - unpack(vV_b))
                F = c.slope_norm * slope(wp.sqrt(r2) * c.inverse_h)
                total += vV_b[dim] * F * viscous_term(c, x_wb, v_wb, r2)
        force[i] = c.wall_volume * total

    @wp.kernel(module=module, enable_backward=False)
    def find_shear_stress(
        offset: int,
        c: constants_type,
        first_wall: int,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_pressure: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        friction: wp.array(dtype=record),
        normal: wp.array(dtype=vector),
        stress: wp.array(dtype=vector),
    ):
        """One particle at the surface of a no-slip wall: mu (1 - n n) dv/dn [Pa], what the fluid does to it.

        The velocity is fitted by moving least squares (Lancaster & Salkauskas 1981) about the point half a spacing
        before the particle, where it is that of the wall: v = v_w + G x + q (n . x)^2. So it is exact for what is
        linear along the wall and parabolic across it. Zero behind the surface, at free-slip walls and where the fluid
        does not determine it.
        """
        i = offset + wp.tid()
        n_w = normal[i]
        x_s = unpack(position_pressure[first_wall + i]) + real(0.5) / c.inverse_spacing * n_w
        v_s = unpack(velocity_volume[first_wall + i])
        moment = moments()
        sums = velocities()
        weights = real(0.0)
        for n in range(ends[i, 0]):
            b = neighbours[i, n]
            vV_b = velocity_volume[b]
            x = c.inverse_h * separation(unpack(position_pressure[b]), x_s, c.period)
            weight = shape(wp.length(x)) * vV_b[dim]
            across = wp.dot(x, n_w)
            basis = unknowns(pack(x, across * across))
            moment += weight * wp.outer(basis, basis)
            sums += weight * wp.outer(basis, unpack(vV_b) - v_s)
            weights += weight
        shear = vector()
        if weights > real(0.0) and friction[i][dim] > real(0.0) and wp.length_sq(n_w) > real(0.5):
            moment = moment / weights
            if wp.determinant(moment) > real(wp.static(SMALLEST_DETERMINANT)):
                gradients = wp.transpose(sums / weights) * wp.inverse(moment)
                change = gradients * pack(n_w, real(0.0))
                shear = c.dynamic_viscosity * c.inverse_h * (change - wp.dot(change, n_w) * n_w)
        stress[i] = shear

    return WallFieldKernels(find_viscous_force, find_shear_stress)
