"""Discretisation error of a figure from its values at two or three spacings (Richardson 1911)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np
from scipy.optimize import brentq

from warpsph.validation.halving import FORMAL_ORDER

ASSUMED_ORDER = 1.0
"""Where only two spacings are known: walls and free surfaces stand half a spacing off, to first order."""

SMALLEST_ORDER = 0.5
"""Below it a figure is not yet on its way to a limit (Oberkampf & Roy 2010)."""

LARGEST_ORDER = FORMAL_ORDER + 0.1
"""Above it the errors of two terms cancel at these spacings by chance (Eca & Hoekstra 2014)."""

OBSERVED_SAFETY, ASSUMED_SAFETY = 1.25, 3.0
"""Factors of safety of the grid convergence index with an observed and with an assumed order (Roache 1994)."""

ROUNDING = 1e-9
"""Relative differences below it say nothing about convergence."""

Behaviour = Literal["converging", "order assumed", "equal", "oscillating", "diverging", "slow"]

_LARGEST_ORDER = 20.0


@dataclass(frozen=True)
class Extrapolation:
    """What values at several spacings say about the one at the finest spacing [m].

    `error` and `uncertainty` are in the unit of the figure, root mean squares where it has several values. The
    uncertainty is the grid convergence index: the error times the factor of `safety`. `order` is the exponent that both
    rest on, `observed` that of three spacings; both are None where there is none. `limit` is the figure without
    discretisation, shape (values,), None where there is no order.
    """

    spacing: float
    behaviour: Behaviour
    scale: float
    error: float
    safety: float
    order: float | None = None
    observed: float | None = None
    limit: np.ndarray | None = None

    @property
    def uncertainty(self) -> float:
        """The grid convergence index, in the unit of the figure."""
        return self.error * self.safety

    @property
    def relies_on_observation(self) -> bool:
        """Whether the order is the observed one, as far as that is believed, and not an assumed one."""
        return self.order is not None and self.observed is not None and self.observed <= LARGEST_ORDER

    @property
    def order_uncertainty(self) -> float | None:
        """How far the observed order is off the formal one: three values leave no residual to judge it by."""
        return None if self.observed is None else abs(self.observed - FORMAL_ORDER)

    def error_of(self, figure: np.ndarray) -> float | None:
        """Distance of a figure from the limit, in its unit."""
        return None if self.limit is None else root_mean_square(figure - self.limit)

    def growth(self, spacing: float) -> float:
        """Factor from error and uncertainty at the finest spacing to those at another one [m].

        Raises ValueError where the figure does not converge.
        """
        if self.order is None:
            raise ValueError(f"there is no order: the figure is {self.behaviour}")
        return float((spacing / self.spacing) ** self.order)


def root_mean_square(values: np.ndarray) -> float:
    """Of values of shape (n,); the magnitude of a single one."""
    return float(np.sqrt(np.mean(np.square(values))))


def extrapolate(spacings: Sequence[float], figures: Sequence[np.ndarray]) -> Extrapolation:
    """The discretisation error at the finest of two or more spacings [m], coarse ones first.

    Each figure has shape (values,). Three spacings give the order, by the equation of Celik et al. (2008) for unequal
    ratios; two leave it to be assumed. Of more than three the finest three count. Changes that alternate or grow have
    no order: their error is taken from the range of the figures (Eca & Hoekstra 2014). Raises ValueError
    for fewer than two spacings, or spacings that do not fall.
    """
    spacings, figures = spacings[-3:], figures[-3:]
    ratios = [coarse / fine for coarse, fine in pairwise(spacings)]
    if not ratios or min(ratios) <= 1.0:
        raise ValueError(f"the spacings are {list(spacings)}; allowed: two or more, each finer than the last")
    changes = [fine - coarse for coarse, fine in pairwise(figures)]
    scale = root_mean_square(figures[-1])
    sizes = [root_mean_square(change) for change in changes]
    if max(sizes) <= ROUNDING * scale:
        return Extrapolation(
            spacings[-1], "equal", scale, 0.0, ASSUMED_SAFETY, ASSUMED_ORDER, limit=figures[-1]
        )
    if len(changes) == 1:
        return _with_order(spacings[-1], figures[-1], changes[-1], ratios[-1], None)
    observed = None
    if float(changes[0] @ changes[1]) > 0.0 and sizes[1] > ROUNDING * scale:
        observed = observed_richardson_order(sizes[0] / sizes[1], ratios[0], ratios[1])
    if observed is None or observed < SMALLEST_ORDER:
        return _without_order(spacings, figures, observed)
    return _with_order(spacings[-1], figures[-1], changes[-1], ratios[-1], observed)


def observed_richardson_order(change_ratio: float, coarse_ratio: float, fine_ratio: float) -> float:
    """p of f = f0 + C h^p, from the coarse change over the fine one and the ratios of spacings h3 / h2 and h2 / h1.

    (f3 - f2) / (f2 - f1) = r21^p (r32^p - 1) / (r21^p - 1), which rises with p (Celik et al. 2008, equation 3).
    """
    fine, coarse = math.log(fine_ratio), math.log(coarse_ratio)

    def excess(p: float) -> float:
        quotient = math.expm1(p * coarse) / math.expm1(p * fine) if p else coarse / fine
        return p * fine + math.log(quotient) - math.log(change_ratio)

    if excess(-_LARGEST_ORDER) >= 0.0:
        return -_LARGEST_ORDER
    if excess(_LARGEST_ORDER) <= 0.0:
        return _LARGEST_ORDER
    return float(brentq(excess, -_LARGEST_ORDER, _LARGEST_ORDER, xtol=1e-12))


def _with_order(
    spacing: float, finest: np.ndarray, change: np.ndarray, ratio: float, observed: float | None
) -> Extrapolation:
    """An order above the formal one promises nothing, so that it is replaced by the assumed one."""
    believed = observed if observed is not None and observed <= LARGEST_ORDER else None
    order = ASSUMED_ORDER if believed is None else min(believed, FORMAL_ORDER)
    correction = change / (ratio**order - 1.0)
    error = root_mean_square(correction)
    return Extrapolation(
        spacing=spacing,
        behaviour="order assumed" if observed is None else "converging",
        scale=root_mean_square(finest),
        error=error,
        safety=ASSUMED_SAFETY if believed is None else OBSERVED_SAFETY,
        order=order,
        observed=observed,
        limit=finest + correction,
    )


def _without_order(
    spacings: Sequence[float], figures: Sequence[np.ndarray], observed: float | None
) -> Extrapolation:
    pairs = [(a, b) for i, a in enumerate(figures) for b in figures[i + 1 :]]
    spread = max(root_mean_square(a - b) for a, b in pairs)
    error = spread / (spacings[0] / spacings[-1] - 1.0)
    behaviour: Behaviour = "oscillating" if observed is None else "slow" if observed > 0.0 else "diverging"
    scale = root_mean_square(figures[-1])
    return Extrapolation(spacings[-1], behaviour, scale, error, ASSUMED_SAFETY, observed=observed)
