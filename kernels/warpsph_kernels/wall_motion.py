"""Prescribed motion of wall particles."""

from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import make_narrow, make_packing, make_widen
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pose import make_pose_struct


@cache
def make_move(options: FluidOptions) -> Any:
    """Return the kernel that places wall particles."""
    arithmetic = options.arithmetic
    dim, real, vector = arithmetic.dimension, arithmetic.real, arithmetic.vector
    record, point = arithmetic.record, arithmetic.point
    pose_type = make_pose_struct(arithmetic)
    pack, _ = make_packing(arithmetic)
    narrow, widen = make_narrow(arithmetic), make_widen(arithmetic)

    @wp.kernel(module=options.module, enable_backward=False)
    def move(
        offset: int,
        first_wall: int,
        wall_volume: real,
        origin: point,
        poses: wp.array(dtype=pose_type),
        placed: wp.array(dtype=wp.int32),
        set_index: wp.array(dtype=wp.int32),
        reference: wp.array(dtype=point),
        reference_normal: wp.array(dtype=vector),
        position: wp.array(dtype=point),
        velocity_volume: wp.array(dtype=record),
        position_pressure: wp.array(dtype=record),
        position_density: wp.array(dtype=record),
        acceleration: wp.array(dtype=vector),
        normal: wp.array(dtype=vector),
    ):
        """One wall particle of a set to be placed: place it by the pose, with the exact velocity and acceleration."""
        i = offset + wp.tid()
        b = first_wall + i
        if placed[set_index[b]] == 0:
            return
        pose = poses[set_index[b]]
        X = reference[i]
        x = pose.rotation * X + pose.shift
        v = pose.rotation_rate * X + pose.shift_rate
        a = pose.rotation_acceleration * X + pose.shift_acceleration
        x_run = narrow(x, origin)
        zero = point()
        position[b] = x
        velocity_volume[b] = pack(narrow(v, zero), wall_volume)
        position_pressure[b] = pack(x_run, position_pressure[b][dim])
        position_density[b] = pack(x_run, position_density[b][dim])
        acceleration[b] = narrow(a, zero)
        normal[i] = narrow(pose.rotation * widen(reference_normal[i]), zero)

    return move
