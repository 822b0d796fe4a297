"""particles.usdc: a USD stage with one UsdGeom.Points a particle set.

While the run goes on the stage ties the frames together as value clips, USD's own means for a cache in many
files. Once packed, it is a single crate file.
"""

import contextlib
import math
import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from pxr import Sdf, Tf, Vt

from warpsph.frame import Frame
from warpsph.output.atomic import replacing
from warpsph.output.errors import OutputError
from warpsph.output.frame_store import FrameStore, StoredFrame
from warpsph.output.usd_layers import (
    add_samples,
    declare_attribute,
    new_layer,
    prims_layer,
    sample_values,
    set_path,
    set_stage_metadata,
)
from warpsph.scene.schema import Scene

PRIMS = "prims.usdc"
MANIFEST = "manifest.usdc"


class UsdStore(FrameStore):
    """Frames as `particles.usdc`. A time code is a frame at the scene's frame rate."""

    def __init__(self, path: Path, scene: Scene) -> None:
        super().__init__(path, scene)
        self._defined = False

    def write(self, frame: Frame) -> None:
        """Add a frame; frames at its time or later are dropped. Raises OutputError; earlier frames stay."""
        if not self._defined:
            self._write_definitions(frame)
            self._defined = True
        super().write(frame)

    def _write_definitions(self, frame: Frame) -> None:
        """What all frames share: the prims, and the manifest of the attributes that change over time."""
        _export(prims_layer(frame.sets, frame.spacing, self._scene), self._parts / PRIMS)
        manifest = new_layer()
        for particle_set in frame.sets:
            for name, value in sample_values(particle_set, frame.spacing, self._scene).items():
                declare_attribute(manifest, set_path(self._scene, particle_set), name, value)
        _export(manifest, self._parts / MANIFEST)

    def _write_part(self, frame: Frame, part: Path) -> None:
        layer = new_layer()
        for particle_set in frame.sets:
            values = sample_values(particle_set, frame.spacing, self._scene)
            add_samples(layer, set_path(self._scene, particle_set), values, self._time_code(frame.time))
        _export(layer, part)

    def _write_index(self, frames: Sequence[StoredFrame]) -> None:
        layer = new_layer()
        set_stage_metadata(layer, self._scene)
        layer.subLayerPaths.append(self._asset(self._parts / PRIMS))
        self._tie_clips(layer, frames)
        self._set_time_range(layer, frames)
        _export(layer, self._path)

    def _tie_clips(self, layer: Sdf.Layer, frames: Sequence[StoredFrame]) -> None:
        files = list(dict.fromkeys(stored.file for stored in frames))
        number = {file: i for i, file in enumerate(files)}
        root = Sdf.CreatePrimInLayer(layer, f"/{self._scene.name}")
        root.SetInfo(
            "clips",
            {
                "default": {
                    "assetPaths": Sdf.AssetPathArray([Sdf.AssetPath(self._asset(file)) for file in files]),
                    "active": Vt.Vec2dArray([(self._time_code(f.time), number[f.file]) for f in frames]),
                    "manifestAssetPath": Sdf.AssetPath(self._asset(self._parts / MANIFEST)),
                    "primPath": f"/{self._scene.name}",
                }
            },
        )

    def _read_frames(self) -> list[StoredFrame]:
        with _usd_errors(self._path, "cannot continue"):
            layer = Sdf.Layer.OpenAsAnonymous(str(self._path))
        root = layer.GetPrimAtPath(f"/{self._scene.name}")
        if not root:
            raise OutputError(self._path, f"cannot continue: no prim /{self._scene.name} in it")
        if not root.HasInfo("clips"):
            return [self._stored(code, self._path) for code in layer.ListAllTimeSamples()]
        clips = root.GetInfo("clips")["default"]
        files = [self._path.parent / asset.path for asset in clips["assetPaths"]]
        return [self._stored(code, files[int(number)]) for code, number in clips["active"]]

    def _pack(self, frames: Sequence[StoredFrame], path: Path) -> None:
        with _usd_errors(path):
            packed = Sdf.Layer.CreateNew(str(path))
            packed.TransferContent(Sdf.Layer.OpenAsAnonymous(str(self._parts / PRIMS)))
            self._set_time_range(packed, frames)
            for stored in frames:
                _copy_samples(stored.file, packed, self._time_code(stored.time))
                packed.Save()

    def _set_time_range(self, layer: Sdf.Layer, frames: Sequence[StoredFrame]) -> None:
        layer.startTimeCode = self._time_code(frames[0].time)
        layer.endTimeCode = self._time_code(frames[-1].time)

    def _stored(self, time_code: float, file: Path) -> StoredFrame:
        return StoredFrame(math.ceil(time_code), time_code / self._scene.time.frame_rate, file)

    def _time_code(self, time: float) -> float:
        time_code = time * self._scene.time.frame_rate
        return float(round(time_code)) if abs(time_code - round(time_code)) < 1e-6 else time_code

    def _asset(self, file: Path) -> str:
        return f"./{file.relative_to(self._path.parent)}"


def _export(layer: Sdf.Layer, path: Path) -> None:
    with replacing(path) as partial, _usd_errors(path):
        layer.Export(str(partial))


def _copy_samples(source: Path, target: Sdf.Layer, time_code: float) -> None:
    layer = Sdf.Layer.OpenAsAnonymous(str(source))

    def copy(path: Sdf.Path) -> None:
        if layer.GetNumTimeSamplesForPath(path):
            target.SetTimeSample(path, time_code, layer.QueryTimeSample(path, time_code))

    layer.Traverse(Sdf.Path.absoluteRootPath, copy)


@contextlib.contextmanager
def _usd_errors(path: Path, failure: str = "cannot write") -> Iterator[None]:
    try:
        yield
    except Tf.ErrorException as error:
        raise OutputError(path, f"{failure}: {_reason_of(error)}") from error


def _reason_of(error: Tf.ErrorException) -> str:
    """What USD quotes in its stack of errors: the operating system's words where it has them."""
    text = str(error)
    reasons = re.findall(r"Error occurred writing file: ([^']*)'", text) or re.findall(r": '(.*)'", text)
    return reasons[0] if reasons else text
