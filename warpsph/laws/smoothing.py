"""Smoothing kernels on the host: their support, norm and shape, by the name that a scene uses."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class SmoothingLaw:
    """W = alpha_d h^-d f(r/h) in d dimensions.

    support: radius in units of h; alpha: alpha_d by dimension; shape: f(q) of an array q >= 0.
    """

    support: float
    alpha: Mapping[int, float]
    shape: Callable[[np.ndarray], np.ndarray]

    def value(self, q: np.ndarray, dimension: int) -> np.ndarray:
        """h^dimension W at q = r/h, zero beyond the support."""
        return self.alpha[dimension] * np.where(q < self.support, self.shape(q), 0.0)


def wendland_c2(q: np.ndarray) -> np.ndarray:
    """Wendland (1995), psi_3,1."""
    return np.maximum(1.0 - 0.5 * q, 0.0) ** 4 * (2.0 * q + 1.0)


def wendland_c4(q: np.ndarray) -> np.ndarray:
    """Wendland (1995), psi_4,2."""
    return np.maximum(1.0 - 0.5 * q, 0.0) ** 6 * (35.0 / 12.0 * q**2 + 3.0 * q + 1.0)


def cubic_spline(q: np.ndarray) -> np.ndarray:
    """Monaghan & Lattanzio (1985)."""
    return 0.25 * np.maximum(2.0 - q, 0.0) ** 3 - np.maximum(1.0 - q, 0.0) ** 3


def quintic_spline(q: np.ndarray) -> np.ndarray:
    """Morris, Fox & Zhu (1997)."""
    wide, middle, narrow = (np.maximum(k - q, 0.0) ** 5 for k in (3.0, 2.0, 1.0))
    return wide - 6.0 * middle + 15.0 * narrow


def gaussian(q: np.ndarray) -> np.ndarray:
    """Gingold & Monaghan (1977), cut off at the support."""
    return np.exp(-(q**2))


def _gaussian_alpha(cut: float) -> dict[int, float]:
    """One over the integral of exp(-q^2) over the disc and the ball of radius `cut`."""
    edge = math.exp(-(cut**2))
    ball = math.pi**1.5 * math.erf(cut) - 2.0 * math.pi * cut * edge
    return {2: 1.0 / (math.pi * (1.0 - edge)), 3: 1.0 / ball}


SMOOTHING_LAWS: dict[str, SmoothingLaw] = {
    "wendland_c2": SmoothingLaw(
        2.0, {2: 7.0 / (4.0 * math.pi), 3: 21.0 / (16.0 * math.pi)}, shape=wendland_c2
    ),
    "wendland_c4": SmoothingLaw(
        2.0, {2: 9.0 / (4.0 * math.pi), 3: 495.0 / (256.0 * math.pi)}, shape=wendland_c4
    ),
    "cubic_spline": SmoothingLaw(2.0, {2: 10.0 / (7.0 * math.pi), 3: 1.0 / math.pi}, shape=cubic_spline),
    "quintic_spline": SmoothingLaw(
        3.0, {2: 7.0 / (478.0 * math.pi), 3: 1.0 / (120.0 * math.pi)}, shape=quintic_spline
    ),
    "gaussian": SmoothingLaw(3.0, _gaussian_alpha(3.0), shape=gaussian),
}
"""By name; `warpsph.register_smoothing_kernel` adds to it."""
