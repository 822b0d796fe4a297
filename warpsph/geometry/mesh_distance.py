"""Distances from closed meshes, on every core of the CPU."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache

import numpy as np
import warp as wp
from warpsph_kernels.mesh_distance import measure_mesh

from warpsph.geometry.mesh import TriangleMesh

_DEVICE = "cpu"
"""Particles are made on the host, and with the same bits whatever device a scene runs on."""
_BLUR = 1e-5
"""Depth, over the size of the mesh, below which single precision does not tell the two sides of a surface apart."""
_CHUNK = 4096


@lru_cache(maxsize=16)
def mesh_distance(mesh: TriangleMesh) -> Callable[[np.ndarray], np.ndarray]:
    """The signed distance (n,) [m] of points (n, 3) [m] from a mesh, negative inside; exact where no shells overlap."""
    return _MeshDistance(mesh)


class _MeshDistance:
    """Keeps the tree of a mesh, which is moved to the origin and scaled to the size one for single precision."""

    def __init__(self, mesh: TriangleMesh) -> None:
        low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
        self._middle, self._size = (low + high) / 2.0, float((high - low).max())
        vertices = (mesh.vertices - self._middle) / self._size
        self._vertex = wp.array(vertices, dtype=wp.vec3d, device=_DEVICE)
        self._face = wp.array(mesh.faces, dtype=wp.int32, device=_DEVICE)
        self._tree = wp.Mesh(
            points=wp.array(vertices.astype(np.float32), dtype=wp.vec3, device=_DEVICE),
            indices=wp.array(mesh.faces.ravel(), dtype=wp.int32, device=_DEVICE),
            support_winding_number=True,
        )

    def __call__(self, points: np.ndarray) -> np.ndarray:
        place = wp.array((points - self._middle) / self._size, dtype=wp.vec3d, device=_DEVICE)
        distance = wp.zeros(len(points), dtype=wp.float64, device=_DEVICE)
        model = [self._tree.id, self._vertex, self._face, _BLUR, place, distance]

        def measure(offset: int) -> None:
            count = min(_CHUNK, len(points) - offset)
            wp.launch(measure_mesh, dim=count, inputs=[offset, *model], device=_DEVICE)

        starts = range(0, len(points), _CHUNK)
        for first in starts[:1]:  # loads the code, which threads must not do at the same time
            measure(first)
        if len(starts) > 1:
            with ThreadPoolExecutor() as pool:
                list(pool.map(measure, starts[1:]))
        return np.asarray(distance.numpy() * self._size)
