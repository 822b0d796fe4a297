"""Energies of the fluid."""

import numpy as np

from warpsph.frame import Frame, SetFrame
from warpsph.laws.states import STATE_LAWS
from warpsph.probes.probe import Probe
from warpsph.scene.probes import EnergyProbe as EnergySpec
from warpsph.scene.schema import Scene

ROUNDING = 1e-6
"""Of a pressure in single precision."""


class EnergyProbe(Probe):
    """Kinetic, potential (zero at the origin) and compression energy of all fluids.

    Fluid at the tension cutoff p_c has p_c (1 / rho_0 - 1 / rho), as if it had had that pressure from rest density on:
    p_c^2 / (2 rho_0^2 c_0^2) too low a specific energy.
    """

    def __init__(self, name: str, spec: EnergySpec, scene: Scene) -> None:
        needs = {"fluid": ("position", "velocity", "density", "pressure", "mass")}
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._gravity = np.array(scene.gravity)
        self._law, self._numbers = STATE_LAWS[scene.numerics.state.law], scene.numerics.state.numbers
        self._cutoff = scene.numerics.tension_cutoff
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
        rho_0 = self._reference_density[fluid.name]
        energy = self._law.energy(density, pressure, rho_0, self._numbers)
        if self._cutoff is None:
            return energy
        held = self._cutoff * (1.0 / rho_0 - 1.0 / density)
        return np.where(pressure > self._cutoff * (1.0 - ROUNDING), energy, held)
