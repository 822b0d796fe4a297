"""Simulations and runs for tests of the command line, without any physics."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from warpsph.cli.progress import Reporter
from warpsph.scene import Scene
from warpsph.solver.errors import SimulationDiverged

SCENE = """
name: tank
dimension: 2
spacing: 0.25
gravity: [0.0, -9.81]
time: {end: 0.02, frame_rate: 100}
fluids:
  water: {shape: {type: box, min: [0, 0], max: [1, 1]}, density: 1000}
boundaries:
  tank: {shape: {type: box, min: [0, 0], max: [1, 1.5]}, side: outside, open: [y_max]}
probes:
  front: {type: front, axis: x}
references:
  front:
    type: series
    column: "front.position[m]"
    table: {time: [0.02], value: [1.0]}
    bound: 0.25
    source: water at rest
"""


@dataclass(frozen=True)
class Step:
    dt: float = 1.5e-4
    limit: str = "acoustic"


@dataclass
class Sim:
    """A simulation as reporters see it."""

    time: float = 0.0
    end_time: float = 2.0
    step_count: int = 0
    particle_count: int = 1000
    last_step: Step = field(default_factory=Step)


@dataclass
class Clock:
    """Time that passes only when told to."""

    now: float = 0.0

    def __call__(self) -> float:
        return self.now


REFERENCE_ROW = {
    "quantity": "front",
    "value": 1.01,
    "reference": 1.0,
    "error": 0.01,
    "bound": 0.25,
    "holds": True,
}


LEDGER = {
    "mass": 1000.0,
    "kinetic_energy": 0.0,
    "potential_energy": 4905.0,
    "momentum": [0.0, 0.0],
    "energies": {},
}


def summary(*rows: dict[str, Any]) -> dict[str, Any]:
    """The summary of a run that went well."""
    return {
        "device": "cpu",
        "threads": 2,
        "particles": 1000,
        "removed_particles": 0,
        "frames": 3,
        "simulated_s": 0.02,
        "wall_s": 75.0,
        "particle_steps_per_second": 2.5e6,
        "bytes_per_particle": 800.0,
        "steps": {"count": 100, "sub_steps": 0, "mean_s": 2e-4, "limited_by": {"acoustic": 97, "frame": 3}},
        "versions": {"warpsph": "0.1.0"},
        "ledger": {"start": LEDGER, "end": LEDGER},
        "warnings": ["the scene [of a test] is tiny"],
        "references": list(rows or (REFERENCE_ROW,)),
    }


def converging(p: float, slope: float = 0.5) -> Callable[[Path], dict[str, Any]]:
    """An end of a run in a directory named by its spacing h, in which the front stands at 1 + slope h^p."""

    def end(directory: Path) -> dict[str, Any]:
        value = 1.0 + slope * float(directory.name) ** p
        return summary({**REFERENCE_ROW, "value": value, "samples": [{"time": 0.02, "value": value}]})

    return end


def diverged() -> SimulationDiverged:
    """The error of a run that went wrong."""
    return SimulationDiverged(
        set="water",
        particle=7,
        position=(0.5, 0.5),
        time=0.012,
        step=40,
        limit="its speed exceeds 2 times the sound speed",
        value=1e9,
        advice="Try a smaller time.cfl.",
    )


def run_that(end: Callable[[Path], dict[str, Any]], *, steps: bool = True) -> Callable[..., dict[str, Any]]:
    """A stand-in for `run_scene` that makes a step, unless told not to, and then ends by `end(directory)`."""

    def run_scene(scene: Scene, out: Path, *, reporter: Reporter, **options: Any) -> dict[str, Any]:
        sim = Sim()
        out.mkdir(parents=True, exist_ok=True)
        if steps:
            (out / "probes.csv").touch()
            reporter.start(sim)  # type: ignore[arg-type]
            sim.time = 0.012
            reporter.progress(sim)  # type: ignore[arg-type]
        return end(out)

    return run_scene


def raising(error: BaseException) -> Callable[[Path], dict[str, Any]]:
    """An end of a run by an exception."""

    def end(directory: Path) -> dict[str, Any]:
        raise error

    return end
