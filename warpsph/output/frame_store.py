"""Frames of a run in one file that is readable at every moment of the run.

A crate or HDF5 file that grows in place is lost if the program is killed, or the disk runs full, in the midst
of a write (a crate file was, in 1 of 25 kills). So every frame first goes to a part, a file of its own, and
the store's own file is a small index of the parts; both are replaced atomically. When the run ends, the parts
are packed into the one file.
"""

import contextlib
import logging
import os
import shutil
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from warpsph.frame import Frame
from warpsph.output.atomic import replacing
from warpsph.output.errors import OutputError, reason_of
from warpsph.output.writer import Writer
from warpsph.scene.schema import Scene

logger = logging.getLogger(__name__)


@dataclass(frozen=True)
class StoredFrame:
    """A frame that is on disk: its number, its time [s] and the file that holds it."""

    index: int
    time: float
    file: Path


class FrameStore(Writer):
    """Writer of frames; a format says how a part, an index and the packed file look."""

    def __init__(self, path: Path, scene: Scene) -> None:
        """`path` is the one file to open; parts live in `path`.parts while the run goes on."""
        self._path = path
        self._scene = scene
        self._parts = path.with_name(path.name + ".parts")
        self._frames: tuple[StoredFrame, ...] = ()
        self._time_tolerance = 1e-6 / scene.time.frame_rate

    def open(self, resume_time: float | None = None) -> None:
        """Start anew, deleting older frames; or continue them after `resume_time` [s]. Raises OutputError."""
        try:
            if resume_time is None:
                self._path.unlink(missing_ok=True)
                shutil.rmtree(self._parts, ignore_errors=True)
            self._parts.mkdir(exist_ok=True)
        except OSError as error:
            raise OutputError(self._path, f"cannot write: {reason_of(error)}") from error
        stored = self._read_frames() if self._path.exists() else ()
        self._frames = tuple(f for f in stored if f.time < (resume_time or 0.0) + self._time_tolerance)

    def write(self, frame: Frame) -> None:
        """Add a frame; frames at its time or later, or of its number, are dropped. Raises OutputError.

        Another frame of its number is the last one of a run that ended between two frame times and goes on.
        """
        part = self._parts / f"{frame.index:06d}{self._path.suffix}"
        self._write_part(frame, part)
        self._unpack()
        before = frame.time - self._time_tolerance
        earlier = (f for f in self._frames if f.time < before and f.index < frame.index)
        self._frames = (*earlier, StoredFrame(frame.index, frame.time, part))
        self._write_index(self._frames)

    def close(self) -> None:
        """Pack the parts into the one file; or leave them, with a warning, where that fails."""
        if all(stored.file == self._path for stored in self._frames):
            with contextlib.suppress(OSError):
                self._parts.rmdir()
            return
        try:
            with replacing(self._path) as partial:
                _require_space(partial, sum(file.stat().st_size for file in self._parts.iterdir()))
                self._pack(self._frames, partial)
        except OutputError as error:
            logger.warning("%s; its frames stay in %s", error, self._parts)
            return
        shutil.rmtree(self._parts, ignore_errors=True)

    def _unpack(self) -> None:
        """A packed file that is being continued becomes a part itself, until it is packed again."""
        if not any(stored.file == self._path for stored in self._frames):
            return
        part = self._parts / f"up_to_{self._frames[-1].index:06d}{self._path.suffix}"
        part.unlink(missing_ok=True)
        try:
            os.link(self._path, part)
        except OSError:  # a file system without hard links
            os.replace(self._path, part)
        self._frames = tuple(
            replace(stored, file=part) if stored.file == self._path else stored for stored in self._frames
        )

    @abstractmethod
    def _read_frames(self) -> Sequence[StoredFrame]:
        """Frames of the existing index or packed file, in time order; OutputError if it is neither."""

    @abstractmethod
    def _write_part(self, frame: Frame, part: Path) -> None:
        """Write one frame."""

    @abstractmethod
    def _write_index(self, frames: Sequence[StoredFrame]) -> None:
        """Write the file that ties the parts together."""

    @abstractmethod
    def _pack(self, frames: Sequence[StoredFrame], path: Path) -> None:
        """Copy all frames into one file, with no more than a frame in memory at a time."""


def _require_space(path: Path, size: int) -> None:
    """Raise OSError if a file of so many bytes cannot be written, before HDF5 tries to and crashes."""
    with path.open("wb") as file:
        if size:
            os.posix_fallocate(file.fileno(), 0, size)
    path.unlink()
