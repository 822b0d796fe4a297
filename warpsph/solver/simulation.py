"""A run under the user's control: whole, to a time, or step by step."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import warp as wp

from warpsph.frame import Frame, SetFrame
from warpsph.particles.launch import Launcher
from warpsph.particles.state import arrays_of, host_view, write_array
from warpsph.sampling import SampledSet, sample
from warpsph.scene.errors import SceneError
from warpsph.scene.schema import Scene
from warpsph.solver.assemble import FLUID, assemble
from warpsph.solver.describe import describe
from warpsph.solver.guards import check_state
from warpsph.solver.schedule import SAME_TIME, frame_times
from warpsph.solver.step import Stepper, StepReport

Callback = Callable[["Simulation"], None]

ARRAYS = ("position", "velocity_volume", "density_deviation", "acceleration", "id", "set_index")
"""State that `Simulation.array` hands out."""


class Simulation:
    """Particles, models and clock of a scene.

    Args:
        scene: what to run.
        device: Warp device such as `cpu` or `cuda:0`; the GPU if there is one.
        threads: CPU threads, all available cores by default.

    Raises:
        SceneError: if the scene cannot be sampled or assembled.
        ValueError: if `threads` is less than 1.
    """

    def __init__(self, scene: Scene, device: str | None = None, threads: int | None = None) -> None:
        if threads is not None and threads < 1:
            raise ValueError(
                f"threads is {threads}; allowed: a whole number at least 1, or None for all cores"
            )
        self.scene = scene
        self._launcher = Launcher(device or default_device(), threads)
        try:
            self._sampled = sample(scene)
            self._parts = assemble(scene, self._sampled, self._launcher)
        except SceneError as error:
            raise scene.located(error) from None
        self._stepper = Stepper(scene, self._parts)
        self._frame_callbacks: list[Callback] = []
        self._step_callbacks: list[Callback] = []
        self.step_count = 0
        self.frame_index = 0
        self.last_step = StepReport(dt=0.0, limit="none")
        self._stepper.start()

    @property
    def device(self) -> str:
        return str(self._launcher.device)

    @property
    def threads(self) -> int:
        return self._launcher.threads

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._stepper.time

    @property
    def end_time(self) -> float:
        return self.scene.time.end

    @property
    def particle_count(self) -> int:
        """Particles alive, walls included."""
        return self._alive + self._parts.assembly.layout.walls

    @property
    def removed_count(self) -> int:
        """Particles that have left the kill box."""
        return self._stepper.removed

    @property
    def sound_speed(self) -> float:
        """Artificial sound speed [m/s]."""
        return float(self._parts.assembly.constants.sound_speed)

    @property
    def list_builds(self) -> int:
        """How often the neighbour lists have been made."""
        return self._parts.search.builds

    @property
    def sets(self) -> tuple[tuple[str, str, int], ...]:
        """Name, kind and number of living particles of each set."""
        index = self._host("set_index")
        return tuple((s.name, s.kind, int(np.sum(index == k))) for k, s in enumerate(self._sampled))

    @property
    def stages(self) -> Mapping[str, float]:
        """Seconds spent in each stage of the step so far."""
        return dict(self._launcher.seconds)

    @property
    def largest_speed(self) -> float:
        """Largest speed at the last choice of a step [m/s]."""
        return self._stepper.speed

    @property
    def largest_compression(self) -> float:
        """Largest |rho/rho0 - 1| at the last choice of a step."""
        return self._stepper.compression

    def on_frame(self, callback: Callback) -> None:
        """Call `callback(simulation)` at every frame of `run`."""
        self._frame_callbacks.append(callback)

    def on_step(self, callback: Callback) -> None:
        """Call `callback(simulation)` after every step."""
        self._step_callbacks.append(callback)

    def step(self) -> StepReport:
        """Advance by one variable step.

        Raises:
            SimulationDiverged: if a particle has left the range in which the scheme means anything.
        """
        report = self._stepper.step()
        check_state(self._stepper, self._parts, self._sampled, self.step_count, report)
        self.step_count += 1
        self.last_step = report
        for callback in self._step_callbacks:
            callback(self)
        return report

    def advance(self, until: float) -> None:
        """Advance to a time [s], on which the last step lands exactly; a time already past makes no step.

        Raises:
            ValueError: if the time is not finite.
            SimulationDiverged: see `step`.
        """
        for _ in self.steps_until(until):
            pass

    def steps_until(self, until: float) -> Iterator[StepReport]:
        """Make the steps to a time [s] one by one, and yield the report of each; raises as `advance` does."""
        if not math.isfinite(until):
            raise ValueError(f"cannot advance to t = {until} s; allowed: a finite time")
        self._stepper.set_clock(TARGET=until)
        try:
            while self.time < until:
                yield self.step()
        finally:
            self._stepper.set_clock(TARGET=math.inf)

    def run(self) -> None:
        """Advance to the end of the scene and call the frame callbacks at every frame from the present time on.

        The frame of the present time is included, as the first one is at the start; frames that lie in the
        past after `step`, `advance` or `load_state` are not.
        """
        present = self.time - SAME_TIME / self.scene.time.frame_rate
        for index, time in enumerate(frame_times(self.scene)):
            if time >= present:
                self.advance(time)
                self.frame_index = index
                self._show_frame()

    def array(self, name: str) -> wp.array:
        """Return a state array on the device: a view, whose entries a step reorders but whose memory stays.

        `position`, `velocity_volume`, `density_deviation`, `acceleration`, `id` or `set_index`. Convert with
        `.numpy()` or through DLPack (`torch.from_dlpack`, `jax.dlpack.from_dlpack`): no copy on the same device.

        Raises:
            KeyError: if there is no such array.
        """
        if name not in ARRAYS:
            raise KeyError(f"no array {name!r}; there are {', '.join(ARRAYS)}")
        return getattr(self._parts.assembly.state, name)

    def frame(self, fields: Sequence[str] | None = None, ordered: bool = True) -> Frame:
        """Return the particles as NumPy arrays, set by set, in the order of their ids if `ordered`.

        Args:
            fields: position, velocity, pressure, volume; of fluids also density and mass, of walls also force.

        Raises:
            KeyError: if there is no such field.
        """
        self._stepper.synchronise()
        wanted = (
            tuple(fields) if fields is not None else ("position", "velocity", "density", "pressure", "mass")
        )
        columns = self._columns({"position", *wanted})
        index = np.array(self._host("set_index"))
        index[self._alive : self._parts.assembly.layout.fluids] = -1
        sets = tuple(
            self._set_frame(k, sampled, columns, index, ordered) for k, sampled in enumerate(self._sampled)
        )
        return Frame(
            index=self.frame_index,
            time=self.time,
            dimension=self.scene.dimension,
            spacing=self.scene.spacing,
            sets=sets,
        )

    def describe(self) -> dict[str, Any]:
        """Return what runs: sets, counts, passes, fields with unit and bytes, and the limits of the step."""
        return describe(self.scene, self._parts, self.sets)

    def save_state(self) -> dict[str, Any]:
        """Return everything that a run needs to go on with the same bits."""
        return {name: np.array(host_view(array)) for name, array in self._evolving_arrays()} | {
            "clock": np.array(host_view(self._parts.assembly.clock)),
            "alive": self._alive,
            "removed": self._stepper.removed,
            "step_count": self.step_count,
            "frame_index": self.frame_index,
        }

    def load_state(self, saved: Mapping[str, Any]) -> None:
        """Go on from what `save_state` returned, in the same scene."""
        for name, array in self._evolving_arrays():
            write_array(array, saved[name])
        self._parts.search.tables[FLUID].count = int(saved["alive"])
        self._stepper.removed = int(saved["removed"])
        self.step_count, self.frame_index = int(saved["step_count"]), int(saved["frame_index"])
        self._stepper.resume(np.asarray(saved["clock"]))

    @property
    def _alive(self) -> int:
        return self._parts.search.tables[FLUID].count

    def _host(self, name: str) -> np.ndarray:
        return host_view(getattr(self._parts.assembly.state, name))

    def _evolving_arrays(self) -> Iterator[tuple[str, wp.array]]:
        yield from arrays_of(self._parts.assembly.state)
        yield "listed_position", self._parts.search.listed_position
        yield from self._parts.fluid.own_arrays.items()
        if self._parts.walls:
            yield from self._parts.walls.own_arrays.items()

    def _columns(self, names: set[str]) -> dict[str, np.ndarray]:
        a = self._parts.assembly
        velocity_volume, pressure = self._host("velocity_volume"), host_view(a.scratch.position_pressure)
        makers: dict[str, Callable[[], np.ndarray]] = {
            "position": lambda: self._host("position"),
            "velocity": lambda: velocity_volume[:, :-1],
            "density": lambda: a.constants.rest_density + self._host("density_deviation").astype(np.float64),
            "pressure": lambda: pressure[:, -1],
            "volume": lambda: velocity_volume[:, -1],
            "mass": lambda: np.full(a.layout.total, a.constants.mass),
            "force": self._wall_force,
        }
        unknown = sorted(names - {"id", *makers})
        if unknown:
            raise KeyError(f"no field {unknown[0]!r}; there are {', '.join(makers)}, id")
        return {name: makers[name]() for name in names - {"id"}} | {"id": self._host("id")}

    def _wall_force(self) -> np.ndarray:
        layout = self._parts.assembly.layout
        force = np.zeros((layout.total, self.scene.dimension))
        if self._parts.walls:
            force[layout.fluids :] = host_view(self._parts.walls.react())
        return force

    def _set_frame(
        self, k: int, sampled: SampledSet, columns: Mapping[str, np.ndarray], index: np.ndarray, ordered: bool
    ) -> SetFrame:
        chosen = np.flatnonzero(index == k)
        if ordered:
            chosen = chosen[np.argsort(columns["id"][chosen])]
        fields = {name: values[chosen] for name, values in columns.items() if self._has(sampled.kind, name)}
        return SetFrame(name=sampled.name, kind=sampled.kind, fields=fields)

    @staticmethod
    def _has(kind: str, field: str) -> bool:
        return field not in (("force",) if kind == "fluid" else ("density", "mass"))

    def _show_frame(self) -> None:
        for callback in self._frame_callbacks:
            callback(self)


def default_device() -> str:
    """Return the first CUDA device if there is one, else the CPU."""
    return "cuda:0" if wp.is_cuda_available() else "cpu"
