"""What all shapes have in common."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from warpsph.scene.errors import Problem
from warpsph.scene.types import SceneModel

if TYPE_CHECKING:
    from warpsph.scene.shapes import Shape


class ShapeModel(SceneModel):
    """Base of all shapes."""

    def parts(self) -> Iterator[tuple[str, Shape]]:
        """The shapes that this one is made of, each with its key relative to this shape."""
        yield from ()

    def dimension_problems(self, dimension: int) -> Iterator[Problem]:
        """What, beside the length of its vectors, cannot stand in this dimension; keys are relative."""
        for key, part in self.parts():
            for problem in part.dimension_problems(dimension):
                yield replace(problem, key=f"{key}.{problem.key}")

    def _exists_only_in(self, required: int, dimension: int, instead: str) -> Iterator[Problem]:
        kind = getattr(self, "type")  # noqa: B009 (each shape declares its own literal)
        if dimension != required:
            message = f"a {kind} exists only where dimension is {required}"
            yield Problem.at("type", message, f"{instead} where dimension is {dimension}", kind)
