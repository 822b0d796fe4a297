"""Corrected first derivatives of pressure and velocity: passes that add what a form has beyond the plain sums.

`renormalised`: each particle's kernel gradient is multiplied by the inverse L_a of its moment matrix (Randles &
Libersky 1996; Bonet & Lok 1999). The pressure force of a pair of fluid particles is (p_a L_a + p_b L_b) grad W, which
changes its sign when the pair is exchanged; pairs with walls stay as they are. `finite_particle`: value and gradient
together solve a linear system (Liu, Xie & Liu 2005), exact for linear fields on any support, without any symmetry.
"""

from functools import cache
from typing import Any, NamedTuple

import warp as wp

from warpsph_kernels.arithmetic import make_packing, make_separation
from warpsph_kernels.lanes import make_lanes
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pair_terms import make_constants_struct
from warpsph_kernels.renormalisation import SMALLEST_EIGENVALUE, make_correction
from warpsph_kernels.smoothing import SMOOTHING_KERNELS


class CorrectionKernels(NamedTuple):
    """Kernels of a corrected gradient, in the order of a step."""

    find_correction: Any
    correct_pressure: Any
    correct_divergence: Any


@cache
def make_renormalised_kernels(options: FluidOptions) -> CorrectionKernels:
    """Return the kernels of the renormalised form specialised for the options."""
    arithmetic = options.arithmetic
    dim, real, vector, matrix = arithmetic.dimension, arithmetic.real, arithmetic.vector, arithmetic.matrix
    record = arithmetic.record
    module = options.module_of("gradient_correction")
    constants_type = make_constants_struct(arithmetic)
    _, unpack = make_packing(arithmetic)
    separation = make_separation(arithmetic, options.periodic)
    _, slope = SMOOTHING_KERNELS[options.smoothing].make(arithmetic)
    correction_of = make_correction(arithmetic)
    lanes, L = make_lanes(arithmetic, options.lanes), options.lanes
    take, records, matrices = lanes.take, lanes.records, lanes.matrices
    sums_type, tensors_type, fold, fold_tensor = lanes.sums, lanes.tensors, lanes.fold, lanes.fold_tensor

    @wp.kernel(module=module, enable_backward=False)
    def find_correction(
        offset: int,
        c: constants_type,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_pressure: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        excess: wp.array(dtype=matrix),
    ):
        """One particle: L_a - I over fluid and walls."""
        i = offset + wp.tid()
        x_a = unpack(position_pressure[i])
        moments = tensors_type()
        end = ends[i, ends.shape[1] - 1]
        n = int(0)
        while n < end:
            b = take(neighbours, i, n, end)
            xp_b = records(position_pressure, b, 0)
            vV_b = records(velocity_volume, b, 0)
            k = int(0)
            while k < wp.static(L):
                x_b = vector()
                for d in range(wp.static(dim)):
                    x_b[d] = xp_b[k + wp.static(L * d)]
                V_b = wp.where(n + k < end, vV_b[k + wp.static(L * dim)], real(0.0))
                x_ab = separation(x_a, x_b, c.period)
                grad = V_b * c.slope_norm * slope(wp.length(x_ab) * c.inverse_h) * x_ab
                for d in range(wp.static(dim)):
                    for e in range(wp.static(dim)):
                        place = k + wp.static(L) * (wp.static(dim) * d + e)
                        moments[place] = moments[place] - x_ab[d] * grad[e]
                k += 1
            n += wp.static(L)
        excess[i] = correction_of(fold_tensor(moments)) - wp.identity(n=wp.static(dim), dtype=real)

    @wp.kernel(module=module, enable_backward=False)
    def correct_pressure(
        offset: int,
        c: constants_type,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_pressure: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        excess: wp.array(dtype=matrix),
        acceleration: wp.array(dtype=vector),
    ):
        """One particle: dv_a/dt -= V_a/m_a sum_b V_b [p_a (L_a - I) + p_b (L_b - I)] grad W_ab over the fluid."""
        i = offset + wp.tid()
        xp_a = position_pressure[i]
        x_a = unpack(xp_a)
        own = xp_a[dim] * excess[i]
        sums = sums_type()
        end = ends[i, 0]
        n = int(0)
        while n < end:
            b = take(neighbours, i, n, end)
            xp_b = records(position_pressure, b, 0)
            vV_b = records(velocity_volume, b, 0)
            excesses = matrices(excess, b, 0)
            k = int(0)
            while k < wp.static(L):
                x_b = vector()
                for d in range(wp.static(dim)):
                    x_b[d] = xp_b[k + wp.static(L * d)]
                p_b = xp_b[k + wp.static(L * dim)]
                V_b = wp.where(n + k < end, vV_b[k + wp.static(L * dim)], real(0.0))
                x_ab = separation(x_a, x_b, c.period)
                grad = V_b * c.slope_norm * slope(wp.length(x_ab) * c.inverse_h) * x_ab
                for d in range(wp.static(dim)):
                    for e in range(wp.static(dim)):
                        both = own[d, e] + p_b * excesses[k + wp.static(L) * (wp.static(dim) * d + e)]
                        sums[k + wp.static(L) * d] = sums[k + wp.static(L) * d] + both * grad[e]
                k += 1
            n += wp.static(L)
        acceleration[i] = acceleration[i] - velocity_volume[i][dim] / c.mass * fold(sums)

    @wp.kernel(module=module, enable_backward=False)
    def correct_divergence(
        offset: int,
        c: constants_type,
        clock: wp.array(dtype=wp.float64),
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_density: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        density_rate: wp.array(dtype=real),
        density_deviation: wp.array(dtype=real),
    ):
        """One particle: the divergence of the velocity with L_a in place of without, in rate and density."""
        i = offset + wp.tid()
        xd_a = position_density[i]
        x_a, v_a = unpack(xd_a), unpack(velocity_volume[i])
        gradients = tensors_type()
        moments = tensors_type()
        end = ends[i, ends.shape[1] - 1]
        n = int(0)
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
                V_b = wp.where(n + k < end, vV_b[k + wp.static(L * dim)], real(0.0))
                x_ab = separation(x_a, x_b, c.period)
                grad = V_b * c.slope_norm * slope(wp.length(x_ab) * c.inverse_h) * x_ab
                v_ba = v_b - v_a
                for d in range(wp.static(dim)):
                    for e in range(wp.static(dim)):
                        place = k + wp.static(L) * (wp.static(dim) * d + e)
                        gradients[place] = gradients[place] + v_ba[d] * grad[e]
                        moments[place] = moments[place] - x_ab[d] * grad[e]
                k += 1
            n += wp.static(L)
        gradient = fold_tensor(gradients)
        beyond = wp.trace(gradient * correction_of(fold_tensor(moments))) - wp.trace(gradient)
        rate = -(c.rest_density + xd_a[dim]) * beyond
        density_rate[i] = density_rate[i] + rate
        density_deviation[i] = density_deviation[i] + real(wp.float64(0.5) * clock[0]) * rate

    return CorrectionKernels(find_correction, correct_pressure, correct_divergence)


