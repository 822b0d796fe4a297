"""Triangles from STL, OBJ, PLY and USD files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import trimesh

from warpsph.geometry.closing import closed_mesh
from warpsph.geometry.errors import GeometryError
from warpsph.geometry.mesh import TriangleMesh
from warpsph.geometry.usd_meshes import USD_SUFFIXES, read_stage

MESH_SUFFIXES = (".stl", ".obj", ".ply", *USD_SUFFIXES)
"""Endings of the files that can be read."""


def read_mesh(path: Path, prim: str | None, up: str | None) -> tuple[TriangleMesh, float]:
    """The closed surface of a file, in its own unit, and the length [m] of that: the metre for files other than stages.

    `prim` and `up` are for USD stages only, see `read_stage`; up is z by default. Raises GeometryError where the file
    cannot be read or its surface is not closed.
    """
    suffix = path.suffix.lower()
    if suffix not in MESH_SUFFIXES:
        raise GeometryError(f"{path}: a mesh file ends in one of {', '.join(MESH_SUFFIXES)}")
    if not path.is_file():
        raise GeometryError(f"{path}: there is no such file")
    if suffix in USD_SUFFIXES:
        vertices, faces, unit = read_stage(path, prim, up or "z")
    elif prim is not None or up is not None:
        raise GeometryError(f"{path}: prim and up are for USD stages only")
    else:
        (vertices, faces), unit = _read_with_trimesh(path), 1.0
    try:
        return closed_mesh(vertices, faces), unit
    except GeometryError as error:
        raise GeometryError(f"{path}: {error}") from error


def _read_with_trimesh(path: Path) -> tuple[np.ndarray, np.ndarray]:
    try:
        mesh = trimesh.load_mesh(path, process=False, skip_materials=True)
    except Exception as error:  # its readers let through whatever a damaged file makes them raise
        raise GeometryError(f"{path}: it cannot be read: {error}") from error
    if not isinstance(mesh, trimesh.Trimesh) or len(mesh.faces) == 0:
        raise GeometryError(f"{path}: it holds no triangle")
    return np.array(mesh.vertices, dtype=np.float64), np.array(mesh.faces, dtype=np.int64)
