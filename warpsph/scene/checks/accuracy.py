"""Consistency of the accuracy that a scene asks for with what it computes."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING

from warpsph.scene.checks.common import DeclaredNames, unknown_name
from warpsph.scene.checks.references import figure_problems
from warpsph.scene.errors import Problem
from warpsph.scene.references import FieldReference, LimitReference, Reference

if TYPE_CHECKING:
    from warpsph.scene.schema import Scene

SMALLEST_RATIO = 1.1
"""Of the spacings of pilots: what changes less drowns in how particles happen to stand."""


def accuracy_problems(scene: Scene, names: DeclaredNames) -> Iterator[Problem]:
    """Quantities that the scene does not have, or that have no value to converge, and pilots too close together."""
    accuracy = scene.accuracy
    if accuracy is None:
        return
    if not isinstance(accuracy.quantity, str):
        yield from figure_problems(accuracy.quantity, scene, names, "accuracy.quantity")
    elif accuracy.quantity not in names.references:
        yield unknown_name("accuracy.quantity", "reference", accuracy.quantity, names.references)
    elif accuracy.quantity in scene.references:
        yield from _kind_problems(accuracy.quantity, scene.references[accuracy.quantity])
    for index, (coarse, fine) in enumerate(pairwise(accuracy.pilots or ())):
        if coarse < SMALLEST_RATIO * fine:
            message = f"the pilot before it has {coarse:g} m"
            allowed = (
                f"at most {coarse / SMALLEST_RATIO:.4g}: coarse ones first, {SMALLEST_RATIO} times apart"
            )
            yield Problem.at(f"accuracy.pilots.{index + 1}", message, allowed, fine)


def _kind_problems(name: str, reference: Reference) -> Iterator[Problem]:
    if isinstance(reference, LimitReference):
        message, allowed = "a limit is kept or not: it has no value that converges", "another reference"
        yield Problem.at("accuracy.quantity", message, allowed, name)
    if isinstance(reference, FieldReference) and reference.norm != "rms":
        message = f"norm: max of {name} is a particle here and another there, and does not converge"
        yield Problem.at("accuracy.quantity", message, "a field with norm: rms, or another reference", name)
