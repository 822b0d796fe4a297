"""How often triangles wind round a point, and what they enclose."""

from __future__ import annotations

import numpy as np


def signed_volume(corners: np.ndarray) -> float:
    """Volume [m3] inside of closed triangles with corners (m, 3, 3) [m]; negative where they face inwards."""
    a, b, c = np.moveaxis(corners - corners[:1, :1], 1, 0)
    return float(np.einsum("ni,ni->", a, np.cross(b, c)) / 6.0)


def winding_number(corners: np.ndarray, point: np.ndarray) -> float:
    """How often triangles with corners (m, 3, 3) [m] wind round a point (3,) [m]: 1 inside of a closed surface, else 0.

    The sum of their solid angles over 4 pi (van Oosterom & Strackee 1983, eq. 8).
    """
    a, b, c = np.moveaxis(corners - point, 1, 0)
    la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
    above = np.einsum("ni,ni->n", a, np.cross(b, c))
    ab, bc, ca = (np.einsum("ni,ni->n", u, v) for u, v in ((a, b), (b, c), (c, a)))
    below = la * lb * lc + ab * lc + bc * la + ca * lb
    return float(np.arctan2(above, below).sum() / (2.0 * np.pi))
