"""From a scene and its particles to the arrays and passes of contact."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.contact import ContactOptions

from warpsph.particles.launch import Launcher
from warpsph.physics.contact import ContactModel, ContactSurface, penalty_law
from warpsph.physics.structure import StructureModel
from warpsph.sampling import SampledSet
from warpsph.sampling.kinematics import largest_speed
from warpsph.sampling.surface import at_surface
from warpsph.scene.schema import Scene
from warpsph.scene.structures import Contact

STIFFNESS_RISE = 1.1
"""Largest stiffness of the penalty over that at first touch, for two flat surfaces."""


@dataclass(frozen=True)
class WallPatch:
    """The particles of a wall that may be touched, and where they stand among the contact particles of walls."""

    name: str
    particles: np.ndarray
    first: int

    @property
    def range(self) -> slice:
        return slice(self.first, self.first + len(self.particles))


@dataclass(frozen=True)
class ContactParts:
    """Contact, assembled.

    `stiffness` [1/s^2] is that of the penalty for a pair in antisymmetric motion over the mass of its lightest
    particle; `wall_speed` [m/s] the largest of all walls in the whole run.
    """

    model: ContactModel
    walls: tuple[WallPatch, ...]
    stiffness: float
    wall_speed: float


def assemble_contact(
    scene: Scene,
    sets: Sequence[SampledSet],
    bodies: Sequence[tuple[SampledSet, int]],
    mass: np.ndarray,
    columns: Mapping[str, int],
    structures: StructureModel,
    bond_radius: float,
    launcher: Launcher,
) -> ContactParts:
    """Allocate what contact needs and bind its passes.

    Args:
        bodies: structures in the order of their particles, with the numbers of the bodies that they belong to:
            bonded structures are one body.
        mass: of all particles of structures (n,) [kg].
        columns: column of each moving wall among the prescriptions.
        bond_radius: reach of the bonds of structures [m].
    """
    contact = scene.contact
    assert contact is not None
    walls = tuple(_patches(scene, [s for s in sets if s.kind == "boundary"]))
    surface = _surface(scene, bodies, walls, {s.name: s for s in sets}, columns)
    spring = _spring(scene, contact)
    law = penalty_law(scene.dimension, scene.spacing, spring, contact.friction, bond_radius)
    options = ContactOptions(
        Arithmetic(scene.dimension, scene.numerics.precision), contact.friction > 0.0, contact.own_surface
    )
    model = ContactModel(launcher, options, structures, surface, law)
    stiffness = 2.0 * STIFFNESS_RISE * spring / float(mass.min())
    return ContactParts(model, walls, stiffness, largest_speed(scene, sets))


def _spring(scene: Scene, contact: Contact) -> float:
    """Stiffness between two opposite particles [N/m]: that of a cell of the stiffest material, times the scene's."""
    stiffest = max(structure.material.youngs_modulus for structure in scene.structures.values())
    return contact.stiffness * stiffest * scene.spacing ** (scene.dimension - 2)


def _patches(scene: Scene, walls: Sequence[SampledSet]) -> list[WallPatch]:
    patches, first = [], 0
    for wall in walls:
        chosen = np.flatnonzero(at_surface(wall.position, scene.spacing))
        patches.append(WallPatch(wall.name, chosen, first))
        first += len(chosen)
    return patches


def _surface(
    scene: Scene,
    bodies: Sequence[tuple[SampledSet, int]],
    walls: Sequence[WallPatch],
    sampled: Mapping[str, SampledSet],
    columns: Mapping[str, int],
) -> ContactSurface:
    rest = np.concatenate([sampled.position for sampled, _ in bodies])
    body = np.concatenate([np.full(len(sampled.position), number) for sampled, number in bodies])
    shown = np.zeros(len(rest), dtype=bool)
    for number in np.unique(body):
        shown[body == number] = at_surface(rest[body == number], scene.spacing)
    owner = np.flatnonzero(shown)
    count = sum(len(wall.particles) for wall in walls)
    column = [np.full(len(wall.particles), columns.get(wall.name, -1)) for wall in walls]
    return ContactSurface(
        owner=np.concatenate([owner, *column]),
        body=np.concatenate([body[owner], np.full(count, -1)]),
        rest=np.concatenate([rest[owner], *(sampled[w.name].position[w.particles] for w in walls)]),
        bodies=len(owner),
    )
