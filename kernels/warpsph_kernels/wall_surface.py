"""The surface of walls: which wall particles lie at it, and its normal there."""

from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import make_separation
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pair_terms import make_constants_struct
from warpsph_kernels.smoothing import SMOOTHING_KERNELS


@cache
def make_surface_kernels(options: FluidOptions) -> tuple[Any, Any]:
    """Return the kernels `find_normals` and `keep_surface`, which run in this order once."""
    arithmetic = options.arithmetic
    real, vector = arithmetic.real, arithmetic.vector
    constants_type = make_constants_struct(arithmetic)
    separation = make_separation(arithmetic, options.periodic)
    _, slope = SMOOTHING_KERNELS[options.smoothing].make(arithmetic)

    @wp.kernel(module=options.module, enable_backward=False)
    def find_normals(
        offset: int,
        c: constants_type,
        first_wall: int,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        listed_position: wp.array(dtype=vector),
        normal: wp.array(dtype=vector),
    ):
        """One wall particle: the unit vector away from the other wall particles, -sum_b V_b grad W_ab normalised.

        Here the rows hold walls, as also for `keep_surface`.
        """
        i = offset + wp.tid()
        x_a = listed_position[first_wall + i]
        gradient = vector()
        for n in range(ends[i, 0]):
            x_ab = separation(x_a, listed_position[neighbours[i, n]], c.period)
            gradient += slope(wp.length(x_ab) * c.inverse_h) * x_ab
        normal[i] = -wp.normalize(gradient)

    @wp.kernel(module=options.module, enable_backward=False)
    def keep_surface(
        offset: int,
        c: constants_type,
        spacing: real,
        first_wall: int,
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
        listed_position: wp.array(dtype=vector),
        normal: wp.array(dtype=vector),
    ):
        """One wall particle: forget the normal if another lies around the point one spacing along it.

        The test by an empty place ahead is that of Marrone et al. (2010), for free surfaces.
        """
        i = offset + wp.tid()
        ahead = listed_position[first_wall + i] + spacing * normal[i]
        is_surface = bool(True)
        for n in range(ends[i, 0]):
            gap = separation(ahead, listed_position[neighbours[i, n]], c.period)
            if wp.length(gap) < real(0.85) * spacing:
                is_surface = False
        if not is_surface:
            normal[i] = vector()

    return find_normals, keep_surface
