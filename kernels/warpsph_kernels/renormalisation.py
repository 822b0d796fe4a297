"""Renormalised first derivatives: sums over an incomplete support that are exact for linear fields.

With the moment matrix M_a = sum_b V_b (x_b - x_a) (x) grad_a W_ab, the sum S_a = sum_b V_b (f_b - f_a) (x) grad_a W_ab
of a linear field f is grad f M_a; so grad f = S_a M_a^-1 (Randles & Libersky 1996; Bonet & Lok 1999).
"""

from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic

SMALLEST_EIGENVALUE = 0.2
"""Geometric mean of the eigenvalues of a moment matrix (one inside of a fluid, about a half across a flat surface, a
third in a corner) below which a particle has too few neighbours on one side for its gradient to mean anything."""


@cache
def make_correction(arithmetic: Arithmetic) -> Any:
    """Return the device function `correction(moment) -> matrix`, the inverse of the moment matrix.

    Where the matrix is nearly singular the result is the identity: the sum stays as it is.
    """
    matrix, real = arithmetic.matrix, arithmetic.real
    dim = arithmetic.dimension

    def correction(moment: matrix):
        inverse = wp.identity(n=wp.static(dim), dtype=real)
        if wp.determinant(moment) > real(wp.static(SMALLEST_EIGENVALUE**dim)):
            inverse = wp.inverse(moment)
        return inverse

    return wp.func(correction)
