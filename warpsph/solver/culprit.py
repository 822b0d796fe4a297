"""Which particle is to blame: the one at which some field is extreme."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from warpsph.frame import SetFrame
from warpsph.solver.errors import SimulationDiverged
from warpsph.solver.simulation import Simulation


@dataclass(frozen=True)
class Culprit:
    """A particle: its set, its id there, and where it is [m]."""

    set: str
    particle: int
    position: tuple[float, ...]

    def __str__(self) -> str:
        place = ", ".join(f"{x:.6g}" for x in self.position)
        return f"particle {self.particle} of {self.set} at ({place}) m"

    def diverged(self, sim: Simulation, limit: str, value: float, advice: str) -> SimulationDiverged:
        """What stops a run now because of this particle."""
        return SimulationDiverged(
            set=self.set,
            particle=self.particle,
            position=self.position,
            time=sim.time,
            step=sim.step_count,
            limit=limit,
            value=value,
            advice=advice,
        )


def particle_at(found: SetFrame, row: int) -> Culprit:
    """The particle in a row of a set that carries positions."""
    position = found.fields["position"][row]
    return Culprit(found.name, int(found.fields["id"][row]), tuple(float(x) for x in position))


def particle_with_extreme(sim: Simulation, field: str) -> Culprit:
    """The moving particle at which a vector is longest, or a scalar smallest."""
    sets = [s for s in sim.frame((field,), ordered=False).sets if s.kind != "boundary"]
    sets = [s for s in sets if len(s.fields.get(field, ()))]
    sizes = [_size(s.fields[field]) for s in sets]
    k = int(np.argmax([size.max() for size in sizes]))
    return particle_at(sets[k], int(np.argmax(sizes[k])))


def _size(values: np.ndarray) -> np.ndarray:
    return np.linalg.norm(values, axis=1) if values.ndim > 1 else -values
