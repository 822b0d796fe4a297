"""Tables with a row a particle, in the layout that suits the device."""

from __future__ import annotations

from typing import Any

import numpy as np
import warp as wp


def row_array(values: np.ndarray, dtype: Any, device: Any) -> wp.array:
    """Return values (rows, columns, ...) as a two-dimensional device array.

    A CPU core reads its row from end to end, a GPU warp reads the same column of 32 rows at once.
    """
    if not wp.get_device(device).is_cuda:
        return wp.array(np.ascontiguousarray(values), dtype=dtype, ndim=2, device=device)
    columns = np.ascontiguousarray(np.swapaxes(values, 0, 1))
    return wp.array(columns, dtype=dtype, ndim=2, device=device).transpose()
