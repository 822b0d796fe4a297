"""Why a scene cannot be sampled: what shows only when shapes meet each other and the lattice."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations, product

import numpy as np
from scipy.spatial import cKDTree

from warpsph.sampling.axes import face_axes
from warpsph.sampling.body_fitted import has_layers
from warpsph.sampling.clamps import clamped
from warpsph.sampling.contact import as_wall, inside_wall
from warpsph.sampling.walls import layer_count
from warpsph.scene.bounds import bounding_box
from warpsph.scene.errors import Problem
from warpsph.scene.schema import Scene
from warpsph.scene.shapes import Plane
from warpsph.scene.types import AXES

MAX_CELLS = 10**9
"""Lattice cells that the box around a wall may have: a few bytes of memory each while it is sampled."""

_WHOLE = 1e-3
_OVERLAP = 0.5


def geometry_problems(scene: Scene) -> Iterator[Problem]:
    """What is wrong before any particle is made."""
    yield from _period_problems(scene)
    for name in scene.boundaries:
        yield from _wall_shape_problems(scene, name)
        yield from _wall_period_problems(scene, name)


def empty_problems(section: str, positions: Mapping[str, np.ndarray]) -> Iterator[Problem]:
    """Sets of a section of the scene without any particle."""
    for name, points in positions.items():
        if len(points) == 0:
            message = "no particle of this spacing has its centre there"
            yield Problem.at(f"{section}.{name}.shape", message, "a larger shape, or a smaller spacing")


def wall_conflict_problems(
    scene: Scene, fluids: Mapping[str, np.ndarray], walls: Mapping[str, np.ndarray]
) -> Iterator[Problem]:
    """Fluids that reach into walls."""
    for (fluid, points), (wall, boundary) in product(fluids.items(), scene.boundaries.items()):
        inside = inside_wall(points, boundary, walls[wall], scene.spacing)
        if len(inside):
            share = f"{len(inside)} of its {len(points)} particles"
            message = f"{share} lie inside the wall {wall!r}, such as {_at(inside[0])}"
            allowed = f"a shape clear of boundaries.{wall}; type: difference cuts one shape out of another"
            yield Problem.at(f"fluids.{fluid}.shape", message, allowed)


def structure_conflict_problems(
    scene: Scene,
    fluids: Mapping[str, np.ndarray],
    walls: Mapping[str, np.ndarray],
    structures: Mapping[str, np.ndarray],
) -> Iterator[Problem]:
    """Fluids that reach into structures; beside fluids also structures that reach into walls unclamped."""
    for (fluid, points), (name, structure) in product(fluids.items(), scene.structures.items()):
        inside = inside_wall(points, as_wall(structure), structures[name], scene.spacing)
        if len(inside):
            share = f"{len(inside)} of its {len(points)} particles"
            message = f"{share} lie inside the structure {name!r}, such as {_at(inside[0])}"
            allowed = f"a shape clear of structures.{name}; type: difference cuts one shape out of another"
            yield Problem.at(f"fluids.{fluid}.shape", message, allowed)
    if not scene.fluids:
        return
    for (name, points), (wall, boundary) in product(structures.items(), scene.boundaries.items()):
        free = points[~clamped(scene, name, points)]
        inside = inside_wall(free, boundary, walls[wall], scene.spacing)
        if len(inside):
            message = f"{len(inside)} of its particles lie inside the wall {wall!r}, such as {_at(inside[0])}"
            allowed = f"a shape clear of boundaries.{wall}, or a clamp of all components there"
            yield Problem.at(f"structures.{name}.shape", message, allowed)


def overlap_problems(section: str, sets: Mapping[str, np.ndarray], spacing: float) -> Iterator[Problem]:
    """Sets of a section of the scene that lie in each other."""
    for (first, one), (second, other) in combinations(sets.items(), 2):
        low, high = one.min(axis=0) - spacing, one.max(axis=0) + spacing
        candidates = other[np.all((other > low) & (other < high), axis=1)]
        nearest, _ = cKDTree(one).query(candidates, distance_upper_bound=_OVERLAP * spacing, workers=-1)
        common = candidates[np.isfinite(nearest)]
        if len(common):
            message = f"{len(common)} of its particles lie in {section}.{first}, such as {_at(common[0])}"
            yield Problem.at(f"{section}.{second}.shape", message, f"{section} side by side")


def _period_problems(scene: Scene) -> Iterator[Problem]:
    for axis, (low, high) in scene.domain.periodic.items():
        cells = (high - low) / scene.spacing
        if abs(cells - round(cells)) > _WHOLE:
            finer, coarser = ((high - low) / count for count in (np.ceil(cells), np.floor(cells)))
            message = f"the period of {high - low:g} m in {axis} is {cells:.6g} spacings"
            allowed = f"a whole number of spacings in the period, such as {finer:.8g} or {coarser:.8g} m"
            yield Problem.at("spacing", message, allowed, scene.spacing)


def _wall_shape_problems(scene: Scene, name: str) -> Iterator[Problem]:
    shape, key = scene.boundaries[name].shape, f"boundaries.{name}.shape"
    if isinstance(shape, Plane):
        if shape.bounds is None:
            yield Problem.at(key, "a plane has no end as a wall", "bounds: {min: [...], max: [...]}")
        return
    low, high = bounding_box(shape)
    if not np.isfinite([low, high]).all():
        yield Problem.at(key, "a wall without end cannot be made", "a shape that ends on all sides")
        return
    cells = float(np.prod((high - low) / scene.spacing))
    if _is_cut_from_lattice(scene, name) and cells > MAX_CELLS:
        size = " x ".join(f"{length:.4g}" for length in high - low)
        message = f"the box around this wall, {size} m, has {cells:.2g} cells of this spacing"
        allowed = f"at most {MAX_CELLS:.2g}: a smaller shape, another unit of its file, or a larger spacing"
        yield Problem.at(key, message, allowed)


def _is_cut_from_lattice(scene: Scene, name: str) -> bool:
    """Whether a wall needs the cells of the box around it; layers that follow a surface do not."""
    boundary = scene.boundaries[name]
    in_layers = has_layers(boundary.shape) and face_axes(boundary.shape, scene.dimension) is None
    return boundary.placement != "auto" or not in_layers


def _wall_period_problems(scene: Scene, name: str) -> Iterator[Problem]:
    """A wall spans the whole period or lies within it, layers included; else it would leak."""
    boundary = scene.boundaries[name]
    low, high = bounding_box(boundary.shape)
    outwards = boundary.side == "outside" and not isinstance(boundary.shape, Plane)
    layers = layer_count(boundary, scene) if outwards else 0
    for axis, (start, end) in scene.domain.periodic.items():
        k, margin = AXES.index(axis), _WHOLE * scene.spacing
        spans = low[k] <= start + margin and high[k] >= end - margin
        reach = layers * scene.spacing - margin
        within = low[k] - reach >= start and high[k] + reach <= end
        if not (spans or within):
            message = (
                f"with its layers it crosses one periodic face in {axis}, from {low[k]:g} to {high[k]:g} m"
            )
            allowed = f"all of {start:g} to {end:g} m, or less of it by {layers} layers at each end"
            yield Problem.at(f"boundaries.{name}.shape", message, allowed)


def _at(point: np.ndarray) -> str:
    return "(" + ", ".join(f"{x:g}" for x in point) + ")"
