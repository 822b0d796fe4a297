"""The pose of a rigid motion on the device."""

from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic


@cache
def make_pose_struct(arithmetic: Arithmetic) -> Any:
    """Return the struct of a motion x = A X + b at one time, with the first and second time derivatives of A and b."""
    dim, point = arithmetic.dimension, arithmetic.point
    matrix = wp.types.matrix((dim, dim), wp.float64)

    class Pose:
        pass

    Pose.__annotations__ = {
        "rotation": matrix,
        "shift": point,
        "rotation_rate": matrix,
        "shift_rate": point,
        "rotation_acceleration": matrix,
        "shift_acceleration": point,
    }
    return wp.struct(Pose)
