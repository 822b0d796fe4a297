"""Watches for fluid that gets into walls and structures, or out of closed tanks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from warpsph.scene.schema import Scene
from warpsph.solver.culprit import particle_at
from warpsph.solver.leaks import Leak, LeakFinder
from warpsph.solver.simulation import Simulation

ADVICE = (
    "Fluid there is lost to the flow. Where it went over the rim of an open tank, the walls have to be higher; else "
    "try a smaller spacing or time.cfl, a higher numerics.sound_speed, more layers, or another numerics.wall."
)


class LeakWatch:
    """Counts the particles of fluid behind the surface of a wall or structure, and remembers the first."""

    name = "leaks"
    every = 500

    def __init__(self, scene: Scene) -> None:
        self.warnings: list[str] = []
        self._finder = LeakFinder(scene)
        self._ignored: set[tuple[str, str]] = set()
        self._most = self._now = 0

    def start(self, sim: Simulation) -> None:
        """Walls behind which a fluid is from the start are meant so: for that fluid they are ignored."""
        self._ignored = {(leak.fluid.name, leak.solid) for leak in self._leaks(sim)}

    def look(self, sim: Simulation) -> None:
        """Count what has leaked; warn of the first."""
        leaks = self._leaks(sim)
        self._now = sum(len(leak.rows) for leak in leaks)
        self._most = max(self._most, self._now)
        if leaks and not self.warnings:
            first = particle_at(leaks[0].fluid, int(leaks[0].rows[0]))
            self.warnings.append(
                f"fluid leaked: at t = {sim.time:.6g} s {first} was more than half a spacing behind the surface of "
                f"{leaks[0].solid}, one of {self._now} such particles. {ADVICE}"
            )

    def _leaks(self, sim: Simulation) -> list[Leak]:
        found = self._finder.leaks(sim.frame(self._finder.fields, ordered=False))
        return [leak for leak in found if (leak.fluid.name, leak.solid) not in self._ignored]

    def record(self) -> dict[str, Any]:
        """Particles behind a surface at the last look and at most, and what was not looked at."""
        ignored = [f"{fluid} behind {solid}" for fluid, solid in sorted(self._ignored)]
        return {"at_last": self._now, "at_most": self._most, "ignored": ignored}

    def save(self) -> dict[str, Any]:
        """Everything as plain values."""
        return {"now": self._now, "most": self._most, "ignored": sorted(self._ignored)}

    def load(self, saved: Mapping[str, Any]) -> None:
        """Go on from what `save` returned."""
        self._now, self._most = int(saved["now"]), int(saved["most"])
        self._ignored = {(fluid, solid) for fluid, solid in saved["ignored"]}
