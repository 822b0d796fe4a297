"""From a scene to its particles."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

from warpsph.sampling.buffers import buffer_problems, with_buffers
from warpsph.sampling.checks import (
    empty_problems,
    geometry_problems,
    overlap_problems,
    structure_conflict_problems,
    wall_conflict_problems,
)
from warpsph.sampling.clamps import clamped
from warpsph.sampling.contact import as_wall, clear_of_wall
from warpsph.sampling.initial_state import initial_field, initial_pressure
from warpsph.sampling.kinematics import rigid_motions
from warpsph.sampling.lattice import Lattice, cells_inside
from warpsph.sampling.packing import CLOSEST, away_from
from warpsph.sampling.regions import Period, body_region
from warpsph.sampling.scene_lattices import lattices_of
from warpsph.sampling.sets import Placed, SampledSet
from warpsph.sampling.surface_relaxation import relaxed
from warpsph.sampling.walls import layer_count, period_of, sample_wall
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.schema import Fluid, Scene
from warpsph.scene.structures import Structure

Positions = Mapping[str, np.ndarray]
"""Positions (n, dimension) [m] of the particles of each set."""


def sample(scene: Scene) -> tuple[SampledSet, ...]:
    """The particles of a scene: fluids, boundaries, structures, each in the order of the scene.

    Raises SceneError with all problems of a scene whose shapes cannot be filled or do not fit together.
    """
    _refuse(geometry_problems(scene))
    lattices = lattices_of(scene)
    filled = {
        name: _filled(body, lattices[name], period_of(scene))
        for bodies in (scene.structures, scene.fluids)
        for name, body in bodies.items()
    }
    layers = {
        name: sample_wall(boundary, lattices[name], layer_count(boundary, scene), period_of(scene))
        for name, boundary in scene.boundaries.items()
    }
    structures = {name: filled[name].position for name in scene.structures}
    walls = _clear_of_clamps(scene, _joined_walls(scene, layers), structures)
    cells = with_buffers(scene, {name: filled[name].position for name in scene.fluids}, lattices)
    _refuse(buffer_problems(scene, cells, walls))
    _refuse(wall_conflict_problems(scene, cells, walls))
    _refuse(structure_conflict_problems(scene, cells, walls, structures))
    fluids = {name: _clear_of_walls(scene, points, walls, structures) for name, points in cells.items()}
    kinds = {"fluids": fluids, "boundaries": walls, "structures": structures}
    _refuse([problem for kind, sets in kinds.items() for problem in empty_problems(kind, sets)])
    _refuse(overlap_problems("fluids", fluids, scene.spacing))
    _refuse(overlap_problems("structures", structures, scene.spacing))
    sets = (
        *_fluid_sets(scene, fluids),
        *_boundary_sets(scene, walls),
        *_structure_sets(scene, structures),
    )
    placed = filled | layers
    return tuple(replace(one, evenness=placed[one.name].evenness) for one in sets)


def _refuse(problems: Iterable[Problem]) -> None:
    found = list(problems)
    if found:
        raise SceneError(found)


def _filled(body: Fluid | Structure, lattice: Lattice, period: Period) -> Placed:
    """The particles of a body."""
    points = cells_inside(lattice, body.shape).positions()
    if body.placement == "lattice":
        return Placed(points)
    return relaxed(points, body_region(body.shape, period), lattice)


def _joined_walls(scene: Scene, layers: Mapping[str, Placed]) -> Positions:
    """Wall particles; where walls overlap that move alike, those of the later one are left out."""
    walls: dict[str, np.ndarray] = {}
    for name, boundary in scene.boundaries.items():
        points = layers[name].position
        for earlier, others in walls.items():
            if scene.boundaries[earlier].motion == boundary.motion:
                points = away_from(points, others, CLOSEST * scene.spacing)
        walls[name] = points
    return walls


def _clear_of_clamps(scene: Scene, walls: Positions, structures: Positions) -> Positions:
    """Walls without the particles in whose places structures are clamped, which act on the fluid as walls do."""
    if not scene.fluids:
        return walls
    held = [points[clamped(scene, name, points)] for name, points in structures.items()]
    others = np.concatenate([np.empty((0, scene.dimension)), *held])
    return {name: away_from(points, others, CLOSEST * scene.spacing) for name, points in walls.items()}


def _clear_of_walls(scene: Scene, points: np.ndarray, walls: Positions, structures: Positions) -> np.ndarray:
    for name, boundary in scene.boundaries.items():
        points = clear_of_wall(points, boundary, walls[name], scene.spacing)
    for name, structure in scene.structures.items():
        points = clear_of_wall(points, as_wall(structure), structures[name], scene.spacing)
    return points


def _fluid_sets(scene: Scene, fluids: Positions) -> list[SampledSet]:
    volume = scene.spacing**scene.dimension
    return [
        SampledSet(
            name=name,
            kind="fluid",
            position=position,
            velocity=initial_field(scene.fluids[name].velocity, position, f"fluids.{name}.velocity"),
            pressure=initial_pressure(
                scene.fluids[name], position, scene.gravity, scene.spacing, f"fluids.{name}"
            ),
            volume=volume,
        )
        for name, position in fluids.items()
    ]


def _structure_sets(scene: Scene, structures: Positions) -> list[SampledSet]:
    return [
        SampledSet(
            name=name,
            kind="structure",
            position=position,
            velocity=initial_field(scene.structures[name].velocity, position, f"structures.{name}.velocity"),
            pressure=np.zeros(len(position)),
            volume=scene.spacing**scene.dimension,
        )
        for name, position in structures.items()
    ]


def _boundary_sets(scene: Scene, walls: Positions) -> list[SampledSet]:
    motions = rigid_motions(scene)
    volume = scene.spacing**scene.dimension
    return [
        SampledSet(
            name=name,
            kind="boundary",
            position=position,
            velocity=motions[name](0.0).velocity_of(position) if name in motions else np.zeros_like(position),
            pressure=np.zeros(len(position)),
            volume=volume,
        )
        for name, position in walls.items()
    ]
