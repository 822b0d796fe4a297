"""Values of time laws for the coming steps: factors of loads, poses of moving clamps and walls."""

from __future__ import annotations

import numpy as np

from warpsph.particles.state import host_view
from warpsph.physics.structure import SUB_STEPS
from warpsph.scene.expressions import evaluate
from warpsph.solver.structure_assembly import StructureParts


class TimeLaws:
    """Writes the tables that the kernels read, one row for each time from now on."""

    def __init__(self, parts: StructureParts) -> None:
        self._model = parts.model
        self._factors = parts.factors
        self._motions = [c.motion for c in parts.clamps if c.motion is not None] + [
            *parts.wall_motions.values()
        ]
        self._load_factor = np.array(host_view(self._model.scratch.load_factor))
        self._prescriptions = np.array(host_view(self._model.scratch.prescriptions))

    def write(self, time: float, dt: float) -> None:
        """Tabulate all laws at time, time + dt, ... [s]."""
        if not self._model.has_time_laws:
            return
        times = time + dt * np.arange(SUB_STEPS + 1)
        for column, factor in enumerate(self._factors):
            self._load_factor[:, column] = evaluate(factor, {"t": times})
        for column, motion in enumerate(self._motions):
            for row in range(1 if dt == 0.0 else len(times)):
                for name, value in motion(float(times[row])).derivatives().items():
                    self._prescriptions[name][row, column] = value
        if dt == 0.0 and self._motions:
            self._prescriptions[1:] = self._prescriptions[0]
        self._model.scratch.load_factor.assign(self._load_factor)
        self._model.scratch.prescriptions.assign(self._prescriptions)
