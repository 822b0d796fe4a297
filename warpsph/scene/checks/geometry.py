"""Checks of where fluids, structures and boundaries are, and of the particle number that follows."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from warpsph.scene.bounds import bounding_box
from warpsph.scene.errors import Problem
from warpsph.scene.types import AXES

if TYPE_CHECKING:
    from warpsph.scene.schema import Scene

MAX_PARTICLES = 2**31 - 1
_ROUNDING = 1e-9

Box = tuple[np.ndarray, np.ndarray]


def geometry_problems(scene: Scene) -> Iterator[Problem]:
    """Shapes that are empty, endless, thinner than a particle, too large, or outside the domain."""
    fluids = {f"fluids.{name}.shape": bounding_box(fluid.shape) for name, fluid in scene.fluids.items()}
    boxes = fluids | {
        f"structures.{name}.shape": bounding_box(structure.shape)
        for name, structure in scene.structures.items()
    }
    problems = [*_endless_problems(boxes)]
    yield from problems
    if problems:
        return
    yield from _kill_box_problems(scene, boxes)
    yield from _period_problems(scene, boxes)
    yield from _symmetry_problems(scene, boxes)
    walls = {f"boundaries.{name}.shape": bounding_box(wall.shape) for name, wall in scene.boundaries.items()}
    if not boxes:
        return  # every body is refused for reasons of its own
    for key, spacing in _spacings(scene):
        yield from _thin_problems(key, spacing, boxes | walls)
        yield from _number_problems(key, spacing, boxes)


def _spacings(scene: Scene) -> Iterator[tuple[str, float]]:
    yield "spacing", scene.spacing
    if scene.validation is not None:
        for tier in ("resolutions", "quick"):
            for index, spacing in enumerate(getattr(scene.validation, tier)):
                yield f"validation.{tier}.{index}", spacing
    if scene.accuracy is not None:
        for index, spacing in enumerate(scene.accuracy.pilots or ()):
            yield f"accuracy.pilots.{index}", spacing


def _endless_problems(bodies: dict[str, Box]) -> Iterator[Problem]:
    for key, (low, high) in bodies.items():
        if not np.isfinite([low, high]).all():
            yield Problem.at(key, "a body without end cannot be filled", "a shape that ends on all sides")


def _thin_problems(key: str, spacing: float, boxes: dict[str, Box]) -> Iterator[Problem]:
    """The thinnest shape that the spacing cannot resolve; an empty intersection is thinner than anything."""
    thickness = {name: float(np.min(high - low)) for name, (low, high) in boxes.items()}
    name = min(thickness, key=lambda name: thickness[name])
    if spacing > thickness[name] * (1.0 + _ROUNDING):
        size = max(thickness[name], 0.0)
        message = f"the particle spacing is larger than {name}, which is {size:g} m across"
        yield Problem.at(key, message, f"at most {size:g} m, better a tenth of it", spacing)


def _number_problems(key: str, spacing: float, bodies: dict[str, Box]) -> Iterator[Problem]:
    numbers = {
        name: math.prod(float(length) / spacing for length in high - low)
        for name, (low, high) in bodies.items()
    }
    number = sum(numbers.values())
    if number > MAX_PARTICLES:
        largest = max(numbers, key=lambda name: numbers[name])
        low, high = bodies[largest]
        size = " x ".join(f"{length:.4g}" for length in high - low)
        message = (
            f"fluids and structures need up to {number:.2g} particles, most of them {largest} of {size} m"
        )
        coarser = spacing * (number / MAX_PARTICLES) ** (1.0 / len(low))
        yield Problem.at(key, message, f"{MAX_PARTICLES} particles: at least {coarser:.3g} m", spacing)


def _kill_box_problems(scene: Scene, bodies: dict[str, Box]) -> Iterator[Problem]:
    box = scene.domain.kill_box
    if box is None:
        return
    margin = _ROUNDING * np.abs(np.subtract(box.max, box.min))
    for key, (low, high) in bodies.items():
        if (low < box.min - margin).any() or (high > box.max + margin).any():
            message = f"{key} reaches out of the kill box, so particles would be removed at once"
            yield Problem.at("domain.kill_box", message, f"a box around {_corners(low, high)}")


def _period_problems(scene: Scene, bodies: dict[str, Box]) -> Iterator[Problem]:
    for axis, (start, end) in scene.domain.periodic.items():
        index, margin = AXES.index(axis), _ROUNDING * abs(end - start)
        for key, (low, high) in bodies.items():
            if low[index] < start - margin or high[index] > end + margin:
                message = f"it reaches from {low[index]:g} to {high[index]:g} m in {axis}, out of the period"
                yield Problem.at(key, message, f"{start:g} to {end:g} m, as in domain.periodic.{axis}")


def _symmetry_problems(scene: Scene, fluids: dict[str, Box]) -> Iterator[Problem]:
    for face, plane in scene.domain.symmetry.items():
        index = AXES.index(face[0])
        for key, (low, high) in fluids.items():
            margin = _ROUNDING * abs(high[index] - low[index])
            beyond = low[index] < plane - margin if face.endswith("min") else high[index] > plane + margin
            if beyond:
                message = (
                    f"in {face[0]} it reaches from {low[index]:g} to {high[index]:g} m, beyond the plane"
                )
                yield Problem.at(key, message, f"inside of {plane:g} m, as in domain.symmetry.{face}")


def _corners(low: np.ndarray, high: np.ndarray) -> str:
    return f"{low.tolist()} to {high.tolist()}"