@cache
def make_finite_particle_kernels(options: FluidOptions) -> CorrectionKernels:
    """Return the kernels of the finite-particle form specialised for the options; there is nothing to find first."""
    arithmetic = options.arithmetic
    dim, real, vector = arithmetic.dimension, arithmetic.real, arithmetic.vector
    record = arithmetic.record
    module = options.module_of("gradient_correction")
    constants_type = make_constants_struct(arithmetic)
    pack, unpack = make_packing(arithmetic)
    separation = make_separation(arithmetic, options.periodic)
    shape, slope = SMOOTHING_KERNELS[options.smoothing].make(arithmetic)
    fields_type = wp.types.matrix((dim + 1, dim), real)
    smallest = SMALLEST_EIGENVALUE ** (dim + 1)

    @wp.kernel(module=module, enable_backward=False)
    def correct_pressure(
        offset: int,
        c: constants_type,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_pressure: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        acceleration: wp.array(dtype=vector),
    ):
        """One particle: the pressure gradient of the finite-particle form in place of the symmetric one.

        Rows of the system are the moments with W and with h grad W, its columns the value and h times the gradient.
        """
        i = offset + wp.tid()
        xp_a = position_pressure[i]
        x_a, p_a, V_a = unpack(xp_a), xp_a[dim], velocity_volume[i][dim]
        h = c.smoothing_length
        own = V_a * c.norm * shape(real(0.0))
        system = wp.outer(pack(vector(), own), pack(vector(), real(1.0)))
        right = pack(vector(), own * p_a)
        plain = vector()
        for n in range(ends[i, ends.shape[1] - 1]):
            b = neighbours[i, n]
            xp_b = position_pressure[b]
            x_ab = separation(x_a, unpack(xp_b), c.period)
            q = wp.length(x_ab) * c.inverse_h
            V_b = velocity_volume[b][dim]
            grad = V_b * c.slope_norm * slope(q) * x_ab
            test = pack(h * grad, V_b * c.norm * shape(q))
            system += wp.outer(test, pack(-c.inverse_h * x_ab, real(1.0)))
            right += xp_b[dim] * test
            plain += (p_a + xp_b[dim]) * grad
        if wp.determinant(system) > real(wp.static(smallest)):
            gradient = c.inverse_h * unpack(wp.inverse(system) * right)
            acceleration[i] = acceleration[i] + V_a / c.mass * (plain - gradient)

    @wp.kernel(module=module, enable_backward=False)
    def correct_divergence(
        offset: int,
        c: constants_type,
        clock: wp.array(dtype=wp.float64),
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        position_density: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        density_rate: wp.array(dtype=real),
        density_deviation: wp.array(dtype=real),
    ):
        """One particle: the divergence of the velocity in the finite-particle form, in rate and density."""
        i = offset + wp.tid()
        xd_a, vV_a = position_density[i], velocity_volume[i]
        x_a, v_a = unpack(xd_a), unpack(vV_a)
        h = c.smoothing_length
        own = vV_a[dim] * c.norm * shape(real(0.0))
        system = wp.outer(pack(vector(), own), pack(vector(), real(1.0)))
        # Velocities relative to the particle's own, so that a uniform one has no rounding.
        right = fields_type()
        plain = real(0.0)
        for n in range(ends[i, ends.shape[1] - 1]):
            b = neighbours[i, n]
            vV_b = velocity_volume[b]
            x_ab = separation(x_a, unpack(position_density[b]), c.period)
            q = wp.length(x_ab) * c.inverse_h
            grad = vV_b[dim] * c.slope_norm * slope(q) * x_ab
            test = pack(h * grad, vV_b[dim] * c.norm * shape(q))
            v_ba = unpack(vV_b) - v_a
            system += wp.outer(test, pack(-c.inverse_h * x_ab, real(1.0)))
            right += wp.outer(test, v_ba)
            plain += wp.dot(v_ba, grad)
        if wp.determinant(system) > real(wp.static(smallest)):
            solution = wp.inverse(system) * right
            divergence = real(0.0)
            for k in range(wp.static(dim)):
                divergence += c.inverse_h * solution[k, k]
            rate = -(c.rest_density + xd_a[dim]) * (divergence - plain)
            density_rate[i] = density_rate[i] + rate
            density_deviation[i] = density_deviation[i] + real(wp.float64(0.5) * clock[0]) * rate

    return CorrectionKernels(None, correct_pressure, correct_divergence)
