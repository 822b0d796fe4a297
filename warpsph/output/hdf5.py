"""frames.h5: every field of every frame at full precision.

Layout: `/time` [s] of all frames, and `/frames/000012/<set>/<field>`, with units as attributes. While the run
goes on the frames are external links to the parts.
"""

from collections.abc import Sequence
from pathlib import Path

import h5py
import numpy as np

from warpsph.frame import Frame, SetFrame, field_unit
from warpsph.output.atomic import write_atomically
from warpsph.output.errors import OutputError
from warpsph.output.frame_store import FrameStore, StoredFrame
from warpsph.output.hdf5_image import file_image

COMPRESSION = {"chunks": True, "compression": "gzip", "compression_opts": 1, "shuffle": True}


class Hdf5Store(FrameStore):
    """Frames as `frames.h5`."""

    def _write_part(self, frame: Frame, part: Path) -> None:
        write_atomically(part, file_image(lambda file: _write_frame(file, frame)))

    def _write_index(self, frames: Sequence[StoredFrame]) -> None:
        def link_parts(file: h5py.File) -> None:
            self._describe(file, frames)
            for stored in frames:
                name = _group_name(stored.index)
                file[name] = h5py.ExternalLink(str(stored.file.relative_to(self._path.parent)), name)

        write_atomically(self._path, file_image(link_parts))

    def _read_frames(self) -> list[StoredFrame]:
        try:
            with h5py.File(self._path, "r") as file:
                names = sorted(file["frames"])
                return [
                    StoredFrame(int(name), float(time), self._file_of(file["frames"].get(name, getlink=True)))
                    for name, time in zip(names, file["time"][:], strict=True)
                ]
        except (OSError, KeyError, ValueError) as error:
            raise OutputError(self._path, f"cannot continue: {error}") from error

    def _pack(self, frames: Sequence[StoredFrame], path: Path) -> None:
        with h5py.File(path, "w") as packed:
            self._describe(packed, frames)
            for stored in frames:
                with h5py.File(stored.file, "r") as part:
                    part.copy(_group_name(stored.index), packed, _group_name(stored.index))

    def _describe(self, file: h5py.File, frames: Sequence[StoredFrame]) -> None:
        file.attrs["scene"] = self._scene.name
        file.attrs["dimension"] = self._scene.dimension
        file.attrs["spacing"] = self._scene.spacing
        time = file.create_dataset("time", data=[stored.time for stored in frames])
        time.attrs["unit"] = "s"
        file.create_group("frames")

    def _file_of(self, link: h5py.ExternalLink | h5py.HardLink) -> Path:
        return self._path.parent / link.filename if isinstance(link, h5py.ExternalLink) else self._path


def _group_name(index: int) -> str:
    return f"frames/{index:06d}"


def _write_frame(file: h5py.File, frame: Frame) -> None:
    group = file.create_group(_group_name(frame.index))
    group.attrs["time"] = frame.time
    for particle_set in frame.sets:
        _write_set(group.create_group(particle_set.name), particle_set, frame.dimension)


def _write_set(group: h5py.Group, particle_set: SetFrame, dimension: int) -> None:
    group.attrs["kind"] = particle_set.kind
    for name, values in particle_set.fields.items():
        storage = COMPRESSION if np.size(values) else {}
        dataset = group.create_dataset(name, data=values, **storage)
        dataset.attrs["unit"] = field_unit(name, dimension)
