"""Closed meshes of simple bodies."""

from __future__ import annotations

import numpy as np
import trimesh

Triangles = tuple[np.ndarray, np.ndarray]
"""Vertices (n, 3) and faces (m, 3)."""


def box(low: tuple[float, ...] = (0.0, 0.0, 0.0), high: tuple[float, ...] = (1.0, 1.0, 1.0)) -> Triangles:
    """A box of twelve triangles."""
    mesh = trimesh.creation.box(bounds=[low, high])
    return np.array(mesh.vertices), np.array(mesh.faces)


def ball(radius: float = 1.0, center: tuple[float, ...] = (0.0, 0.0, 0.0), fineness: int = 4) -> Triangles:
    """A geodesic sphere whose corners lie on the sphere; 20 * 4**fineness triangles."""
    mesh = trimesh.creation.icosphere(subdivisions=fineness, radius=radius)
    return np.array(mesh.vertices) + center, np.array(mesh.faces)


def reversed_(triangles: Triangles) -> Triangles:
    """The same surface, facing the other way."""
    return triangles[0], triangles[1][:, ::-1]


def together(*parts: Triangles) -> Triangles:
    """Several surfaces as one."""
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in parts[:-1])])
    faces = [faces + start for (_, faces), start in zip(parts, starts, strict=True)]
    return np.concatenate([vertices for vertices, _ in parts]), np.concatenate(faces)
