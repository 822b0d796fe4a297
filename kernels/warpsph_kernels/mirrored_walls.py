"""Modified dynamic walls (English et al. 2022): a wall particle looks at its mirror point in the fluid.

There pressure and velocity are interpolated to first order, and the pressure goes on linearly to the wall particle.
English et al. do so with the density; the pressure differs by (gamma - 1) / 2 (rho/rho0 - 1)^2 and asks for no state.
"""

from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import make_packing, make_separation
from warpsph_kernels.cells import make_cell_functions, make_grid_struct
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pair_terms import make_constants_struct
from warpsph_kernels.pose import make_pose_struct
from warpsph_kernels.smoothing import SMOOTHING_KERNELS

SMALLEST_DETERMINANT = 1.0e-3
"""Of the matrix of moments, one inside the fluid; below it the mean by the kernel's weights has to do."""


@cache
def make_look_into_mirror(options: FluidOptions) -> Any:
    """Return the kernel `look_into_mirror` specialised for the options."""
    arithmetic = options.arithmetic
    dim, real, vector = arithmetic.dimension, arithmetic.real, arithmetic.vector
    record = arithmetic.record
    unknowns = dim + 1
    system = wp.types.matrix((unknowns, unknowns), real)
    column = wp.types.vector(unknowns, real)
    columns = wp.types.matrix((unknowns, unknowns), real)  # the pressure and the velocity's components
    constants_type = make_constants_struct(arithmetic)
    grid_type, pose_type = make_grid_struct(arithmetic), make_pose_struct(arithmetic)
    pack, unpack = make_packing(arithmetic)
    separation = make_separation(arithmetic, options.periodic)
    shape, slope = SMOOTHING_KERNELS[options.smoothing].make(arithmetic)
    wrap, cell_of, row_base = make_cell_functions(arithmetic)
    rows = 3 ** (dim - 1)

    @wp.func
    def turned(pose: pose_type, v: vector):
        out = vector()
        for j in range(wp.static(dim)):
            for k in range(wp.static(dim)):
                out[j] += real(pose.rotation[j, k]) * v[k]
        return out

    @wp.func
    def moments_of(c: constants_type, x_bg: vector):
        """W, then h grad W, of a particle at x_bg from the mirror point; and the basis 1, x_bg / h."""
        q = wp.length(x_bg) * c.inverse_h
        test = column()
        basis = column()
        test[0] = c.norm * shape(q)
        basis[0] = real(1.0)
        for k in range(wp.static(dim)):
            test[k + 1] = c.slope_norm * slope(q) * c.smoothing_length * x_bg[k]
            basis[k + 1] = x_bg[k] * c.inverse_h
        return test, basis

    @wp.func
    def interpolated(left: system, right: columns):
        """Values in the first row, h times their gradients below; the mean and no gradient where those are unknown."""
        fields = columns()
        if wp.abs(wp.determinant(left)) > real(wp.static(SMALLEST_DETERMINANT)):
            fields = wp.inverse(left) * right
        else:
            for k in range(wp.static(unknowns)):
                fields[0, k] = right[0, k] / left[0, 0]
        return fields

    @wp.kernel(module=f"{options.module}_mirror", enable_backward=False)
    def look_into_mirror(
        offset: int,
        c: constants_type,
        first_wall: int,
        grid: grid_type,
        start: wp.array(dtype=wp.int32),
        poses: wp.array(dtype=pose_type),
        set_index: wp.array(dtype=wp.int32),
        mirror: wp.array(dtype=vector),
        velocity_volume: wp.array(dtype=record),
        friction: wp.array(dtype=record),
        position_pressure: wp.array(dtype=record),
    ):
        """One wall particle: pressure and friction velocity from the fluid around its mirror point.

        `mirror` is the way to that point when the wall stands where it began [m]. The cells are those of the last
        lists: no particle has moved more than half the skin since. Values and gradients at the point solve
        sum_b V_b (W, h grad W) (1, x_bg / h) . (f, h grad f) = sum_b V_b (W, h grad W) f_b (Liu & Liu 2006).
        """
        i = offset + wp.tid()
        w = first_wall + i
        x_w = unpack(position_pressure[w])
        v_w = unpack(velocity_volume[w])
        way = turned(poses[set_index[w]], mirror[i])
        x_g = x_w + way
        left = system()
        right = columns()
        cell = cell_of(x_g, grid)
        for row in range(wp.static(rows)):
            base = row_base(cell, row, grid)
            for r in range(3):
                bucket = base + wrap(cell[0] - 1 + r, grid.cells[0])
                for b in range(start[bucket], start[bucket + 1]):
                    xp_b = position_pressure[b]
                    x_bg = -separation(x_g, unpack(xp_b), c.period)
                    test, basis = moments_of(c, x_bg)
                    if test[0] > real(0.0):
                        vV_b = velocity_volume[b]
                        values = column()
                        values[0] = xp_b[wp.static(dim)]
                        for k in range(wp.static(dim)):
                            values[k + 1] = vV_b[k]
                        left += vV_b[wp.static(dim)] * wp.outer(test, basis)
                        right += vV_b[wp.static(dim)] * wp.outer(test, values)
        p_w = real(0.0)
        v_seen = v_w
        # A neighbour at the rim of the support has no weight in single precision: there is nothing to interpolate.
        if left[0, 0] > real(1.0e-6):
            fields = interpolated(left, right)
            p_w = fields[0, 0]
            for k in range(wp.static(dim)):
                p_w -= fields[k + 1, 0] * way[k] * c.inverse_h
            if wp.static(not options.wall_suction):
                p_w = wp.max(p_w, real(0.0))
            if wp.static(options.tension_cutoff):
                p_w = wp.max(p_w, c.tension_cutoff)
            if wp.static(options.wall_friction):
                for k in range(wp.static(dim)):
                    v_seen[k] = real(2.0) * v_w[k] - fields[0, k + 1]
        position_pressure[w] = pack(x_w, p_w)
        if wp.static(options.wall_friction):
            friction[i] = pack(v_seen, friction[i][wp.static(dim)])

    return look_into_mirror
