"""Kernels of the viscous stress: from the velocity gradient to the stress, and its divergence as a force.

Of the stress mu (G + G^T - 2/3 tr(G) I) the part mu G is summed pair by pair, 2 mu_ab v_ab F with the mean viscosity of
the pair (Morris, Fox & Zhu 1997): two first derivatives in a row would not see a velocity that changes its sign
from one particle to the next. The rest, and all of a sub-particle-scale stress, is the divergence of a tensor.
"""

from functools import cache
from typing import Any, NamedTuple

import warp as wp

from warpsph_kernels.arithmetic import make_packing, make_separation
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pair_terms import make_constants_struct
from warpsph_kernels.renormalisation import make_correction
from warpsph_kernels.rheology import (
    make_stress_struct,
    make_sub_particle_stress,
    make_transposed_stress,
    make_viscosity,
)
from warpsph_kernels.smoothing import SMOOTHING_KERNELS


class StressKernels(NamedTuple):
    """Kernels of the stress, in the order of a step."""

    find_stress: Any
    add_divergence: Any
    react: Any


@cache
def make_stress_kernels(options: FluidOptions) -> StressKernels:
    """Return the kernels of the viscous stress specialised for the options."""
    arithmetic = options.arithmetic
    dim, real, vector, matrix = arithmetic.dimension, arithmetic.real, arithmetic.vector, arithmetic.matrix
    record = arithmetic.record
    module = options.module_of("stress")
    constants_type, stress_type = make_constants_struct(arithmetic), make_stress_struct(arithmetic)
    _, unpack = make_packing(arithmetic)
    separation = make_separation(arithmetic, options.periodic)
    _, slope = SMOOTHING_KERNELS[options.smoothing].make(arithmetic)
    correction = make_correction(arithmetic)
    turbulent = options.stress == "sub_particle_scale"
    turbulent_stress = make_sub_particle_stress(arithmetic)
    viscosity_of = make_viscosity(arithmetic, "newtonian" if turbulent else options.stress)
    transposed_stress = make_transposed_stress(arithmetic)

    @wp.kernel(module=module, enable_backward=False)
    def find_stress(
        offset: int,
        c: constants_type,
        s: stress_type,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_pressure: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        friction: wp.array(dtype=record),
        first_wall: int,
        carried: wp.array(dtype=real),
        viscosity: wp.array(dtype=real),
        stress: wp.array(dtype=matrix),
    ):
        """One particle: the renormalised velocity gradient over fluid and no-slip walls, viscosity and stress [Pa].

        `carried` is the viscosity [Pa s] that each particle carries, or a single value for all.
        """
        i = offset + wp.tid()
        x_a, vV_a = unpack(position_pressure[i]), velocity_volume[i]
        v_a = unpack(vV_a)
        gradient = matrix()
        moment = matrix()
        end = ends[i, 0]
        for n in range(end):
            b = neighbours[i, n]
            vV_b = velocity_volume[b]
            x_ab = separation(x_a, unpack(position_pressure[b]), c.period)
            grad = vV_b[dim] * c.slope_norm * slope(wp.length(x_ab) * c.inverse_h) * x_ab
            gradient += wp.outer(unpack(vV_b) - v_a, grad)
            moment -= wp.outer(x_ab, grad)
        if wp.static(options.wall_friction):
            for n in range(end, ends[i, 1]):
                b = neighbours[i, n]
                friction_b = friction[b - first_wall]
                x_ab = separation(x_a, unpack(position_pressure[b]), c.period)
                F = c.slope_norm * slope(wp.length(x_ab) * c.inverse_h)
                grad = friction_b[dim] * c.wall_volume * F * x_ab
                gradient += wp.outer(unpack(friction_b) - v_a, grad)
                moment -= wp.outer(x_ab, grad)
        gradient = gradient * correction(moment)
        if wp.static(turbulent):
            stress[i] = turbulent_stress(s, gradient, c.mass / vV_a[dim])
        else:
            mu = viscosity_of(s, gradient, carried[wp.min(i, carried.shape[0] - 1)])
            viscosity[i] = mu
            stress[i] = transposed_stress(mu, gradient)

    @wp.kernel(module=module, enable_backward=False)
    def add_divergence(
        offset: int,
        c: constants_type,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_pressure: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        friction: wp.array(dtype=record),
        first_wall: int,
        viscosity: wp.array(dtype=real),
        stress: wp.array(dtype=matrix),
        acceleration: wp.array(dtype=vector),
    ):
        """One particle: dv_a/dt += V_a/m_a sum_b V_b [(tau_a + tau_b) x_ab + (mu_a + mu_b) v_ab] F.

        A no-slip wall has the stress and the viscosity of the particle. The pair force changes its sign when a and b
        are exchanged.
        """
        i = offset + wp.tid()
        x_a = unpack(position_pressure[i])
        vV_a = velocity_volume[i]
        v_a = unpack(vV_a)
        tau_a = stress[i]
        mu_a = real(0.0)
        if wp.static(not turbulent):
            mu_a = viscosity[i]
        total = vector()
        end = ends[i, 0]
        for n in range(end):
            b = neighbours[i, n]
            x_ab = separation(x_a, unpack(position_pressure[b]), c.period)
            F = c.slope_norm * slope(wp.length(x_ab) * c.inverse_h)
            vV_b = velocity_volume[b]
            pair = (tau_a + stress[b]) * x_ab
            if wp.static(not turbulent):
                pair += (mu_a + viscosity[b]) * (v_a - unpack(vV_b))
            total += vV_b[dim] * F * pair
        if wp.static(options.wall_friction):
            for n in range(end, ends[i, 1]):
                b = neighbours[i, n]
                x_ab = separation(x_a, unpack(position_pressure[b]), c.period)
                F = c.slope_norm * slope(wp.length(x_ab) * c.inverse_h)
                friction_b = friction[b - first_wall]
                pair = tau_a * x_ab
                if wp.static(not turbulent):
                    pair += mu_a * (v_a - unpack(friction_b))
                total += friction_b[dim] * c.wall_volume * F * real(2.0) * pair
        acceleration[i] = acceleration[i] + vV_a[dim] / c.mass * total

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
        viscosity: wp.array(dtype=real),
        stress: wp.array(dtype=matrix),
        force: wp.array(dtype=vector),
    ):
        """One wall particle: add the force of the fluid's stress on it [N], the opposite of what the fluid receives."""
        i = offset + wp.tid()
        x_w = unpack(position_pressure[first_wall + i])
        total = vector()
        for n in range(ends[i, 0]):
            b = neighbours[i, n]
            x_wb = separation(x_w, unpack(position_pressure[b]), c.period)
            F = c.slope_norm * slope(wp.length(x_wb) * c.inverse_h)
            vV_b = velocity_volume[b]
            pair = stress[b] * x_wb
            if wp.static(not turbulent):
                pair += viscosity[b] * (unpack(friction[i]) - unpack(vV_b))
            total += vV_b[dim] * F * real(2.0) * pair
        force[i] = force[i] + friction[i][dim] * c.wall_volume * total

    return StressKernels(find_stress, add_divergence, react)
