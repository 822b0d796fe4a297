"""Energies of the fluid."""

import numpy as np

from warpsph.frame import Frame, SetFrame
from warpsph.probes.probe import Probe
from warpsph.scene.probes import EnergyProbe as EnergySpec
from warpsph.scene.schema import Scene


class EnergyProbe(Probe):
    """Kinetic, potential (zero at the origin) and compression energy of all fluids."""

    def __init__(self, name: str, spec: EnergySpec, scene: Scene) -> None:
        needs = {"fluid": ("position", "velocity", "density", "pressure", "mass")}
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._gravity = np.array(scene.gravity)
        self._gamma = scene.numerics.state.gamma
        self._reference_density = {fluid: scene.fluids[fluid].density for fluid in scene.fluids}

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Kinetic, potential, compression [J]; in the plane per metre of depth."""
        energies = [self._energies(fluid) for fluid in frame.of_kind("fluid")]
        return tuple(float(total) for total in np.sum(energies, axis=0))

    def _energies(self, fluid: SetFrame) -> tuple[float, float, float]:
        mass, velocity, position = (
            np.asarray(fluid.fields[name], dtype=np.float64) for name in ("mass", "velocity", "position")
        )
        kinetic = 0.5 * float(mass @ np.einsum("ij,ij->i", velocity, velocity))
        potential = -float(mass @ (position @ self._gravity))
        return kinetic, potential, float(mass @ self._specific_compression_energy(fluid))

    def _specific_compression_energy(self, fluid: SetFrame) -> np.ndarray:
        density, pressure = (
            np.asarray(fluid.fields[name], dtype=np.float64) for name in ("density", "pressure")
        )
        return tait_energy(density, pressure, self._reference_density[fluid.name], self._gamma)


def tait_energy(density: np.ndarray, pressure: np.ndarray, rho_0: float, gamma: float) -> np.ndarray:
    """Energy [J/kg] to bring a Tait fluid from rho_0 to its density: the integral of p / rho^2 d rho.

    With p = B (s^gamma - 1), s = rho / rho_0, it is B / rho_0 ((s^(gamma-1) - 1) / (gamma - 1) + 1/s - 1)
    (integrated from Cole 1948; Antuono et al. 2015 use it in the energy balance of SPH). B is eliminated by
    the pressure, so that the speed of sound need not be known.
    """
    strain = density / rho_0 - 1.0
    small = np.abs(strain) < 1e-5  # there the closed form is a difference of nearly equal numbers
    s = np.where(small, 2.0, 1.0 + strain)
    work = _power_integral(s, gamma) + 1.0 / s - 1.0
    ratio = np.where(small, 0.5 * strain, work / (s**gamma - 1.0))
    return pressure / rho_0 * ratio


def _power_integral(s: np.ndarray, gamma: float) -> np.ndarray:
    """Integral of s^(gamma - 2) from 1."""
    return np.log(s) if gamma == 1.0 else (s ** (gamma - 1.0) - 1.0) / (gamma - 1.0)
