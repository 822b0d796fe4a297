"""From the structures of a scene to the faces that its fluid sees."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
import warp as wp

from warpsph.particles.neighbours import NeighbourSearch
from warpsph.physics.assembly import Assembly, WallRange
from warpsph.physics.boundary import Reaction, WallModel
from warpsph.physics.faces import FaceModel
from warpsph.physics.mirrored_walls import MirroredWalls
from warpsph.physics.wall_motion import resting_poses
from warpsph.sampling import SampledSet
from warpsph.sampling.faces import Faces, faces_of
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.schema import Scene
from warpsph.solver.structure_assembly import Body, StructureParts

CLEAR = 1e-3
"""Part of a spacing by which a thin structure may be thinner than the fluid's reach over it."""


@dataclass(frozen=True)
class SampledFaces(Faces):
    """Faces of all structures, m in all, with owners among all particles of structures.

    set_index: (m,) place of the structure among all sets; no_slip: (m,) 1 where fluid sticks, else 0.
    """

    set_index: np.ndarray
    no_slip: np.ndarray


def sample_faces(scene: Scene, structures: StructureParts) -> SampledFaces:
    """The faces of all structures; those bonded to each other show them as one body.

    Raises SceneError if fluid would act through a structure.
    """
    bodies = structures.bodies
    by_composite = [
        _faces_of_composite(scene, [body for body in bodies if body.composite == number])
        for number in dict.fromkeys(body.composite for body in bodies)
    ]
    joined = {
        member.name: np.concatenate([getattr(faces, member.name) for faces in by_composite])
        for member in fields(Faces)
    }
    problems = [*_thin_problems(scene, structures, joined["owner"], joined["thickness"])]
    if problems:
        raise SceneError(problems)
    names = [*scene.fluids, *scene.boundaries, *scene.structures]
    counts = [body.count for body in bodies]
    set_index = np.repeat([names.index(body.name) for body in bodies], counts)
    sticks = np.repeat([float(scene.structures[body.name].slip == "no_slip") for body in bodies], counts)
    owner = joined["owner"]
    return SampledFaces(**joined, set_index=set_index[owner], no_slip=sticks[owner])


def _faces_of_composite(scene: Scene, members: Sequence[Body]) -> Faces:
    """Faces of one structure or of several that are bonded, with owners among all particles of structures."""
    position = np.concatenate([body.sampled.position for body in members])
    shape = scene.structures[members[0].name].shape if len(members) == 1 else None
    faces = faces_of(position, shape, scene.spacing, scene.support_radius)
    particles = np.concatenate([np.arange(body.first, body.first + body.count) for body in members])
    return replace(faces, owner=particles[faces.owner])


@dataclass(frozen=True)
class FaceParts:
    """Structures in the fluid: what it sees of them, and what connects them."""

    model: WallModel
    faces: FaceModel


def make_faces(
    scene: Scene,
    sets: Sequence[SampledSet],
    assembly: Assembly,
    search: NeighbourSearch,
    place: WallRange,
    structures: StructureParts,
    faces: SampledFaces,
    sides: wp.array,
    fluid_reaction: Reaction,
) -> FaceParts:
    """The passes of faces at a `place` of the index space, by the wall method of the scene."""
    mirror = None
    if assembly.options.wall == "modified_dynamic":
        poses = resting_poses(assembly, len(sets))
        mirror = MirroredWalls(assembly, search, assembly.vectors(faces.way), poses)
    way = mirror.ways if mirror else assembly.vectors(np.zeros((1, scene.dimension)))
    model = WallModel(assembly, place, "face", fluid_reaction, mirror)
    bodies = (structures.model, faces, structures.mass, scene.coupling.velocity)
    return FaceParts(model, FaceModel(assembly, place, *bodies, sides, way, model.force))


def _thin_problems(
    scene: Scene, structures: StructureParts, owner: np.ndarray, thickness: np.ndarray
) -> Iterator[Problem]:
    """Structures so thin that fluid on one side would feel fluid on the other."""
    reach, dp = scene.support_radius, scene.spacing
    for body in structures.bodies:
        own = (owner >= body.first) & (owner < body.first + body.count)
        thinnest = float(thickness[own].min())
        flat = bool(structures.bonds.thin[body.range].any())
        if flat or thinnest + dp < reach - CLEAR * dp:
            size = f"{thinnest:.3g} m thick" if np.isfinite(thinnest) else "a single layer of particles"
            message = (
                f"it is {size} in places: fluid on one side would act through it on fluid on the other, "
                f"whose particles see {reach:.3g} m far"
            )
            allowed = f"a thickness of at least {reach - dp:.3g} m, a smaller spacing or numerics.h_over_dp"
            yield Problem.at(f"structures.{body.name}.shape", message, allowed)
