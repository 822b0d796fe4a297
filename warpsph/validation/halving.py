"""What half the error would cost, from how error and particle-steps have gone with the resolution."""

from __future__ import annotations

import math
from dataclasses import dataclass

from warpsph.validation.study import Study

FORMAL_ORDER = 2.0
"""Of smoothing and of the time steps."""


@dataclass(frozen=True)
class HalvingCost:
    """Factor in particle-steps that halves the error, and its range within one standard error of the observed order.

    `range` is None where two resolutions leave nothing to judge by.
    """

    factor: float
    range: tuple[float, float] | None


def halving_cost(study: Study) -> HalvingCost | None:
    """2^(s / p) of error ~ spacing^p and particle-steps ~ spacing^-s; None where the error does not clearly fall.

    It falls clearly if the order exceeds its own standard error. Orders above that of the scheme come from errors that
    change their sign and promise nothing, so that p is at most 2 (Eca & Hoekstra 2014, section 3).
    """
    order, cost = study.order, study.cost_order
    if order is None or cost is None or cost.order >= 0.0:
        return None
    spread = order.standard_error or 0.0
    if order.order <= spread:
        return None
    low, factor, high = (
        _factor(-cost.order, p) for p in (order.order + spread, order.order, order.order - spread)
    )
    return HalvingCost(factor, None if order.standard_error is None else (low, high))


def _factor(cost_exponent: float, order: float) -> float:
    exponent = cost_exponent / min(order, FORMAL_ORDER)
    return 2.0**exponent if exponent < 1000.0 else math.inf
