"""Checks of open boundaries."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from warpsph.scene.checks.common import (
    DeclaredNames,
    expression_problems,
    unknown_name,
    vector_field_problems,
)
from warpsph.scene.errors import Problem
from warpsph.scene.open_boundaries import ExpressionVelocity, OpenBoundary, PatchShape
from warpsph.scene.types import AXES

if TYPE_CHECKING:
    from warpsph.scene.schema import Scene

_PARALLEL = 1e-6


def open_boundary_problems(scene: Scene, names: DeclaredNames) -> Iterator[Problem]:
    """What is wrong with open boundaries, less where particles are."""
    for name, boundary in scene.open_boundaries.items():
        key = f"open_boundaries.{name}"
        yield from _fluid_problems(scene, names, boundary, key)
        yield from _extent_problems(boundary.shape, scene.dimension, f"{key}.shape")
        if len(boundary.shape.normal) == scene.dimension:
            yield from _period_problems(scene, boundary.shape, f"{key}.shape")
            yield from _level_problems(scene, boundary, key)
        yield from _formula_problems(scene.dimension, boundary, key)
    if scene.open_boundaries and scene.numerics.density == "summation":
        message = "the sum over the neighbours ends at the far end of a buffer"
        yield Problem.at("numerics.density", message, "continuity or mixed", scene.numerics.density)


def _fluid_problems(
    scene: Scene, names: DeclaredNames, boundary: OpenBoundary, key: str
) -> Iterator[Problem]:
    if not names.fluids:
        yield Problem.at(
            key, "fluid enters and leaves here, of which the scene has none", "a scene with a fluid"
        )
    elif boundary.fluid is None and len(names.fluids) > 1:
        message = "the scene has several fluids, and its buffer holds one of them"
        yield Problem.at(f"{key}.fluid", message, ", ".join(sorted(names.fluids)), None)
    elif boundary.fluid is not None and boundary.fluid not in names.fluids:
        yield unknown_name(f"{key}.fluid", "fluid", boundary.fluid, names.fluids)


def _extent_problems(shape: PatchShape, dimension: int, key: str) -> Iterator[Problem]:
    if dimension == 2 and shape.width is None:
        extent = "size" if shape.size is not None else "radius"
        yield Problem.at(f"{key}.{extent}", "in two dimensions a patch is a segment", "its width")
    if dimension == 3 and shape.width is not None:
        message = "in three dimensions a patch is a rectangle or a disc"
        yield Problem.at(f"{key}.width", message, "its size or its radius", shape.width)
    if shape.along is not None and len(shape.along) == len(shape.normal) == 3:
        along, normal = np.array(shape.along), np.array(shape.normal)
        across = np.linalg.norm(np.cross(along, normal))
        if across < _PARALLEL * np.linalg.norm(along) * np.linalg.norm(normal):
            yield Problem.at(
                f"{key}.along", "it is along the normal", "a direction across it", list(shape.along)
            )


def _period_problems(scene: Scene, shape: PatchShape, key: str) -> Iterator[Problem]:
    """A buffer that would go on through a periodic face, or a patch out of the period."""
    normal = np.array(shape.normal) / np.linalg.norm(shape.normal)
    for axis, (low, high) in scene.domain.periodic.items():
        if axis not in AXES[: scene.dimension]:
            continue  # refused elsewhere
        k = AXES.index(axis)
        if abs(normal[k]) > _PARALLEL:
            message = f"fluid enters along {axis}, which is a periodic axis"
            yield Problem.at(f"{key}.normal", message, f"a normal across {axis}", list(shape.normal))
        elif not low <= shape.center[k] <= high:
            message = f"it lies out of the period in {axis}"
            yield Problem.at(f"{key}.center", message, f"{low:g} to {high:g} m", list(shape.center))


def _level_problems(scene: Scene, boundary: OpenBoundary, key: str) -> Iterator[Problem]:
    """A water level without gravity, or on a patch that is not upright."""
    level = getattr(boundary, "level", None)
    if level is None or len(scene.gravity) != scene.dimension:
        return
    if not any(scene.gravity):
        message = "without gravity there is no water level"
        yield Problem.at(f"{key}.level", message, "a scene with gravity, or no level", level)
        return
    up = -np.array(scene.gravity) / np.linalg.norm(scene.gravity)
    normal = np.array(boundary.shape.normal) / np.linalg.norm(boundary.shape.normal)
    if abs(normal @ up) > _PARALLEL:
        message = "a patch with a water level has to be upright"
        yield Problem.at(
            f"{key}.shape.normal", message, "a normal across gravity", list(boundary.shape.normal)
        )


def _formula_problems(dimension: int, boundary: OpenBoundary, key: str) -> Iterator[Problem]:
    variables = (*AXES[:dimension], "t")
    history = getattr(boundary, "history", None)
    if isinstance(history, str):
        yield from expression_problems(f"{key}.history", history, ("t",))
    if boundary.type == "pressure" and isinstance(boundary.pressure, str):
        yield from expression_problems(f"{key}.pressure", boundary.pressure, variables)
    if boundary.type == "velocity" and isinstance(boundary.velocity, ExpressionVelocity):
        value = boundary.velocity.value
        yield from vector_field_problems(f"{key}.velocity.value", value, dimension, variables)
