"""Values of device functions at many arguments, for what the host needs of a formula that is written once."""

from __future__ import annotations

from typing import Any

import numpy as np
import warp as wp
from warpsph_kernels.tabulate import make_kernel_table


def tabulated(function: Any, argument: np.ndarray) -> np.ndarray:
    """Values of a device function of one double at arguments (n,), such as a part of a smoothing kernel."""
    return fill_table(make_kernel_table(function), argument)


def fill_table(table: Any, argument: np.ndarray, *more: Any) -> np.ndarray:
    """What the kernel (argument, *more, value) writes for arguments (n,) into values (n,), all double."""
    value = wp.zeros(len(argument), dtype=wp.float64, device="cpu")
    x = wp.array(argument, dtype=wp.float64, device="cpu")
    wp.launch(table, len(argument), inputs=[x, *more, value], device="cpu")
    return np.array(value.numpy())
