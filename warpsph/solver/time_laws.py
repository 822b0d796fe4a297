"""Values of time laws for the coming steps: factors of loads, poses of moving clamps and walls."""

from __future__ import annotations

import numpy as np

from warpsph.particles.state import HostTable
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
        self._load_factor = HostTable(self._model.scratch.load_factor)
        self._prescriptions = HostTable(self._model.scratch.prescriptions)

    def write(self, time: float, dt: float, count: int = 0) -> None:
        """Tabulate all laws at time, time + dt, ..., time + count dt [s]; without a count, all rows at `time`."""
        if not self._model.has_time_laws:
            return
        times = time + dt * np.arange((count or SUB_STEPS) + 1)
        for column, factor in enumerate(self._factors):
            self._load_factor.values[: len(times), column] = evaluate(factor, {"t": times})
        for column, motion in enumerate(self._motions):
            for row in range(len(times) if count else 1):
                for name, value in motion(float(times[row])).derivatives().items():
                    self._prescriptions.values[name][row, column] = value
        if not count and self._motions:
            self._prescriptions.values[1:] = self._prescriptions.values[0]
        self._load_factor.send()
        self._prescriptions.send()
