"""Checks of rigid bodies."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from warpsph.scene.checks.common import prefixed, repeated_problems
from warpsph.scene.errors import Problem
from warpsph.scene.motion import TurningMotion
from warpsph.scene.rigid import Rigid, axes_of, inertia_tensor

if TYPE_CHECKING:
    from warpsph.scene.schema import Scene
    from warpsph.scene.structures import Structure

INERTIA_FORMS = {
    2: ((1,), "one number"),
    3: ((3, 6), "three moments xx, yy, zz, or six components xx, yy, zz, xy, xz, yz"),
}
"""How many numbers an inertia may have by the dimension, and how to say so."""


def rigid_problems(scene: Scene, structure: Structure, key: str) -> Iterator[Problem]:
    """What is wrong with a structure that is rigid; nothing if it is not. `key` is the structure's."""
    rigid = structure.rigid
    if rigid is None:
        return
    yield from _deformable_problems(structure, key)
    if scene.numerics.structure.solution.type == "static":
        message = "a rigid body has no equilibrium of its own"
        yield Problem.at(f"{key}.rigid", message, "numerics.structure.solution: {type: dynamic}")
    yield from _axis_problems(rigid, scene.dimension, f"{key}.rigid")
    yield from _inertia_problems(rigid, scene.dimension, f"{key}.rigid.inertia")
    yield from _pivot_problems(rigid, scene.dimension, f"{key}.rigid.pivot")
    yield from _motion_problems(rigid, scene.dimension, f"{key}.rigid.motion")


def _deformable_problems(structure: Structure, key: str) -> Iterator[Problem]:
    if structure.clamps:
        message = "a rigid body is held by its axes, not by clamps"
        yield Problem.at(f"{key}.clamps", message, "no clamps, and rigid.free", list(structure.clamps))
    if structure.displacement is not None:
        message = "a rigid body begins where its shape is"
        yield Problem.at(f"{key}.displacement", message, "null, and a shape in the right place")
    if structure.damping > 0.0:
        message = "a rigid body is not damped"
        yield Problem.at(f"{key}.damping", message, "0", structure.damping)


def _axis_problems(rigid: Rigid, dimension: int, key: str) -> Iterator[Problem]:
    if rigid.free is None:
        return
    yield from repeated_problems(f"{key}.free", rigid.free)
    known = axes_of(dimension)
    for index, axis in enumerate(rigid.free):
        if axis not in known:
            message = f"there is no {axis} where dimension is {dimension}"
            yield Problem.at(f"{key}.free.{index}", message, ", ".join(known), axis)


def _inertia_problems(rigid: Rigid, dimension: int, key: str) -> Iterator[Problem]:
    if rigid.inertia is None:
        return
    counts, allowed = INERTIA_FORMS[dimension]
    given = list(rigid.inertia)
    if len(given) not in counts:
        yield Problem.at(key, f"{len(given)} numbers where dimension is {dimension}", allowed, given)
    elif np.linalg.eigvalsh(inertia_tensor(rigid.inertia)).min() <= 0.0:
        yield Problem.at(key, "a body resists every rotation", "positive principal moments", given)


def _pivot_problems(rigid: Rigid, dimension: int, key: str) -> Iterator[Problem]:
    if rigid.pivot is None:
        return
    pivot, free = list(rigid.pivot), rigid.free_axes(dimension)
    if free & {"x", "y", "z"}:
        message = "a body that can move along an axis does not turn about a fixed point"
        yield Problem.at(key, message, "null, or a rigid.free with rotations only", pivot)
    elif not free:
        yield Problem.at(key, "the body does not turn", "null, or a rotation in rigid.free", pivot)
    if rigid.motion:
        yield Problem.at(key, "a pivot stays where it is", "null, or no rigid.motion", pivot)


def _motion_problems(rigid: Rigid, dimension: int, key: str) -> Iterator[Problem]:
    for index, motion in enumerate(rigid.motion):
        yield from prefixed(f"{key}.{index}", motion.dimension_problems(dimension))
    free = rigid.free_axes(dimension)
    if rigid.motion and free >= set(axes_of(dimension)):
        yield Problem.at(key, "all axes are free: none is left to be prescribed", "none, or fewer free axes")
        return
    turning = sorted(axis for axis in free if axis.startswith("r"))
    for index, motion in enumerate(rigid.motion):
        if turning and isinstance(motion, TurningMotion) and motion.turns():
            message = f"the motion turns the body, whose {', '.join(turning)} is free"
            yield Problem.at(f"{key}.{index}", message, "a translation, or no free rotation")
