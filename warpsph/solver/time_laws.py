"""Values of time laws for the coming steps: factors of loads, poses of moving clamps and walls."""

from __future__ import annotations

import numpy as np

from warpsph.particles.state import HostTable
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

    def write(self, time: float, dt: float = 0.0, count: int = 0) -> None:
        """Tabulate all laws at time, time + dt, ..., time + count dt [s]; later rows repeat the last of these."""
        if not self._model.has_time_laws:
            return
        times = time + dt * np.arange(count + 1)
        factors, prescriptions = self._load_factor.values, self._prescriptions.values
        for column, factor in enumerate(self._factors):
            factors[: count + 1, column] = evaluate(factor, {"t": times})
        for column, motion in enumerate(self._motions):
            for row, at in enumerate(times):
                for name, value in motion(float(at)).derivatives().items():
                    prescriptions[name][row, column] = value
        for table in (self._load_factor, self._prescriptions):
            table.values[count + 1 :] = table.values[count]
            table.send()
