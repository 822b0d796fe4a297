"""What looks after a run while it goes on: each watch knows one thing that a sound run does not do."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from warpsph.solver.simulation import Simulation


class Watch(Protocol):
    """Looks at a simulation now and then; nothing that it does changes the state of the run."""

    name: str
    """Of its entries in summary and checkpoint."""
    every: int
    """Steps between two looks."""
    warnings: list[str]
    """What it has found so far, each once."""

    def start(self, sim: Simulation) -> None:
        """Note what a new run begins with."""

    def look(self, sim: Simulation) -> None:
        """Look at the present state. Raises SimulationDiverged where going on has no meaning."""

    def record(self) -> dict[str, Any]:
        """What it measured, for the summary."""

    def save(self) -> dict[str, Any]:
        """All that it remembers, as plain values."""

    def load(self, saved: Mapping[str, Any]) -> None:
        """Go on from what `save` returned."""


class Watches:
    """All watches of a run, each of which looks at its own interval."""

    def __init__(self, watches: Sequence[Watch]) -> None:
        self._watches = tuple(watches)
        self._since = {watch.name: 0 for watch in watches}

    def start(self, sim: Simulation) -> None:
        """Let all note what a new run begins with."""
        for watch in self._watches:
            watch.start(sim)

    def note(self, sim: Simulation) -> list[str]:
        """Let those look whose turn it is after a step; return what they have newly found.

        Raises SimulationDiverged.
        """
        news: list[str] = []
        for watch in self._watches:
            self._since[watch.name] += sim.last_step.count
            if self._since[watch.name] < watch.every:
                continue
            self._since[watch.name] = 0
            known = len(watch.warnings)
            watch.look(sim)
            news += watch.warnings[known:]
        return news

    def look(self, sim: Simulation) -> None:
        """Let all look who have not just done so: at the end of a run, which may be shorter than an interval.

        Raises SimulationDiverged.
        """
        for watch in self._watches:
            if self._since[watch.name]:
                self._since[watch.name] = 0
                watch.look(sim)

    @property
    def warnings(self) -> list[str]:
        """What all of them have found so far."""
        return [warning for watch in self._watches for warning in watch.warnings]

    def record(self) -> dict[str, Any]:
        """What each measured, by its name."""
        return {watch.name: watch.record() for watch in self._watches}

    def save(self) -> dict[str, Any]:
        """Return everything as plain values."""
        return {"since": self._since} | {
            watch.name: {"warnings": watch.warnings, **watch.save()} for watch in self._watches
        }

    def load(self, saved: Mapping[str, Any]) -> None:
        """Go on from what `save` returned."""
        self._since = dict(saved["since"])
        for watch in self._watches:
            own = saved[watch.name]
            watch.warnings = list(own["warnings"])
            watch.load(own)
