"""What a run records beside probes and frames: averages on a grid and paths of particles."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from warpsph.frame import Frame
from warpsph.output.recordings import write_path_curves, write_path_table, write_statistics
from warpsph.output.run_directory import RunDirectory
from warpsph.probes.flow_statistics import FlowStatistics
from warpsph.probes.paths import PathRecorder
from warpsph.scene.schema import Scene


class Recordings:
    """The recordings that a scene asks for; they take every probe sample, and their files follow every frame."""

    def __init__(self, scene: Scene, directory: RunDirectory) -> None:
        self._scene, self._directory = scene, directory
        asked = scene.output.statistics
        self._statistics = FlowStatistics(asked, scene) if asked else None
        self._paths = {name: PathRecorder(spec) for name, spec in scene.output.paths.items()}

    @property
    def fields(self) -> frozenset[str]:
        """Fields that every sample must carry."""
        needs = [self._statistics.needs] if self._statistics else []
        needs += [PathRecorder.needs] if self._paths else []
        return frozenset(field for by_kind in needs for fields in by_kind.values() for field in fields)

    def note(self, frame: Frame) -> None:
        """Take a sample."""
        for recorder in (self._statistics, *self._paths.values()):
            if recorder:
                recorder.note(frame)

    def write(self) -> None:
        """Write what there is so far. Raises OutputError."""
        if self._statistics:
            fields, axes = self._statistics.fields(), self._statistics.grid.axes()
            write_statistics(self._directory.statistics, axes, fields, self._statistics.times)
        if self._paths:
            paths = {name: (p.times, p.ids, p.positions) for name, p in self._paths.items()}
            write_path_table(self._directory.path_table, paths)
            write_path_curves(self._directory.path_curves, paths, self._scene)

    def save(self) -> dict[str, Any]:
        """What a run needs to go on."""
        own = {"statistics": self._statistics.save()} if self._statistics else {}
        return own | {f"path_{name}": recorder.save() for name, recorder in self._paths.items()}

    def load(self, saved: Mapping[str, Any]) -> None:
        """Go on from what `save` returned."""
        if self._statistics:
            self._statistics.load(saved["statistics"])
        for name, recorder in self._paths.items():
            recorder.load(saved[f"path_{name}"])
