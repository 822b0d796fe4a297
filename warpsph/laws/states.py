"""Equations of state on the host: their inverse and the energy that they store, by the name that a scene uses.

With the strain e = rho/rho0 - 1 a state is p = rho0 c0^2 R(e), R(0) = 0, R'(0) = 1. Parameters of a state follow
the order of its `parameters`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

Formula = Callable[..., np.ndarray]
SMALL_STRAIN = 1e-5
"""Below it closed forms of the energy are differences of nearly equal numbers."""


@dataclass(frozen=True)
class StateLaw:
    """What the host needs of a state.

    strain(ratio, *parameters): e at R, the inverse; work(e, *parameters): the integral of R / (1+e)^2 from 0
    to e, which is the energy [J/kg] over c0^2, divided by R(e).
    """

    parameters: tuple[str, ...]
    strain: Formula
    work: Formula

    def deviation(
        self, pressure: np.ndarray, density: float, stiffness: float, parameters: tuple[float, ...]
    ) -> np.ndarray:
        """rho - rho0 [kg/m^dim] at a pressure [Pa]; `density` is rho0, `stiffness` is rho0 c0^2 [Pa]."""
        return density * self.strain(np.asarray(pressure) / stiffness, *parameters)

    def energy(
        self, density: np.ndarray, pressure: np.ndarray, rho_0: float, parameters: tuple[float, ...]
    ) -> np.ndarray:
        """Energy [J/kg] to bring the fluid from rho_0 to its density: the integral of p / rho^2 d rho.

        The stiffness is eliminated by the pressure, so that the speed of sound need not be known.
        """
        strain = density / rho_0 - 1.0
        small = np.abs(strain) < SMALL_STRAIN
        work = self.work(np.where(small, 1.0, strain), *parameters)
        return pressure / rho_0 * np.where(small, 0.5 * strain, work)


def tait_strain(ratio: np.ndarray, gamma: float) -> np.ndarray:
    """Inverse of R = ((1 + e)^gamma - 1) / gamma (Monaghan 1994)."""
    return np.expm1(np.log1p(gamma * ratio) / gamma)


def tait_work(strain: np.ndarray, gamma: float) -> np.ndarray:
    """((s^(gamma-1) - 1) / (gamma - 1) + 1/s - 1) / (s^gamma - 1) with s = 1 + e.

    Integrated from Cole (1948); Antuono et al. (2015) use it in the energy balance of SPH.
    """
    s = 1.0 + strain
    power = np.log(s) if gamma == 1.0 else (s ** (gamma - 1.0) - 1.0) / (gamma - 1.0)
    return (power + 1.0 / s - 1.0) / (s**gamma - 1.0)


def linear_strain(ratio: np.ndarray) -> np.ndarray:
    """Inverse of R = e."""
    return np.asarray(ratio)


def linear_work(strain: np.ndarray) -> np.ndarray:
    """(ln s + 1/s - 1) / e with s = 1 + e."""
    s = 1.0 + strain
    return (np.log(s) + 1.0 / s - 1.0) / strain


STATE_LAWS: dict[str, StateLaw] = {
    "tait": StateLaw(("gamma",), tait_strain, tait_work),
    "linear": StateLaw((), linear_strain, linear_work),
}
"""By name; `warpsph.register_state` adds to it."""

BUILT_IN_STATES = frozenset(STATE_LAWS)
