"""Particles behind open boundaries, and what is wrong with the walls beside them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations

import numpy as np
from scipy.spatial import cKDTree

from warpsph.sampling.buffer_points import buffer_of, flow_of_columns, fluid_of
from warpsph.sampling.lattice import Lattice
from warpsph.sampling.packing import CLOSEST, away_from
from warpsph.sampling.patches import EDGE_MARGIN, Patch, patches_of
from warpsph.sampling.walls import period_of
from warpsph.scene.errors import Problem
from warpsph.scene.schema import Scene

_NOTABLE_MISFIT = 0.01
"""Part of a patch's area by which that of its columns may be off without a word."""
_NEAR = 0.8
"""Distance in spacings within which a wall particle stands at a place."""


def with_buffers(
    scene: Scene, fluids: Mapping[str, np.ndarray], lattices: Mapping[str, Lattice]
) -> dict[str, np.ndarray]:
    """Fluid particles with those of the buffers in place of what lay there."""
    filled, period = dict(fluids), period_of(scene)
    for patch in patches_of(scene):
        for name, points in filled.items():
            filled[name] = points[~patch.behind(points, EDGE_MARGIN * scene.spacing, period)]
    for patch in patches_of(scene):
        name = fluid_of(scene, patch)
        buffer = buffer_of(scene, patch, lattices)
        filled[name] = np.concatenate([away_from(filled[name], buffer, CLOSEST * scene.spacing), buffer])
    return filled


def buffer_problems(
    scene: Scene, fluids: Mapping[str, np.ndarray], walls: Mapping[str, np.ndarray]
) -> Iterator[Problem]:
    """Buffers that walls close, that walls beside the patch do not enclose, or that lie in each other."""
    patches = patches_of(scene)
    if not patches:
        return
    solid = np.concatenate([np.empty((0, scene.dimension)), *walls.values()])
    tree = cKDTree(solid) if len(solid) else None
    for patch in patches:
        key = f"open_boundaries.{patch.name}.shape"
        yield from _level_problems(patch, f"open_boundaries.{patch.name}.level")
        points = fluids[fluid_of(scene, patch)]
        if not patch.behind(points, 0.0, period_of(scene)).any():
            message = "no particle of this spacing has its centre behind the patch"
            yield Problem.at(key, message, "a larger patch, or a smaller spacing")
        if tree is not None:
            yield from _wall_problems(scene, patch, tree, key)
    for first, second in combinations(patches, 2):
        inside = _corners(second)
        if first.behind(inside, 0.0, period_of(scene)).any():
            message = f"its buffer, {second.length:g} m long, lies in that of {first.name!r}"
            yield Problem.at(f"open_boundaries.{second.name}.shape", message, "patches side by side or apart")


def inflow_warnings(scene: Scene) -> list[str]:
    """Patches with a uniform velocity or one from a table or formula, whose buffers bring in less or more than that.

    A parabola is scaled so that its flow rate is met.
    """
    warnings = []
    for patch in patches_of(scene):
        boundary = scene.open_boundaries[patch.name]
        if patch.has_level or boundary.type != "velocity" or boundary.velocity.type == "parabolic":
            continue
        section = flow_of_columns(scene, patch, np.ones(len(patch.stations)))
        if abs(section / patch.area - 1.0) > _NOTABLE_MISFIT:
            remedy = (
                "`placement: relaxed` in its fluid"
                if patch.is_disc
                else f"a spacing that divides it, such as {float(patch.cell[0]):.4g} m,"
            )
            warnings.append(
                f"the particles behind open_boundaries.{patch.name} stand for {section / patch.area:.1%} of its area "
                f"and bring in that part of its flow; {remedy} would bring in all"
            )
    return warnings


def _level_problems(patch: Patch, key: str) -> Iterator[Problem]:
    """A water level that does not cross its patch, whose highest point lies `top` [m] over its center."""
    rises = np.abs(patch.axes[:, 1:].T @ patch.up) * patch.half
    top = float(np.linalg.norm(rises) if patch.is_disc else rises.sum())
    if patch.has_level and not -top < patch.level <= top:
        middle = float(patch.center @ patch.up)
        allowed = f"above {middle - top:g} m, up to {middle + top:g} m"
        yield Problem.at(key, "the water level lies off the patch", allowed, middle + patch.level)


def _wall_problems(scene: Scene, patch: Patch, tree: cKDTree, key: str) -> Iterator[Problem]:
    dp = scene.spacing
    layers = round(patch.length / dp)
    depths = -(np.arange(layers) + 0.5) * dp
    inner = patch.stations[patch.covers(patch.stations, -0.75 * dp)]
    if any(_stand(tree, patch.points(inner, float(depth)), 0.5 * dp).any() for depth in depths):
        message = f"a wall stands in its buffer, which reaches {patch.length:g} m behind it"
        yield Problem.at(key, message, "walls that leave the room behind the patch free")
        return
    beside = _beside(patch, 0.5 * dp)
    bounded = _stand(tree, patch.points(beside, 0.5 * dp), _NEAR * dp)
    for depth in depths:
        gone = bounded & ~_stand(tree, patch.points(beside, float(depth)), _NEAR * dp)
        if gone.any():
            place = ", ".join(f"{x:g}" for x in patch.points(beside, float(depth))[gone][0])
            message = f"the wall beside it does not go on behind it: there is none at ({place})"
            allowed = f"walls that go on {patch.length:g} m behind the patch"
            yield Problem.at(key, message, allowed)
            return


def _stand(tree: cKDTree, points: np.ndarray, reach: float) -> np.ndarray:
    """At which points (n, dimension) a particle stands within `reach` [m]."""
    if not len(points):
        return np.zeros(0, dtype=bool)
    nearest, _ = tree.query(points, distance_upper_bound=reach)
    return np.isfinite(nearest)


def _beside(patch: Patch, out: float) -> np.ndarray:
    """Coordinates (n, dimension - 1) [m] of places `out` [m] beside the edge of a patch."""
    if patch.is_disc:
        angle = 2.0 * np.pi * np.arange(4 * max(patch.counts)) / (4 * max(patch.counts))
        return (patch.half[0] + out) * np.column_stack([np.cos(angle), np.sin(angle)])
    stations = patch.stations
    places = []
    for axis, half in enumerate(patch.half):
        for end in (-1.0, 1.0):
            edge = stations[np.isclose(stations[:, axis], end * np.abs(stations[:, axis]).max())].copy()
            edge[:, axis] = end * (half + out)
            places.append(edge)
    return np.concatenate(places)


def _corners(patch: Patch) -> np.ndarray:
    """Points (n, dimension) [m] all over a buffer."""
    depths = -patch.length * np.array([0.02, 0.5, 0.98])
    across = patch.stations[patch.covers(patch.stations, 0.0)]
    return np.concatenate([patch.points(across, depth) for depth in depths])
