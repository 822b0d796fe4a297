"""Checks of structures, their clamps and loads, and of contact."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from warpsph.laws.materials import MATERIAL_LAWS
from warpsph.scene.checks.bonds import bond_problems
from warpsph.scene.checks.common import (
    DeclaredNames,
    expression_problems,
    no_such_axis,
    prefixed,
    repeated_problems,
    unknown_name,
    vector_field_problems,
)
from warpsph.scene.checks.rigid import rigid_problems
from warpsph.scene.errors import Problem
from warpsph.scene.types import AXES

if TYPE_CHECKING:
    from warpsph.scene.schema import Scene
    from warpsph.scene.structures import Clamp, Load, Structure


def structure_problems(scene: Scene, names: DeclaredNames) -> Iterator[Problem]:
    """What is wrong with structures, less where they are."""
    yield from _company_problems(scene, names)
    for name, structure in scene.structures.items():
        key = f"structures.{name}"
        if name in names.fluids | names.boundaries:
            message = f"another set has the name {name!r} already"
            yield Problem.at(key, message, "a name that no other set has", name)
        yield from prefixed(f"{key}.shape", structure.shape.dimension_problems(scene.dimension))
        yield from vector_field_problems(f"{key}.velocity", structure.velocity, scene.dimension)
        yield from vector_field_problems(f"{key}.displacement", structure.displacement, scene.dimension)
        if structure.material.law not in MATERIAL_LAWS:
            yield unknown_name(f"{key}.material.law", "law", structure.material.law, MATERIAL_LAWS)
        yield from _slip_problems(structure, scene, names, key)
        yield from _plane_problems(structure, scene.dimension, key)
        yield from rigid_problems(scene, structure, key)
        for name_of_clamp, clamp in structure.clamps.items():
            yield from _clamp_problems(clamp, scene.dimension, f"{key}.clamps.{name_of_clamp}")
        for name_of_load, load in structure.loads.items():
            yield from _load_problems(load, scene.dimension, f"{key}.loads.{name_of_load}")


def _company_problems(scene: Scene, names: DeclaredNames) -> Iterator[Problem]:
    if not names.fluids and not names.structures:
        yield Problem.at("fluids", "the scene has neither fluids nor structures", "at least one of them")
    yield from _coupling_problems(scene, names)
    yield from bond_problems(scene, names)
    if scene.contact is not None and not names.structures:
        yield Problem.at("contact", "there is no structure to be touched", "contact beside structures")
    if scene.contact is not None and (scene.domain.periodic or scene.domain.symmetry):
        message = "contact does not reach over periodic faces and planes of symmetry yet"
        yield Problem.at("contact", message, "no contact, or neither periodic axes nor symmetry")


def _coupling_problems(scene: Scene, names: DeclaredNames) -> Iterator[Problem]:
    if scene.coupling != type(scene.coupling)() and not (names.fluids and names.structures):
        yield Problem.at("coupling", "there is nothing to couple", "coupling beside fluids and structures")
    if not (scene.fluids and scene.structures):
        return
    if scene.domain.symmetry:
        message = "structures have no images beyond planes of symmetry yet"
        yield Problem.at("domain.symmetry", message, "no planes where fluids and structures meet")
    if scene.numerics.structure.solution.type == "static":
        message = "fluids move in time, and structures in them have to"
        yield Problem.at("numerics.structure.solution.type", message, "dynamic", "static")


def _slip_problems(structure: Structure, scene: Scene, names: DeclaredNames, key: str) -> Iterator[Problem]:
    if structure.slip == "free_slip":
        return
    if not names.fluids:
        yield Problem.at(f"{key}.slip", "there is no fluid to stick to it", "free_slip", structure.slip)
    elif scene.numerics.viscosity.type == "none":
        message = "a fluid without viscosity cannot stick to a structure"
        yield Problem.at(f"{key}.slip", message, "free_slip, or a numerics.viscosity", structure.slip)


def _plane_problems(structure: Structure, dimension: int, key: str) -> Iterator[Problem]:
    if structure.plane == "strain":
        return
    if dimension == 3:
        yield Problem.at(f"{key}.plane", "there is no plane in three dimensions", "strain", structure.plane)
    law = MATERIAL_LAWS.get(structure.material.law)
    if law is not None and not law.plane_stress:
        message = f"{structure.material.law} is not there for plane stress"
        yield Problem.at(f"{key}.plane", message, "strain, or another material.law", structure.plane)


def _clamp_problems(clamp: Clamp, dimension: int, key: str) -> Iterator[Problem]:
    yield from prefixed(f"{key}.region", clamp.region.dimension_problems(dimension))
    for index, motion in enumerate(clamp.motion):
        yield from prefixed(f"{key}.motion.{index}", motion.dimension_problems(dimension))
    if clamp.axes is None:
        return
    yield from repeated_problems(f"{key}.axes", clamp.axes)
    if not clamp.axes:
        yield Problem.at(f"{key}.axes", "no component is prescribed", "at least one axis, or null for all")
    for index, axis in enumerate(clamp.axes):
        if axis not in AXES[:dimension]:
            yield no_such_axis(f"{key}.axes.{index}", axis, dimension)


def _load_problems(load: Load, dimension: int, key: str) -> Iterator[Problem]:
    if load.region is not None:
        yield from prefixed(f"{key}.region", load.region.dimension_problems(dimension))
    yield from expression_problems(f"{key}.factor", load.factor, ("t",))
