"""Least squares with a polynomial that is linear along a direction and quadratic across it, as flow in a channel is."""

from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic

SMALLEST_PIVOT = 1.0e-3
"""What is left of the mean square of a term that the terms before it do not explain, below which it is left out. With
lengths in h it is about 0.2 for linear terms inside of a fluid, and 0.01 for a quadratic one beside a wall."""


def fit_types(arithmetic: Arithmetic) -> tuple[Any, Any]:
    """Matrix of the moments of a fit, and of its right-hand sides: a column for the pressure and each velocity."""
    terms, fields = (4, 3) if arithmetic.dimension == 2 else (7, 4)
    return (
        wp.types.matrix((terms, terms), arithmetic.real),
        wp.types.matrix((terms, fields), arithmetic.real),
    )


@cache
def make_fit(arithmetic: Arithmetic) -> Any:
    """Return the device function `fit(moments, right) -> coefficients` of least squares: Gaussian elimination of a
    symmetric positive matrix, in which terms that the particles do not determine are left out."""
    real = arithmetic.real
    system, columns = fit_types(arithmetic)
    terms, fields = columns._shape_

    def fit(moments: system, right: columns):
        smallest = real(wp.static(SMALLEST_PIVOT)) * moments[0, 0]
        solved = columns()
        for k in range(wp.static(terms)):
            if moments[k, k] > smallest:
                for j in range(k + 1, wp.static(terms)):
                    factor = moments[j, k] / moments[k, k]
                    for m in range(k, wp.static(terms)):
                        moments[j, m] = moments[j, m] - factor * moments[k, m]
                    for f in range(wp.static(fields)):
                        right[j, f] = right[j, f] - factor * right[k, f]
        for back in range(wp.static(terms)):
            k = wp.static(terms - 1) - back
            if moments[k, k] > smallest:
                for f in range(wp.static(fields)):
                    rest = right[k, f]
                    for m in range(k + 1, wp.static(terms)):
                        rest -= moments[k, m] * solved[m, f]
                    solved[k, f] = rest / moments[k, k]
        return solved

    return wp.func(fit)
