"""checkpoint.h5: the whole state of a run, exactly, so that the run can go on with the same bits."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from warpsph import __version__
from warpsph.output.atomic import write_atomically
from warpsph.output.hdf5_image import file_image

FORMAT = "warpsph checkpoint"
VERSION = 2
"""Of the format; what a state holds is checked by who goes on from it."""


class CheckpointError(RuntimeError):
    """A checkpoint that cannot be read: missing, damaged, foreign, or of another version."""

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"{path}: {reason}")


@dataclass(frozen=True)
class Checkpoint:
    """What `write_checkpoint` was given, and the version of warpsph that wrote it, if it says."""

    state: dict[str, Any]
    scene_text: str
    writer: str | None = None


def write_checkpoint(path: Path, state: Mapping[str, Any], scene_text: str) -> None:
    """Replace the checkpoint by `state`: nested mappings of arrays of numbers and of scalars.

    The older checkpoint is intact until the new one is on disk. Raises OutputError if it cannot be written.
    """

    def fill(file: h5py.File) -> None:
        file.attrs["format"] = FORMAT
        file.attrs["version"] = VERSION
        file.attrs["written_by"] = __version__
        file["scene"] = scene_text
        _write_group(file.create_group("state"), state)

    write_atomically(path, file_image(fill), durable=True)


def read_checkpoint(path: Path) -> Checkpoint:
    """The state, bit for bit and type for type. Raises CheckpointError."""
    if not path.is_file():
        raise CheckpointError(path, "there is no such checkpoint")
    try:
        with h5py.File(path, "r") as file:
            _require_format(path, file)
            return Checkpoint(
                _read_group(file["state"]), file["scene"].asstr()[()], file.attrs.get("written_by")
            )
    except (OSError, KeyError, ValueError, RuntimeError) as error:
        if isinstance(error, CheckpointError):
            raise
        raise CheckpointError(path, f"damaged, or no HDF5 file: {error}") from error


def _require_format(path: Path, file: h5py.File) -> None:
    if file.attrs.get("format") != FORMAT:
        raise CheckpointError(path, "an HDF5 file, but no checkpoint of warpsph")
    if file.attrs["version"] != VERSION:
        version = file.attrs["version"]
        raise CheckpointError(path, f"checkpoint of version {version}; this warpsph reads version {VERSION}")


def _write_group(group: h5py.Group, state: Mapping[str, Any]) -> None:
    for name, value in state.items():
        if isinstance(value, Mapping):
            _write_group(group.create_group(name), value)
        elif isinstance(value, np.ndarray | np.generic):
            _write_array(group, name, value)
        else:
            group.attrs[name] = json.dumps(value)  # exact for floats, and for integers of any size


def _write_array(group: h5py.Group, name: str, value: np.ndarray | np.generic) -> None:
    """Arrays carry a checksum, so that damage is found when they are read."""
    checked = {"chunks": True, "fletcher32": True} if value.size > 1 and value.ndim else {}
    dataset = group.create_dataset(name, data=value, **checked)
    dataset.attrs["numpy_scalar"] = isinstance(value, np.generic)


def _read_group(group: h5py.Group) -> dict[str, Any]:
    scalars = {name: json.loads(text) for name, text in group.attrs.items()}
    return scalars | {name: _read_item(item) for name, item in group.items()}


def _read_item(item: h5py.Group | h5py.Dataset) -> Any:
    if isinstance(item, h5py.Group):
        return _read_group(item)
    return item[()] if item.attrs["numpy_scalar"] else np.asarray(item[()])
