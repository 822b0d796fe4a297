"""statistics.h5, paths.h5 and paths.usdc: averages on a grid, and the paths of particles."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import h5py
import numpy as np
from pxr import Sdf, Usd, UsdGeom, Vt

from warpsph.output.atomic import replacing, write_atomically
from warpsph.output.hdf5 import COMPRESSION
from warpsph.output.hdf5_image import file_image
from warpsph.output.usd_layers import new_layer, set_stage_metadata
from warpsph.scene.schema import Scene
from warpsph.scene.types import AXES

STATISTICS_UNITS = {
    "samples": "1",
    "velocity": "m/s",
    "pressure": "Pa",
    "velocity_covariance": "m2/s2",
    "pressure_variance": "Pa2",
}


def write_statistics(
    path: Path, axes: list[np.ndarray], fields: Mapping[str, np.ndarray], times: tuple[float, float]
) -> None:
    """Replace the file by averages in the shape of the grid, with the coordinates of its points along each axis [m].

    `times` are those of the first and the last sample [s]. Raises OutputError.
    """

    def fill(file: h5py.File) -> None:
        file.attrs["first_time"], file.attrs["last_time"] = times
        for axis, coordinates in zip(AXES, axes, strict=False):
            _dataset(file, axis, coordinates, "m")
        for name, values in fields.items():
            _dataset(file, name, values, STATISTICS_UNITS[name])

    write_atomically(path, file_image(fill))


PathData = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Times (n,) [s], ids (m,) and positions (n, m, dimension) [m] of followed particles, NaN where they are not there."""


def write_path_table(path: Path, paths: Mapping[str, PathData]) -> None:
    """Replace the file by one group a name, with `time`, `id` and `position`. Raises OutputError."""

    def fill(file: h5py.File) -> None:
        for name, (times, ids, positions) in paths.items():
            group = file.create_group(name)
            for key, values, unit in (("time", times, "s"), ("id", ids, "1"), ("position", positions, "m")):
                _dataset(group, key, values, unit)

    write_atomically(path, file_image(fill))


def write_path_curves(path: Path, paths: Mapping[str, PathData], scene: Scene) -> None:
    """Replace the stage by one `UsdGeom.BasisCurves` a name, a polyline a particle, with the time of each vertex.

    A path that leaves through a periodic axis goes on at the other side in a curve of its own. Raises OutputError.
    """
    layer = new_layer()
    stage = Usd.Stage.Open(layer)
    UsdGeom.Xform.Define(stage, f"/{scene.name}")
    for name, data in paths.items():
        _define_curves(UsdGeom.BasisCurves.Define(stage, f"/{scene.name}/{name}"), data, scene)
    set_stage_metadata(layer, scene)
    with replacing(path) as partial:
        layer.Export(str(partial))


def _define_curves(curves: UsdGeom.BasisCurves, data: PathData, scene: Scene) -> None:
    times, ids, positions = data
    paths = [(k, piece) for k in range(len(ids)) for piece in _unbroken(positions[:, k], scene)]
    pieces = [(k, piece) for k, piece in paths if len(piece) > 1]
    none = np.empty((0, positions.shape[2]))
    points = np.concatenate([none, *(positions[piece, k] for k, piece in pieces)])
    vertices = np.zeros((len(points), 3), dtype=np.float32)
    vertices[:, : points.shape[1]] = points
    curves.CreateTypeAttr(UsdGeom.Tokens.linear)
    curves.CreateWrapAttr(UsdGeom.Tokens.nonperiodic)
    curves.CreateCurveVertexCountsAttr(Vt.IntArray([len(piece) for _, piece in pieces]))
    curves.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(vertices))
    curves.CreateWidthsAttr(Vt.FloatArray([0.5 * scene.spacing]))
    curves.SetWidthsInterpolation(UsdGeom.Tokens.constant)
    if len(points):
        corners = np.stack([vertices.min(axis=0), vertices.max(axis=0)])
        curves.CreateExtentAttr(Vt.Vec3fArray.FromNumpy(corners))
    primvars = UsdGeom.PrimvarsAPI(curves)
    of_vertices = np.concatenate([np.empty(0), *(times[piece] for _, piece in pieces)]).astype(np.float32)
    time = primvars.CreatePrimvar("time", Sdf.ValueTypeNames.FloatArray, UsdGeom.Tokens.vertex)
    time.Set(Vt.FloatArray.FromNumpy(of_vertices))
    number = primvars.CreatePrimvar("particle", Sdf.ValueTypeNames.Int64Array, UsdGeom.Tokens.uniform)
    number.Set(Vt.Int64Array([int(ids[k]) for k, _ in pieces]))


def _unbroken(path: np.ndarray, scene: Scene) -> list[np.ndarray]:
    """Indices of the samples of a particle, cut where it passes a periodic axis."""
    there = np.flatnonzero(np.isfinite(path).all(axis=1))
    jumps = np.zeros(max(len(there) - 1, 0), dtype=bool)
    for k, axis in enumerate(AXES[: path.shape[1]]):
        if axis in scene.domain.periodic:
            low, high = scene.domain.periodic[axis]
            jumps |= np.abs(np.diff(path[there, k])) > 0.5 * (high - low)
    return np.split(there, np.flatnonzero(jumps) + 1)


def _dataset(group: h5py.Group, name: str, values: np.ndarray, unit: str) -> None:
    dataset = group.create_dataset(name, data=values, **(COMPRESSION if np.size(values) else {}))
    dataset.attrs["unit"] = unit
