"""What a run tells about itself at the end: cost, conservation, limits, and errors against references."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from warpsph.comparison.row import Comparison
from warpsph.solver.ledger import Ledger
from warpsph.solver.simulation import Simulation
from warpsph.solver.watch import Watches


class StepStatistics:
    """How long the steps were, what limited them, and how far the state went."""

    def __init__(self, sim: Simulation) -> None:
        self.count = 0
        self.particle_steps = 0
        self.sub_steps = 0
        self._shortest, self._longest, self._sum = float("inf"), 0.0, 0.0
        self._ruling: dict[str, int] = {}
        self.largest: dict[str, float] = {}
        self.first: Ledger = sim.ledger()
        self._stages_before: dict[str, float] = {}
        self._list_builds_before = 0

    def stages(self, sim: Simulation) -> dict[str, float]:
        """Return the seconds in each stage of the run, those before it was resumed included."""
        before, now = self._stages_before, sim.stages
        return {stage: before.get(stage, 0.0) + now.get(stage, 0.0) for stage in {**before, **now}}

    def list_builds(self, sim: Simulation) -> int:
        """Return how often the run has made its neighbour lists, before it was resumed included."""
        return self._list_builds_before + sim.list_builds

    def note(self, sim: Simulation) -> None:
        """Count the step that the simulation has just made."""
        step = sim.last_step
        self.count += step.count
        self.sub_steps += step.sub_steps
        self.particle_steps += step.count * sim.particle_count
        self._sum += step.count * step.dt
        self._ruling[step.limit] = self._ruling.get(step.limit, 0) + step.count
        for name, value in sim.extremes.items():
            self.largest[name] = max(self.largest.get(name, 0.0), value)
        if step.limit != "frame":
            self._shortest, self._longest = min(self._shortest, step.dt), max(self._longest, step.dt)

    def save(self, sim: Simulation) -> dict[str, Any]:
        """Return everything as plain values."""
        plain = {key.lstrip("_"): value for key, value in vars(self).items() if key != "first"}
        past = {"stages_before": self.stages(sim), "list_builds_before": self.list_builds(sim)}
        return plain | past | {"first": vars(self.first)}

    def load(self, saved: dict[str, Any], sim: Simulation) -> None:
        """Take over what `save` returned; what the simulation has done so far is no part of the run."""
        self.count, self.particle_steps = saved["count"], saved["particle_steps"]
        self.sub_steps = saved["sub_steps"]
        self._shortest, self._longest, self._sum = saved["shortest"], saved["longest"], saved["sum"]
        self._ruling = dict(saved["ruling"])
        self.largest = dict(saved["largest"])
        self.first = Ledger(**saved["first"])
        self._stages_before = dict(saved["stages_before"])
        self._list_builds_before = saved["list_builds_before"] - sim.list_builds

    def as_record(self) -> dict[str, Any]:
        """Return the statistics for the summary; steps shortened to land on a time do not count as shortest."""
        return {
            "count": self.count,
            "sub_steps": self.sub_steps,
            "shortest_s": self._shortest if self.count else None,
            "mean_s": self._sum / self.count if self.count else None,
            "longest_s": self._longest,
            "limited_by": self._ruling,
        }


def summarise(
    sim: Simulation,
    status: str,
    wall_seconds: float,
    statistics: StepStatistics,
    watches: Watches,
    rows: Sequence[Comparison],
) -> dict[str, Any]:
    """Return the summary of a run; `status` is complete, interrupted, failed or `diverged: ...`."""
    description = sim.describe()
    stages = statistics.stages(sim)
    stepping = sum(stages.values())
    own = sim.system.warnings(statistics.largest) if statistics.count else []
    return {
        "scene": sim.scene.name,
        "status": status,
        "versions": _versions(),
        "device": sim.device,
        "threads": sim.threads,
        "spacing_m": sim.scene.spacing,
        "sets": description["sets"],
        "shapes": description["shapes"],
        "particles": sim.particle_count,
        "removed_particles": sim.removed_count,
        "fluid_places": description.get("fluid_places"),
        "growths": description.get("growths"),
        "open_boundaries": {name: vars(passed) for name, passed in sim.system.inflows().items()},
        "simulated_s": sim.time,
        "frames": sim.frame_index + 1,
        "wall_s": wall_seconds,
        "wall_s_by_stage": dict(sorted(stages.items(), key=lambda item: -item[1])),
        "particle_steps_per_second": statistics.particle_steps / stepping if stepping else None,
        "steps": statistics.as_record(),
        "list_builds": statistics.list_builds(sim),
        "sound_speed_m_s": sim.sound_speed,
        "largest_mach": statistics.largest.get("speed", 0.0) / sim.sound_speed,
        **{f"largest_{name}": value for name, value in statistics.largest.items()},
        "bytes_per_particle": description["bytes_per_particle"],
        "neighbours": description.get("neighbours"),
        "passes": description["passes"],
        "ledger": {"start": statistics.first.as_record(), "end": _end_ledger(sim, status)},
        "watches": watches.record(),
        "warnings": [*own, *watches.warnings],
        "references": [row.as_record() for row in rows],
    }


def _end_ledger(sim: Simulation, status: str) -> dict[str, Any] | None:
    return None if status.startswith(("diverged", "failed")) else sim.ledger().as_record()


def _versions() -> dict[str, str]:
    found = {"python": platform.python_version()}
    for package in ("warpsph", "warp-lang", "numpy", "usd-core", "h5py"):
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "not installed"
    return found
