"""A whole run: from a scene to the files of its directory and a summary of how good it is."""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from warpsph.comparison.compare import FieldSample, compare_run, field_samples, fields_needed
from warpsph.frame import Frame
from warpsph.output.checkpoint import read_checkpoint, write_checkpoint
from warpsph.output.probes_csv import ProbesCsv, read_probes
from warpsph.output.run_directory import RunDirectory, create_run_directory, frame_stores
from warpsph.output.summary import write_summary
from warpsph.probes import make_probe
from warpsph.scene.schema import Scene
from warpsph.solver.errors import SimulationDiverged
from warpsph.solver.interruption import Interruption
from warpsph.solver.recordings import Recordings
from warpsph.solver.resume import require_all_of, require_same_run, require_time_left
from warpsph.solver.schedule import Stop, schedule
from warpsph.solver.simulation import Simulation
from warpsph.solver.summary import StepStatistics, summarise
from warpsph.solver.watches_of import watches_of


class RunReporter(Protocol):
    """Hears how a run goes on."""

    def start(self, sim: Simulation) -> None: ...

    def progress(self, sim: Simulation) -> None: ...

    def warn(self, text: str) -> None: ...

    def finish(self, summary: dict[str, Any]) -> None: ...


def run_scene(
    scene: Scene,
    out: Path | str,
    *,
    device: str | None = None,
    threads: int | None = None,
    resume: bool = False,
    frames: int | None = None,
    reporter: RunReporter | None = None,
) -> dict[str, Any]:
    """Run a scene into a directory and return its summary, which is also written there.

    Args:
        out: directory of the run, made if it is missing.
        device, threads: see `Simulation`.
        resume: go on from the checkpoint in `out`, to the same bits as a run without a break.
        frames: stop after this many frames, at least one.

    Raises:
        SceneError: if the scene cannot be run.
        ValueError: if `frames` or `threads` is less than 1.
        SimulationDiverged: if the state goes out of range; frames, probes and the last checkpoint stay.
        OutputError: if something cannot be written.
        CheckpointError: if `resume` finds no usable checkpoint.
        KeyboardInterrupt: after Ctrl-C, when frames, probes and a checkpoint are safe.
    """
    if frames is not None and frames < 1:
        raise ValueError(f"frames is {frames}; allowed: a whole number at least 1, or None for all")
    out = Path(out)
    sim = Simulation(scene, device=device, threads=threads)
    saved = read_checkpoint(out / RunDirectory(out).checkpoint.name) if resume else None
    if saved is not None:
        require_same_run(scene, saved.scene_text, RunDirectory(out).checkpoint)
        time_saved = float(saved.state["simulation"]["time"])
        require_time_left(scene, time_saved, RunDirectory(out).checkpoint)
        require_all_of(sim.save_state(), saved, RunDirectory(out).checkpoint)
    run = _Run(sim, create_run_directory(out, scene, resume=resume), reporter)
    if saved is not None:
        run.restore(saved.state)
    return run.complete(frames)


