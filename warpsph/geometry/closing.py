"""From the triangles of a file to a closed surface."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from warpsph.geometry.closedness import components, consistently_wound, refuse_open, turned_outwards
from warpsph.geometry.errors import GeometryError
from warpsph.geometry.mesh import TriangleMesh

_SAME_PLACE = 1e-6
"""Vertices nearer than this part of the mesh's diagonal are one: files repeat them, rounded to six or seven digits."""
_FLAT = 1e-9
"""Volume over that of the bounding box below which a surface encloses nothing."""


def closed_mesh(vertices: np.ndarray, faces: np.ndarray) -> TriangleMesh:
    """The closed surface of triangles as a file gives them, vertices (n, 3) and faces (m, 3).

    Vertices in one place are joined, triangles wound alike and turned outwards. Raises GeometryError where the surface
    is open, not orientable, or encloses nothing.
    """
    if len(faces) == 0:
        raise GeometryError("it holds no triangle")
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise GeometryError("a triangle has a corner that is no vertex")
    if not np.isfinite(vertices).all():
        raise GeometryError("a coordinate of a vertex is not finite")
    vertices, faces = _joined(vertices, faces)
    refuse_open(vertices, faces)
    faces = turned_outwards(vertices, consistently_wound(vertices, faces))
    mesh = TriangleMesh(vertices, faces)
    box = float(np.prod(np.ptp(vertices, axis=0)))
    if mesh.volume <= _FLAT * box or box == 0.0:
        raise GeometryError("the surface encloses no volume")
    return mesh


def _joined(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vertices in one place as one, without those of no triangle; triangles that lose a side by that are left out."""
    used, place = np.unique(faces, return_inverse=True)
    points, same = np.unique(vertices[used], axis=0, return_inverse=True)
    diagonal = float(np.linalg.norm(np.ptp(points, axis=0)))
    pairs = cKDTree(points).query_pairs(_SAME_PLACE * diagonal, output_type="ndarray")
    group = components(pairs, len(points))
    _, first = np.unique(group, return_index=True)
    joined = group[same.ravel()][place.reshape(faces.shape)]
    a, b, c = joined.T
    return points[first], joined[(a != b) & (b != c) & (c != a)].astype(np.int32)
