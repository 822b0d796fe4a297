"""Consistency of probes of force coefficients with the rest of the scene."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from warpsph.scene.checks.common import DeclaredNames, prefixed, repeated_problems, unknown_name
from warpsph.scene.errors import Problem
from warpsph.scene.probes import ForceCoefficientsProbe

if TYPE_CHECKING:
    from warpsph.scene.schema import Scene

PERPENDICULAR = 1e-6
"""Largest cosine between the directions of drag and lift."""


def coefficient_problems(scene: Scene, names: DeclaredNames) -> Iterator[Problem]:
    """Probes of force coefficients without bodies, flow, directions or lengths."""
    for name, probe in scene.probes.items():
        if isinstance(probe, ForceCoefficientsProbe):
            problems = (
                *_body_problems(probe, names),
                *_direction_problems(probe, scene),
                *_span(probe, scene),
            )
            yield from prefixed(f"probes.{name}", problems)


def _body_problems(probe: ForceCoefficientsProbe, names: DeclaredNames) -> Iterator[Problem]:
    if not (probe.boundaries or probe.structures):
        yield Problem.at("boundaries", "it looks at no body", "names under boundaries or structures")
    if not names.fluids:
        yield Problem.at("type", "no fluid acts on bodies of this scene", "a scene with a fluid", probe.type)
    for key, kind, known in (
        ("boundaries", "boundary", names.boundaries),
        ("structures", "structure", names.structures),
    ):
        listed = getattr(probe, key)
        yield from repeated_problems(key, listed)
        for index, name in enumerate(listed):
            if name not in known:
                yield unknown_name(f"{key}.{index}", kind, name, known)


def _direction_problems(probe: ForceCoefficientsProbe, scene: Scene) -> Iterator[Problem]:
    dimension = scene.dimension
    if any(v is not None and len(v) != dimension for v in (probe.drag, probe.lift)):
        return  # said of every vector of the scene
    drag, lift = (np.array(probe.direction(force, dimension)) for force in ("drag", "lift"))
    for key, direction in (("drag", drag), ("lift", lift)):
        if not direction.any():
            yield Problem.at(
                key, "a zero vector has no direction", "a vector of any length", direction.tolist()
            )
    if abs(drag @ lift) > PERPENDICULAR * np.linalg.norm(drag) * np.linalg.norm(lift):
        message = f"lift {lift.tolist()} is not perpendicular to drag {drag.tolist()}"
        yield Problem.at("lift", message, "a direction across that of drag", probe.lift)


def _span(probe: ForceCoefficientsProbe, scene: Scene) -> Iterator[Problem]:
    if (probe.span is None) == (scene.dimension == 3):
        in_space = scene.dimension == 3
        message = f"coefficients in {scene.dimension} dimensions are {'' if in_space else 'not '}over a span"
        allowed = "a length [m]" if in_space else "null"
        yield Problem.at("span", message, allowed, probe.span)
