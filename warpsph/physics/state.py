"""The equation of state on the host, in double precision."""

from __future__ import annotations

import numpy as np


def density_deviation(pressure: np.ndarray, density: float, stiffness: float, gamma: float) -> np.ndarray:
    """Return rho - rho0 [kg/m^dim] at a pressure [Pa], the inverse of Tait's equation (Monaghan 1994).

    `density` is rho0, `stiffness` is rho0 c0^2 [Pa].
    """
    return density * np.expm1(np.log1p(gamma * pressure / stiffness) / gamma)