class _Run:
    """Everything that is open while a run goes on."""

    def __init__(self, sim: Simulation, directory: RunDirectory, reporter: RunReporter | None) -> None:
        scene = sim.scene
        self._sim, self._scene, self._directory, self._reporter = sim, scene, directory, reporter
        self._probes = [make_probe(name, spec, scene) for name, spec in scene.probes.items()]
        self._recordings = Recordings(scene, directory)
        self._probe_fields = sorted(
            {field for p in self._probes for names in p.needs.values() for field in names}
            | self._recordings.fields
        )
        for probe in self._probes:
            probe.start(self._probe_frame())
        self._stores = frame_stores(directory, scene)
        self._csv = ProbesCsv(directory.probes, [c for probe in self._probes for c in probe.columns])
        self._samples: list[FieldSample] = []
        self._statistics = StepStatistics(sim)
        self._watches = watches_of(scene)
        self._wall_before = 0.0
        self._resumed_at: float | None = None

    def restore(self, state: dict[str, Any]) -> None:
        """Go on from a checkpoint."""
        self._sim.load_state(state["simulation"])
        self._statistics.load(json.loads(state["statistics"]), self._sim)
        self._samples = [FieldSample(**sample) for sample in json.loads(state["samples"])]
        self._recordings.load(state["recordings"])
        self._watches.load(json.loads(state["watches"]))
        self._wall_before = float(state["wall_seconds"])
        self._resumed_at = self._sim.time

    def complete(self, frames: int | None) -> dict[str, Any]:
        """Make all stops that lie ahead and close everything."""
        self._began = time.perf_counter()
        for writer in (*self._stores, self._csv):
            writer.open(self._resumed_at)
        status = "failed"
        try:
            if self._resumed_at is None:
                self._watches.start(self._sim)
            if self._reporter:
                self._reporter.start(self._sim)
            with Interruption() as interruption:
                status = self._make_stops(self._stops_ahead(frames), interruption)
        except SimulationDiverged as error:
            status = f"diverged: {error}"
            raise
        finally:
            summary = self._close(status)
        if status == "interrupted":
            raise KeyboardInterrupt
        if self._reporter:
            self._reporter.finish(summary)
        return summary

    def _stops_ahead(self, frames: int | None) -> list[Stop]:
        stops = schedule(self._scene)
        if frames is not None:
            last = min(frames, sum(stop.frame is not None for stop in stops)) - 1
            end = next(stop.time for stop in stops if stop.frame == last)
            stops = [stop for stop in stops if stop.time <= end]
        if self._resumed_at is None:
            return stops
        return [stop for stop in stops if stop.time > self._resumed_at]

    def _make_stops(self, stops: Sequence[Stop], interruption: Interruption) -> str:
        for stop in stops:
            if not self._advance(stop.time, interruption):
                self._write_checkpoint()
                return "interrupted"
            if stop.frame is not None:
                self._sim.frame_index = stop.frame
            self._write(stop)
        self._watches.look(self._sim)
        return "complete"

    def _advance(self, until: float, interruption: Interruption) -> bool:
        for _ in self._sim.steps_until(until):
            self._statistics.note(self._sim)
            found = self._watches.note(self._sim)
            if self._reporter:
                self._reporter.progress(self._sim)
                for warning in found:
                    self._reporter.warn(warning)
            if interruption.requested:
                return False
        return True

    def _write(self, stop: Stop) -> None:
        if stop.probes and (self._probes or self._probe_fields):
            self._write_probes()
        if stop.frame is None:
            return
        frame = self._sim.frame(self._frame_fields())
        self._samples.extend(field_samples(self._scene, frame))
        for store in self._stores:
            store.write(frame)
        self._recordings.write()
        if stop.checkpoint:
            self._write_checkpoint()

    def _write_probes(self) -> None:
        frame = self._probe_frame()
        if self._probes:
            self._csv.write(frame.time, [value for probe in self._probes for value in probe.evaluate(frame)])
        self._recordings.note(frame)

    def _probe_frame(self) -> Frame:
        return self._sim.frame(self._probe_fields, ordered=False)

    def _frame_fields(self) -> list[str]:
        asked = self._sim.system.fields.intersection(self._scene.output.fields)
        return sorted({*asked, *fields_needed(self._scene), "velocity"})

    def _write_checkpoint(self) -> None:
        state = {
            "simulation": self._sim.save_state(),
            "statistics": json.dumps(self._statistics.save(self._sim)),
            "samples": json.dumps([asdict(sample) for sample in self._samples]),
            "recordings": self._recordings.save(),
            "watches": json.dumps(self._watches.save()),
            "wall_seconds": self._wall_seconds(),
        }
        write_checkpoint(self._directory.checkpoint, state, self._scene.to_yaml())

    def _wall_seconds(self) -> float:
        return self._wall_before + time.perf_counter() - self._began

    def _close(self, status: str) -> dict[str, Any]:
        for writer in (*self._stores, self._csv):
            writer.close()
        history = {name: np.asarray(values) for name, values in read_probes(self._directory.probes).items()}
        rows = compare_run(self._scene, history, self._samples) if status == "complete" else ()
        summary = summarise(self._sim, status, self._wall_seconds(), self._statistics, self._watches, rows)
        write_summary(self._directory.summary, summary)
        return summary
