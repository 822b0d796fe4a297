"""Watches for fluid that gets into walls and structures, or out of closed tanks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from warpsph.scene.schema import Scene
from warpsph.solver.culprit import Culprit, particle_at
from warpsph.solver.leaks import Leak, LeakFinder
from warpsph.solver.simulation import Simulation

ADVICE = (
    "Fluid there is lost to the flow. Where it went over the rim of an open tank, the walls have to be higher; else "
    "try a smaller spacing or time.cfl, a higher numerics.sound_speed, more layers, or another numerics.wall."
)

Place = tuple[str, str, int]
"""Fluid, wall or structure, and id of the particle."""


class LeakWatch:
    """Counts the particles of fluid behind the surface of a wall or structure.

    One that is there at two looks in a row has leaked; out of a corner into which an impact pressed it, it comes back.
    """

    name = "leaks"
    every = 500

    def __init__(self, scene: Scene) -> None:
        self.warnings: list[str] = []
        self._finder = LeakFinder(scene)
        self._ignored: set[tuple[str, str]] = set()
        self._most = self._now = 0
        self._seen: dict[Place, float] = {}

    def start(self, sim: Simulation) -> None:
        """Walls behind which a fluid is from the start are meant so: for that fluid they are ignored."""
        self._ignored = {(leak.fluid.name, leak.solid) for leak in self._leaks(sim)}

    def look(self, sim: Simulation) -> None:
        """Count what is behind a surface; warn of the first particle that has been there at the last look, too."""
        found = {
            (leak.fluid.name, leak.solid, int(leak.fluid.fields["id"][row])): (leak.fluid, int(row))
            for leak in self._leaks(sim)
            for row in leak.rows
        }
        self._now = len(found)
        self._most = max(self._most, self._now)
        lasting = sorted(found.keys() & self._seen.keys())
        if lasting and not self.warnings:
            self.warnings.append(self._in_words(sim, lasting[0], particle_at(*found[lasting[0]])))
        self._seen = {place: self._seen.get(place, sim.time) for place in found}

    def _in_words(self, sim: Simulation, place: Place, particle: Culprit) -> str:
        return (
            f"fluid leaked: since t = {self._seen[place]:.6g} s or earlier {particle} is behind the surface of "
            f"{place[1]}, at t = {sim.time:.6g} s one of {self._now} such particles. {ADVICE}"
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
        seen = [[*place, time] for place, time in sorted(self._seen.items())]
        return {"now": self._now, "most": self._most, "ignored": sorted(self._ignored), "seen": seen}

    def load(self, saved: Mapping[str, Any]) -> None:
        """Go on from what `save` returned."""
        self._now, self._most = int(saved["now"]), int(saved["most"])
        self._ignored = {(fluid, solid) for fluid, solid in saved["ignored"]}
        self._seen = {(fluid, solid, number): time for fluid, solid, number, time in saved["seen"]}
