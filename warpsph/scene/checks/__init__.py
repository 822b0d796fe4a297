"""Physics and consistency across a scene: what no single value can know of itself."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from warpsph.scene.checks.accuracy import accuracy_problems
from warpsph.scene.checks.common import DeclaredNames
from warpsph.scene.checks.force_coefficients import coefficient_problems
from warpsph.scene.checks.geometry import geometry_problems
from warpsph.scene.checks.open_boundaries import open_boundary_problems
from warpsph.scene.checks.references import probe_problems, reference_problems
from warpsph.scene.checks.sets import boundary_problems, fluid_problems
from warpsph.scene.checks.settings import domain_problems, settings_problems, symmetry_problems
from warpsph.scene.checks.structures import structure_problems
from warpsph.scene.errors import Problem
from warpsph.scene.types import Components, SceneModel

if TYPE_CHECKING:
    from warpsph.scene.schema import Scene

_SMALLEST, _LARGEST = 1e-30, 1e30

__all__ = ["DeclaredNames", "scene_problems"]


def scene_problems(scene: Scene, declared: DeclaredNames | None = None) -> Iterator[Problem]:
    """Everything that is wrong with a scene whose single values are valid.

    `declared` holds more names than the scene where objects of the file were left out because they are wrong.
    """
    sections = {
        "fluids": scene.fluids,
        "boundaries": scene.boundaries,
        "structures": scene.structures,
        "probes": scene.probes,
        "references": scene.references,
        "open_boundaries": scene.open_boundaries,
    }
    names = declared or DeclaredNames.of(sections)
    of_places = [
        *_value_problems(scene, scene.dimension, ""),
        *domain_problems(scene),
        *symmetry_problems(scene),
        *fluid_problems(scene),
        *boundary_problems(scene, names),
        *structure_problems(scene, names),
        *open_boundary_problems(scene, names),
    ]
    yield from of_places
    if not of_places:
        yield from geometry_problems(scene)
    yield from settings_problems(scene)
    yield from probe_problems(scene, names)
    yield from coefficient_problems(scene, names)
    yield from reference_problems(scene, names)
    yield from accuracy_problems(scene, names)


def _value_problems(value: Any, dimension: int, key: str) -> Iterator[Problem]:
    """Vectors that do not have one component a dimension, and numbers that no physics needs."""
    if isinstance(value, Components) and len(value) != dimension:
        message = f"{len(value)} components where dimension is {dimension}"
        yield Problem.at(key, message, f"{dimension} components", list(value))
    if isinstance(value, float) and value and not _SMALLEST <= abs(value) <= _LARGEST:
        message = "no quantity of a scene is of this magnitude, and arithmetic with it fails"
        yield Problem.at(key, message, f"0, or a magnitude from {_SMALLEST:g} to {_LARGEST:g}", value)
    for name, child in _children(value):
        yield from _value_problems(child, dimension, f"{key}.{name}" if key else str(name))


def _children(value: Any) -> Iterable[tuple[Any, Any]]:
    if isinstance(value, SceneModel):
        return ((name, getattr(value, name)) for name in type(value).model_fields)
    if isinstance(value, Mapping):
        return value.items()
    return enumerate(value) if isinstance(value, tuple) else ()
