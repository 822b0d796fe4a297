"""The directory of a run, the names of its files, and the frame writers that a scene asks for."""

import os
from dataclasses import dataclass
from pathlib import Path

from warpsph.output.atomic import write_atomically
from warpsph.output.errors import OutputError, reason_of
from warpsph.output.frame_store import FrameStore
from warpsph.output.hdf5 import Hdf5Store
from warpsph.output.usd import UsdStore
from warpsph.scene.schema import Scene


@dataclass(frozen=True)
class RunDirectory:
    """Where everything of a run is; each property is the path of one file."""

    path: Path

    @property
    def scene(self) -> Path:
        """The scene as run: defaults filled in, overrides applied."""
        return self.path / "scene.yaml"

    @property
    def summary(self) -> Path:
        """What the run was and how it went."""
        return self.path / "summary.json"

    @property
    def probes(self) -> Path:
        """One row a probe sample."""
        return self.path / "probes.csv"

    @property
    def usd(self) -> Path:
        """The frames as a USD stage."""
        return self.path / "particles.usdc"

    @property
    def hdf5(self) -> Path:
        """The frames at full precision."""
        return self.path / "frames.h5"

    @property
    def statistics(self) -> Path:
        """Averages of the flow over time on a grid."""
        return self.path / "statistics.h5"

    @property
    def path_table(self) -> Path:
        """Paths of particles as numbers."""
        return self.path / "paths.h5"

    @property
    def path_curves(self) -> Path:
        """Paths of particles as a USD stage."""
        return self.path / "paths.usdc"

    @property
    def checkpoint(self) -> Path:
        """The last state that a run can go on from."""
        return self.path / "checkpoint.h5"


def create_run_directory(path: Path, scene: Scene, *, resume: bool = False) -> RunDirectory:
    """Make the directory and write scene.yaml; a new run removes summary and checkpoint of an older one.

    Raises OutputError if the directory cannot be made or written.
    """
    directory = RunDirectory(path)
    make_directory(path)
    try:
        if not resume:
            directory.summary.unlink(missing_ok=True)
            directory.checkpoint.unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(path, f"cannot write: {reason_of(error)}") from error
    write_atomically(directory.scene, scene.to_yaml(directory.path).encode())
    return directory


def make_directory(path: Path) -> None:
    """Make a directory for results where there is none. Raises OutputError if it cannot be made or written."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except FileExistsError as error:
        raise OutputError(path, "this is a file; allowed: a directory, made if it is missing") from error
    except OSError as error:
        raise OutputError(path, f"cannot write: {reason_of(error)}") from error
    if not os.access(path, os.W_OK | os.X_OK):
        raise OutputError(path, "cannot write: the directory is closed to new files")


def frame_stores(directory: RunDirectory, scene: Scene) -> tuple[FrameStore, ...]:
    """The writers that the scene's output asks for; each has open(), write(frame) and close()."""
    stores: list[FrameStore] = []
    if scene.output.usd:
        stores.append(UsdStore(directory.usd, scene))
    if scene.output.hdf5:
        stores.append(Hdf5Store(directory.hdf5, scene))
    return tuple(stores)
