"""How long fluid has been between the open boundaries."""

from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.options import FluidOptions


@cache
def make_grow_older(options: FluidOptions) -> Any:
    """Return the kernel `grow_older` specialised for the options."""

    @wp.kernel(module=options.module_of("residence"), enable_backward=False)
    def grow_older(
        offset: int,
        clock: wp.array(dtype=wp.float64),
        tag: wp.array(dtype=wp.int32),
        age: wp.array(dtype=wp.float64),
    ):
        """One particle: its age [s] after another step; in a buffer, where `tag` is a patch, it has none."""
        i = offset + wp.tid()
        age[i] = wp.where(tag[i] < 0, age[i] + clock[0], wp.float64(0.0))

    return grow_older
