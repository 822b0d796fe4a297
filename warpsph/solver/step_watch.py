"""Watches the size of the step: a run whose step falls to a small part of what it was will not come to its end."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from warpsph.solver.culprit import Culprit, particle_with_extreme
from warpsph.solver.errors import SimulationDiverged
from warpsph.solver.simulation import Simulation

COLLAPSED = 0.1
"""Part of the median step below which a step is a collapsed one."""
HOPELESS = 1.0e-3
"""Part of the median step below which a run is stopped: it would take a thousand times as long as foreseen."""
LONG = 500
"""Steps in a row that have to be so short. The impact of a splash is over after a few tens."""
GRADE = 1.05
"""Ratio of two steps between which the median does not tell a difference."""
MEDIAN_EVERY = 100
"""Looks between two evaluations of the median."""

FIELDS = {"force": "acceleration", "elastic": "volume_ratio"}
"""Of which field the extreme is to blame, by the limit that rules; for others it is the velocity."""
ADVICE = {
    "acoustic": "Look at what makes this particle so fast, and at the density around it; a higher numerics.sound_speed "
    "or a smaller spacing may keep it.",
    "force": "Look at what pushes this particle, such as particles that start too close to each other; a smaller "
    "time.cfl or spacing may keep it.",
    "elastic": "Some particle is pressed together until it is stiff: use smaller loads, a smaller spacing or a law "
    "that resists compression (neo_hookean).",
}
OTHER_ADVICE = "Look at the frames before that time, and at the limits of the step in summary.json."


class StepWatch:
    """Compares each step with the median of all steps before it."""

    name = "step"
    every = 1

    def __init__(self) -> None:
        self.warnings: list[str] = []
        self._steps: dict[int, int] = {}
        self._median = 0.0
        self._looks = 0
        self._short = {COLLAPSED: 0, HOPELESS: 0}
        self._began = 0.0
        self._shortest = 1.0

    def start(self, sim: Simulation) -> None:
        """Nothing is to be compared yet."""

    def look(self, sim: Simulation) -> None:
        """Count the step among the short ones or as the end of them; warn after a long row of them, or stop."""
        step = sim.last_step
        # The last step to a time may be of any size, and so are those of a rigid body that begins to turn.
        if step.limit == "rotation" or (step.limit == "frame" and step.count == 1):
            return
        if self._looks % MEDIAN_EVERY == 0:
            self._median = self._find_median()
        self._looks += 1
        grade = math.floor(math.log(step.dt) / math.log(GRADE))
        self._steps[grade] = self._steps.get(grade, 0) + step.count
        share = step.dt / self._median if self._median else 1.0
        if share >= COLLAPSED:
            self._began = sim.time
        for part in self._short:
            self._short[part] = self._short[part] + step.count if share < part else 0
        if self._short[COLLAPSED] < LONG:
            return
        self._shortest = min(self._shortest, share)
        if not self.warnings:
            self.warnings.append(self._in_words(sim))
        if self._short[HOPELESS] >= LONG:
            raise self._stopped(sim)

    def _find_median(self) -> float:
        """Median of all steps so far [s], zero before there are enough of them."""
        half = sum(self._steps.values()) / 2.0
        if 2.0 * half < LONG:
            return 0.0
        for grade in sorted(self._steps):
            half -= self._steps[grade]
            if half <= 0.0:
                return float(GRADE ** (grade + 0.5))
        return 0.0

    def _in_words(self, sim: Simulation) -> str:
        step = sim.last_step
        culprit, advice = self._blamed(sim)
        return (
            f"from t = {self._began:.6g} s on the step was below {COLLAPSED:.0%} of its median {self._median:.3g} s "
            f"for {self._short[COLLAPSED]} steps in a row, at last {step.dt:.3g} s, by the limit '{step.limit}' at "
            f"{culprit}. {advice}"
        )

    def _stopped(self, sim: Simulation) -> SimulationDiverged:
        step = sim.last_step
        culprit, advice = self._blamed(sim)
        limit = (
            f"the step, limited by '{step.limit}', has been below {HOPELESS:g} of its median "
            f"{self._median:.3g} s for {LONG} steps"
        )
        return culprit.diverged(sim, limit, step.dt, advice)

    def _blamed(self, sim: Simulation) -> tuple[Culprit, str]:
        """The particle where the limit rules, and the advice that helps against it."""
        limit = sim.last_step.limit
        culprit = particle_with_extreme(sim, FIELDS.get(limit, "velocity"))
        return culprit, ADVICE.get(limit, OTHER_ADVICE)

    def record(self) -> dict[str, Any]:
        """Median step [s], and the shortest part of it that lasted."""
        return {"median_s": self._find_median() or None, "lasting_share": self._shortest}

    def save(self) -> dict[str, Any]:
        """Everything as plain values."""
        return {
            "steps": list(self._steps.items()),
            "median": self._median,
            "looks": self._looks,
            "short": list(self._short.values()),
            "began": self._began,
            "shortest": self._shortest,
        }

    def load(self, saved: Mapping[str, Any]) -> None:
        """Go on from what `save` returned."""
        self._steps = {int(grade): int(count) for grade, count in saved["steps"]}
        self._median, self._looks = float(saved["median"]), int(saved["looks"])
        self._short = dict(zip(self._short, saved["short"], strict=True))
        self._began, self._shortest = float(saved["began"]), float(saved["shortest"])
