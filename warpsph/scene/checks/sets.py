"""Checks of fluids and boundaries."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from warpsph.scene.checks.common import DeclaredNames, expression_problems, prefixed, vector_field_problems
from warpsph.scene.errors import Problem
from warpsph.scene.types import AXES

if TYPE_CHECKING:
    from warpsph.scene.schema import Boundary, Fluid, Scene


def fluid_problems(scene: Scene) -> Iterator[Problem]:
    """What is wrong with fluids, less where they are."""
    for name, fluid in scene.fluids.items():
        key = f"fluids.{name}"
        yield from prefixed(f"{key}.shape", fluid.shape.dimension_problems(scene.dimension))
        yield from vector_field_problems(f"{key}.velocity", fluid.velocity, scene.dimension)
        yield from _speed_problems(scene, fluid, f"{key}.velocity")
        yield from _phase_problems(scene, fluid, key)
        pressure = fluid.pressure
        if pressure.type == "hydrostatic" and pressure.surface != "auto" and not any(scene.gravity):
            message = "without gravity there is no hydrostatic pressure"
            yield Problem.at(f"{key}.pressure.surface", message, "auto, or a gravity", pressure.surface)
        if pressure.type == "expression":
            yield from expression_problems(f"{key}.pressure.value", pressure.value, AXES[: scene.dimension])


def _phase_problems(scene: Scene, fluid: Fluid, key: str) -> Iterator[Problem]:
    first_name, first = next(iter(scene.fluids.items()))
    for quantity in ("density", "kinematic_viscosity"):
        value, expected = getattr(fluid, quantity), getattr(first, quantity)
        if value != expected:
            message = f"all fluids of a scene are one phase, and {first_name} has {expected:g}"
            yield Problem.at(f"{key}.{quantity}", message, f"{expected:g}", value)


def _speed_problems(scene: Scene, fluid: Fluid, key: str) -> Iterator[Problem]:
    velocity = fluid.velocity
    if velocity is None:
        return
    numbers = [component for component in velocity if not isinstance(component, str)]
    speed, sound_speed = math.hypot(*numbers), scene.numerics.sound_speed
    if sound_speed != "auto" and speed >= sound_speed:
        message = f"{speed:g} m/s is not below the sound speed of this weakly compressible fluid"
        yield Problem.at(key, message, f"much less than {sound_speed:g} m/s", list(velocity))


def boundary_problems(scene: Scene, names: DeclaredNames) -> Iterator[Problem]:
    """What is wrong with boundaries, less where they are."""
    for name, boundary in scene.boundaries.items():
        key = f"boundaries.{name}"
        if name in names.fluids:
            yield Problem.at(
                key, f"a fluid has the name {name!r} already", "a name that no other set has", name
            )
        yield from prefixed(f"{key}.shape", boundary.shape.dimension_problems(scene.dimension))
        for index, motion in enumerate(boundary.motion):
            yield from prefixed(f"{key}.motion.{index}", motion.dimension_problems(scene.dimension))
        yield from _open_face_problems(boundary, scene.dimension, f"{key}.open")
        if boundary.shape.type == "plane" and boundary.placement != "auto":
            message = "layers follow a plane without it"
            yield Problem.at(f"{key}.placement", message, "auto", boundary.placement)
        if boundary.slip == "no_slip" and scene.numerics.viscosity.type == "none":
            message = "a fluid without viscosity cannot stick to a wall"
            yield Problem.at(f"{key}.slip", message, "free_slip, or a numerics.viscosity", boundary.slip)


def _open_face_problems(boundary: Boundary, dimension: int, key: str) -> Iterator[Problem]:
    if not boundary.open:
        return
    faces = [f"{axis}_{end}" for axis in AXES[:dimension] for end in ("min", "max")]
    if boundary.shape.type not in ("box", "mesh", "polygon"):
        message = f"a {boundary.shape.type} has no faces to open"
        yield Problem.at(
            key, message, "open only where shape is a box, a mesh or a polygon", list(boundary.open)
        )
    elif boundary.side == "solid":
        yield Problem.at(key, "a solid has no faces to open", "side: outside or inside", list(boundary.open))
    elif set(boundary.open) >= set(faces):
        yield Problem.at(key, "with every face open no wall is left", "fewer faces", list(boundary.open))
    for index, face in enumerate(boundary.open):
        if face not in faces:
            yield Problem.at(
                f"{key}.{index}", f"there is no z where dimension is {dimension}", ", ".join(faces), face
            )
