"""Where clamps and loads of structures act: particles of a region, and the surface that a traction acts on."""

from __future__ import annotations

import numpy as np

from warpsph.sampling.distance import signed_distance, surface_normals
from warpsph.sampling.lattice import Lattice
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.shapes import Shape
from warpsph.scene.structures import BodyLoad, ForceLoad, Load

_ON_SURFACE = 1e-6
"""Reach beyond a region, in spacings, so that what lies on its surface but for rounding belongs to it."""


def inside(region: Shape, points: np.ndarray, spacing: float) -> np.ndarray:
    """Whether points (n, dim) [m] lie in a region or on its surface, shape (n,)."""
    return signed_distance(region, points) <= _ON_SURFACE * spacing


def specific_load(
    load: Load, shape: Shape, position: np.ndarray, mass: float, lattice: Lattice, key: str
) -> np.ndarray:
    """Force per mass (n, dim) [m/s2] of a load on the particles of a structure, before its time law.

    Args:
        shape: of the structure.
        position: (n, dim) of its particles at rest [m].
        mass: of each particle [kg/m^(3 - dim)].
        lattice: on which they lie.

    Raises:
        SceneError: if the load's region holds nothing that it could act on.
    """
    value, spacing = np.asarray(load.value), lattice.spacing
    if isinstance(load, BodyLoad):
        everywhere = np.ones(len(position), dtype=bool)
        chosen = everywhere if load.region is None else inside(load.region, position, spacing)
        _refuse_nothing(chosen, "particle", key)
        return np.outer(chosen, value)
    if isinstance(load, ForceLoad):
        chosen = inside(load.region, position, spacing)
        _refuse_nothing(chosen, "particle", key)
        return np.outer(chosen / (chosen.sum() * mass), value)
    area = exposed_area(shape, position, lattice, load.region)
    _refuse_nothing(area, "free face of a particle", key)
    return np.outer(area / mass, value)


def exposed_area(shape: Shape, position: np.ndarray, lattice: Lattice, region: Shape) -> np.ndarray:
    """Area (n,) [m^(dim-1)] of a body's surface that belongs to each of its particles, within a region.

    A particle's cell shows the faces beyond which there is no particle. Together they are a staircase; each counts with
    the cosine between its own normal and that of the surface, which gives the staircase the area of the surface.
    """
    dim, spacing = position.shape[1], lattice.spacing
    cells = np.rint((position - position[0]) @ lattice.rotation / spacing).astype(np.int64)
    taken = {tuple(cell) for cell in cells.tolist()}
    area = np.zeros(len(position))
    for axis in range(dim):
        for sign in (-1, 1):
            step = sign * np.eye(dim, dtype=np.int64)[axis]
            direction = lattice.rotation @ step
            free = np.array([tuple(cell) not in taken for cell in (cells + step).tolist()])
            centre = position + 0.5 * spacing * direction
            shown = free & inside(region, centre, spacing)
            if shown.any():
                cosine = surface_normals(shape, centre[shown], spacing) @ direction
                area[shown] += spacing ** (dim - 1) * np.maximum(cosine, 0.0)
    return area


def _refuse_nothing(found: np.ndarray, what: str, key: str) -> None:
    if not np.any(found):
        message = f"the structure has no {what} there"
        raise SceneError([Problem.at(f"{key}.region", message, "a shape that reaches into the structure")])
