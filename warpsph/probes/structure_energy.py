"""Energies of structures."""

import numpy as np

from warpsph.frame import Frame, SetFrame
from warpsph.probes.probe import Probe
from warpsph.scene.probes import StructureEnergyProbe as StructureEnergySpec
from warpsph.scene.schema import Scene
from warpsph.scene.structure_probes import STRUCTURE_ENERGIES

PARTICLE_ENERGIES = {
    "strain": "strain_energy",
    "hourglass": "hourglass_energy",
    "contact": "contact_energy",
    "dissipated": "dissipated",
    "work": "work",
}
"""Column and the frame field [J] whose sum it is."""


class StructureEnergyProbe(Probe):
    """Sums of the energies of particles; potential energy is that of the displacement, -m g . u."""

    def __init__(self, name: str, spec: StructureEnergySpec, scene: Scene) -> None:
        fields = ("mass", "velocity", "displacement", *PARTICLE_ENERGIES.values())
        super().__init__(spec.columns(name, scene.dimension), {"structure": fields})
        self._structure = spec.structure
        self._gravity = np.array(scene.gravity)
        self._first = 0.0

    def start(self, frame: Frame) -> None:
        """Take the total energy at the start."""
        self._first = self._sums(frame)["total"]

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """See `STRUCTURE_ENERGIES` [J]; in the plane per metre of depth."""
        of = self._sums(frame)
        of["drift"] = of["total"] - self._first
        return tuple(of[name] for name in STRUCTURE_ENERGIES)

    def _sums(self, frame: Frame) -> dict[str, float]:
        bodies = [self._energies(s) for s in frame.of_kind("structure") if self._structure in (None, s.name)]
        of = {name: sum(body[name] for body in bodies) for name in bodies[0]}
        stored = of["kinetic"] + of["strain"] + of["hourglass"] + of["contact"] + of["potential"]
        return of | {"total": stored + of["dissipated"] - of["work"]}

    def _energies(self, body: SetFrame) -> dict[str, float]:
        mass, velocity, shift = body.fields["mass"], body.fields["velocity"], body.fields["displacement"]
        summed = {name: float(np.sum(body.fields[field])) for name, field in PARTICLE_ENERGIES.items()}
        kinetic = 0.5 * float(mass @ np.einsum("ij,ij->i", velocity, velocity))
        return summed | {"kinetic": kinetic, "potential": -float(mass @ (shift @ self._gravity))}
