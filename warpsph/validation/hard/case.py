"""What a hard case measures, and how it is run and judged."""

from __future__ import annotations

import inspect
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from warpsph.particles.launch import Launcher
from warpsph.sampling import SampledSet
from warpsph.scene.schema import Scene
from warpsph.solver.errors import SimulationDiverged
from warpsph.solver.simulation import Simulation, default_device, make_system
from warpsph.solver.system import System


@dataclass(frozen=True)
class Figure:
    """A number that a case measured, with the bound that it has to keep.

    Args:
        unit: of value and bound; 1 for plain numbers.
        at_least: whether the bound is a lower one.
    """

    name: str
    value: float
    bound: float
    unit: str = "1"
    at_least: bool = False

    @property
    def holds(self) -> bool:
        """Whether the bound is kept; what is not a number keeps none."""
        return bool(self.value >= self.bound if self.at_least else self.value <= self.bound)


@dataclass(frozen=True)
class Machine:
    """Where cases are computed: a device, the GPU if there is one, and the threads of a CPU, by default all cores."""

    device: str | None = None
    threads: int | None = None

    def simulate(self, scene: Scene) -> Simulation:
        """The scene at its start."""
        return Simulation(scene, device=self.device, threads=self.threads)

    def system(self, scene: Scene, sets: Sequence[SampledSet], threads: int | None = None) -> System:
        """The scene with given particles in place of those that it would be filled with."""
        return make_system(scene, sets, Launcher(self.device or default_device(), threads or self.threads))

    def as_record(self) -> dict[str, Any]:
        """The device and the number of threads that it gives."""
        launcher = Launcher(self.device or default_device(), self.threads)
        return {"device": str(launcher.device), "threads": launcher.threads}


Measure = Callable[[Machine], Sequence[Figure]]


@dataclass(frozen=True)
class HardCase:
    """A function that runs something hard and measures it; its name and the first paragraph of its docstring say
    what."""

    measure: Measure

    @property
    def name(self) -> str:
        """Name of the case, words joined by underscores."""
        return self.measure.__name__

    @property
    def about(self) -> str:
        """What happens in the case."""
        paragraph, _, _ = (inspect.getdoc(self.measure) or "").partition("\n\n")
        return " ".join(paragraph.split())


@dataclass(frozen=True)
class HardResult:
    """What a case measured in how many seconds, compilation included; `failure` says why it came to no end."""

    case: HardCase
    machine: Machine
    figures: tuple[Figure, ...]
    seconds: float
    failure: str | None = None

    @property
    def holds(self) -> bool:
        """Whether the case came to its end and kept every bound."""
        return self.failure is None and all(figure.holds for figure in self.figures)

    def as_records(self) -> list[dict[str, Any]]:
        """Plain values, one record a figure; a case that came to no end has one without a figure."""
        what = {"case": self.case.name, "about": self.case.about}
        own = what | {"seconds": self.seconds, **self.machine.as_record()}
        if self.failure is not None:
            nothing = dict.fromkeys(("figure", "value", "bound", "unit"))
            return [{**own, **nothing, "at_least": False, "holds": False, "failure": self.failure}]
        return [{**own, **_record(figure), "failure": None} for figure in self.figures]


def _record(figure: Figure) -> dict[str, Any]:
    value = float(figure.value) if abs(figure.value) < float("inf") else None
    return {
        "figure": figure.name,
        "value": value,
        "bound": figure.bound,
        "unit": figure.unit,
        "at_least": figure.at_least,
        "holds": figure.holds,
    }


def run_hard_case(case: HardCase, machine: Machine) -> HardResult:
    """Run a case; one that diverges has failed, and says where."""
    began = time.perf_counter()
    figures: tuple[Figure, ...] = ()
    failure = None
    try:
        figures = tuple(case.measure(machine))
    except SimulationDiverged as error:
        failure = str(error)
    return HardResult(case, machine, figures, time.perf_counter() - began, failure)
