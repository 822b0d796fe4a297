"""Observed order of convergence over resolutions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class ObservedOrder:
    """Exponent p of error ~ spacing^p; no standard error where two points leave nothing to judge by."""

    order: float
    standard_error: float | None


def observed_order(spacings: Sequence[float], errors: Sequence[float]) -> ObservedOrder | None:
    """Slope of log(error) over log(spacing) by least squares (Roache 1998, section 5.10.3, for two points).

    Errors that are zero or no number tell nothing and are left out; None if fewer than two spacings remain.
    """
    usable = [(h, e) for h, e in zip(spacings, errors, strict=True) if math.isfinite(e) and e > 0.0]
    if len({h for h, _ in usable}) < 2:
        return None
    log_h, log_e = np.log(np.array(usable)).T
    deviation = log_h - log_h.mean()
    slope = float(deviation @ log_e / (deviation @ deviation))
    return ObservedOrder(slope, _standard_error(deviation, log_e, slope))


def _standard_error(deviation: np.ndarray, log_e: np.ndarray, slope: float) -> float | None:
    freedom = len(log_e) - 2
    if freedom < 1:
        return None
    residual = log_e - log_e.mean() - slope * deviation
    return float(np.sqrt(residual @ residual / freedom / (deviation @ deviation)))
