"""Triangles of the meshes of a USD stage."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from pxr import Tf, Usd, UsdGeom

from warpsph.geometry.errors import GeometryError

USD_SUFFIXES = (".usd", ".usda", ".usdc", ".usdz")

_Z_FROM_Y = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""Turns y to z about x: a quarter turn."""


def read_stage(path: Path, prim: str | None, up: str) -> tuple[np.ndarray, np.ndarray, float]:
    """Vertices (n, 3) and triangles (m, 3) of a stage at its first time, and its metersPerUnit [m].

    All visible meshes that are meant to be rendered count, those of instances included, each moved by the transforms
    above it; `prim` is the path of the one below which they stand, None: anywhere. The stage's up axis becomes the axis
    `up`, y or z. Faces with more than three corners become fans. Raises GeometryError where there is no mesh.
    """
    stage = _opened(path)
    root = stage.GetPseudoRoot() if prim is None else stage.GetPrimAtPath(prim)
    if not root:
        raise GeometryError(f"{path}: there is no prim {prim}")
    time = (
        Usd.TimeCode(stage.GetStartTimeCode()) if stage.HasAuthoredTimeCodeRange() else Usd.TimeCode.Default()
    )
    parts = list(_triangles_below(root, time))
    if not parts:
        where = "" if prim is None else f" below {prim}"
        raise GeometryError(f"{path}: there is no visible mesh{where}; spheres, cubes and the like are none")
    vertices, faces = _concatenated(parts)
    return vertices @ _turn(stage, up).T, faces, float(UsdGeom.GetStageMetersPerUnit(stage))


def _opened(path: Path) -> Usd.Stage:
    try:
        return Usd.Stage.Open(str(path))
    except Tf.ErrorException as error:
        raise GeometryError(f"{path}: it cannot be read as a USD stage") from error


def _turn(stage: Usd.Stage, up: str) -> np.ndarray:
    own = "z" if UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.z else "y"
    if own == up:
        return np.eye(3)
    return _Z_FROM_Y if up == "z" else _Z_FROM_Y.T


def _triangles_below(root: Usd.Prim, time: Usd.TimeCode) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Vertices and triangles of each mesh, in the coordinates of the stage."""
    places = UsdGeom.XformCache(time)
    for prim in Usd.PrimRange(root, Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)):
        mesh = UsdGeom.Mesh(prim)
        if mesh and _is_shown(mesh, time):
            place = np.array(places.GetLocalToWorldTransform(prim))
            points = np.array(mesh.GetPointsAttr().Get(time) or [], dtype=np.float64).reshape(-1, 3)
            faces = _fans(mesh, time)
            if _is_reversed(mesh, time) != (np.linalg.det(place[:3, :3]) < 0.0):
                faces = faces[:, ::-1]
            yield points @ place[:3, :3] + place[3, :3], faces


def _is_shown(mesh: UsdGeom.Mesh, time: Usd.TimeCode) -> bool:
    purpose = mesh.ComputePurpose()
    rendered = purpose in (UsdGeom.Tokens.default_, UsdGeom.Tokens.render)
    return rendered and mesh.ComputeVisibility(time) != UsdGeom.Tokens.invisible


def _is_reversed(mesh: UsdGeom.Mesh, time: Usd.TimeCode) -> bool:
    return bool(mesh.GetOrientationAttr().Get(time) == UsdGeom.Tokens.leftHanded)


def _fans(mesh: UsdGeom.Mesh, time: Usd.TimeCode) -> np.ndarray:
    """Triangles (m, 3) of the faces of a mesh, each a fan about its first corner."""
    counts = np.array(mesh.GetFaceVertexCountsAttr().Get(time) or [], dtype=np.int64)
    corners = np.array(mesh.GetFaceVertexIndicesAttr().Get(time) or [], dtype=np.int64)
    if counts.sum() != len(corners):
        raise GeometryError(
            f"{mesh.GetPath()}: its faces have {counts.sum()} corners, of which {len(corners)} are given"
        )
    triangles = np.maximum(counts - 2, 0)
    first = np.repeat(np.cumsum(counts) - counts, triangles)
    step = np.arange(triangles.sum()) - np.repeat(np.cumsum(triangles) - triangles, triangles)
    return corners[np.stack([first, first + step + 1, first + step + 2], axis=1)]


def _concatenated(parts: list[tuple[np.ndarray, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
    counts = [len(points) for points, _ in parts]
    starts = np.cumsum([0, *counts[:-1]])
    faces = [faces + start for (_, faces), start in zip(parts, starts, strict=True)]
    return np.concatenate([points for points, _ in parts]), np.concatenate(faces)
