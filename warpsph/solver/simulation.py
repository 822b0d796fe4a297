"""A run under the user's control: whole, to a time, or step by step."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import warp as wp

from warpsph.frame import Frame
from warpsph.particles.launch import Launcher
from warpsph.sampling import SampledSet, sample
from warpsph.sampling.report import shape_report
from warpsph.scene.errors import SceneError
from warpsph.scene.schema import Scene
from warpsph.solver.coupled_system import CoupledSystem
from warpsph.solver.fluid_system import FluidSystem
from warpsph.solver.ledger import Ledger
from warpsph.solver.memory import refuse_what_does_not_fit
from warpsph.solver.schedule import SAME_TIME, frame_times
from warpsph.solver.structure_system import StructureSystem
from warpsph.solver.system import StepReport, System

Callback = Callable[["Simulation"], None]


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
            sets = sample(scene)
            refuse_what_does_not_fit(scene, sets, self._launcher.device)
            self.system = make_system(scene, sets, self._launcher)
        except SceneError as error:
            raise scene.located(error) from None
        self._shapes = shape_report(scene, sets)
        self._frame_callbacks: list[Callback] = []
        self._step_callbacks: list[Callback] = []
        self.step_count = 0
        self.frame_index = 0
        self.last_step = StepReport(dt=0.0, limit="none")

    @property
    def device(self) -> str:
        return str(self._launcher.device)

    @property
    def threads(self) -> int:
        return self._launcher.threads

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self.system.time

    @property
    def end_time(self) -> float:
        return self.scene.time.end

    @property
    def particle_count(self) -> int:
        """Particles alive, walls included."""
        return self.system.particle_count

    @property
    def removed_count(self) -> int:
        """Particles that have left the kill box."""
        return self.system.removed_count

    @property
    def sound_speed(self) -> float:
        """Artificial sound speed of the fluid, or the largest at rest of the structures [m/s]."""
        return self.system.sound_speed

    @property
    def list_builds(self) -> int:
        """How often the neighbour lists have been made."""
        return self.system.list_builds

    @property
    def sets(self) -> tuple[tuple[str, str, int], ...]:
        """Name, kind and number of living particles of each set."""
        return self.system.sets

    @property
    def stages(self) -> Mapping[str, float]:
        """Seconds spent in each stage of the step so far."""
        return dict(self._launcher.seconds)

    @property
    def extremes(self) -> Mapping[str, float]:
        """Largest values at the last choice of a step, by name, such as `speed` [m/s]."""
        return self.system.extremes

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
        report = self.system.step(self.step_count)
        self.step_count += report.count
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
        self.system.set_target(until)
        try:
            while self.time < until:
                yield self.step()
        finally:
            self.system.set_target(math.inf)

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
        """Return a state array on the device: a view, whose entries a step reorders but whose memory stays;
        where fluid enters through open boundaries, until it needs more places (see `growths` of `describe`).

        `position`, `velocity_volume`, `density_deviation`, `acceleration`, `id` or `set_index`. Convert with
        `.numpy()` or through DLPack (`torch.from_dlpack`, `jax.dlpack.from_dlpack`): no copy on the same device.

        Raises:
            KeyError: if there is no such array.
        """
        arrays = self.system.arrays
        if name not in arrays:
            raise KeyError(f"no array {name!r}; there are {', '.join(arrays)}")
        return arrays[name]

    def frame(self, fields: Sequence[str] | None = None, ordered: bool = True) -> Frame:
        """Return the particles as NumPy arrays, set by set, in the order of their ids if `ordered`.

        Args:
            fields: position, velocity, pressure, volume; of fluids also density and mass, of walls also force.

        Raises:
            KeyError: if there is no such field.
        """
        return Frame(
            index=self.frame_index,
            time=self.time,
            dimension=self.scene.dimension,
            spacing=self.scene.spacing,
            sets=self.system.frame_sets(fields, ordered),
            inflows=self.system.inflows(),
        )

    def ledger(self) -> Ledger:
        """Return mass, energies and momentum of the present state."""
        return self.system.ledger()

    def describe(self) -> dict[str, Any]:
        """Return what runs: sets and how they represent their shapes, passes, fields with bytes, limits of the step."""
        return {**self.system.describe(), "shapes": self._shapes}

    def save_state(self) -> dict[str, Any]:
        """Return everything that a run needs to go on with the same bits."""
        counts = {"step_count": self.step_count, "frame_index": self.frame_index}
        return {**self.system.save(), **counts}

    def load_state(self, saved: Mapping[str, Any]) -> None:
        """Go on from what `save_state` returned, in the same scene."""
        self.step_count, self.frame_index = int(saved["step_count"]), int(saved["frame_index"])
        self.system.load(saved)

    def _show_frame(self) -> None:
        for callback in self._frame_callbacks:
            callback(self)


def make_system(scene: Scene, sets: Sequence[SampledSet], launcher: Launcher) -> System:
    """Assemble what advances the particles of a scene. Raises SceneError."""
    kind = (
        CoupledSystem
        if scene.fluids and scene.structures
        else FluidSystem
        if scene.fluids
        else StructureSystem
    )
    return kind(scene, sets, launcher)


def default_device() -> str:
    """Return the first CUDA device if there is one, else the CPU."""
    return "cuda:0" if wp.is_cuda_available() else "cpu"
