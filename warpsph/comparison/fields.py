"""Fields of particles against expressions, taken from frames as they pass."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from warpsph.comparison.row import Comparison, Sample, relative_errors, representative
from warpsph.frame import Frame, SetFrame
from warpsph.scene.expressions import evaluate
from warpsph.scene.references import FieldReference
from warpsph.scene.schema import Scene
from warpsph.scene.types import AXES


@dataclass(frozen=True)
class FieldSample:
    """A field against its expression at one frame, reduced over the particles in the norm of the reference.

    `asked_time` is the time that the reference names [s], `frame_time` that of the frame.
    """

    reference: str
    asked_time: float
    frame_time: float
    value: float
    expected: float
    error: float


def fields_needed(scene: Scene) -> frozenset[str]:
    """Fields that every frame must carry for `field_samples`, beside `position`."""
    return frozenset(_stored_name(reference.field) for _, reference in _field_references(scene))


def field_samples(scene: Scene, frame: Frame) -> tuple[FieldSample, ...]:
    """What the field references of the scene need from this frame; empty if none asks for a time near it."""
    half_interval = 0.5 / scene.time.frame_rate * (1.0 + 1e-6)
    return tuple(
        _sample(name, reference, asked, frame)
        for name, reference in _field_references(scene)
        for asked in _asked_times(reference, scene)
        if abs(frame.time - asked) <= half_interval
    )


def compare_field(
    name: str, reference: FieldReference, scene: Scene, samples: Iterable[FieldSample]
) -> Comparison:
    """The row of a field reference, from the samples of all frames; a time without a frame is no number."""
    asked = _asked_times(reference, scene)
    own = [sample for sample in samples if sample.reference == name]
    nearest = tuple(_nearest(own, time) for time in asked)
    values, targets, errors = np.array([(s.value, s.reference, s.error) for s in nearest]).T
    value, target, error = representative(values, targets, errors, reference.norm)
    missing = [time for time, sample in zip(asked, nearest, strict=True) if not math.isfinite(sample.error)]
    return Comparison(
        quantity=name,
        compared=f"{reference.set}.{reference.field}",
        norm=reference.norm,
        value=value,
        reference=target,
        error=error,
        bound=reference.bound,
        uncertainty=reference.uncertainty,
        source=reference.source,
        samples=nearest,
        note=f"no value at t = {missing[0]:.6g} s" if missing else None,
    )


def _field_references(scene: Scene) -> list[tuple[str, FieldReference]]:
    return [(name, r) for name, r in scene.references.items() if isinstance(r, FieldReference)]


def _asked_times(reference: FieldReference, scene: Scene) -> tuple[float, ...]:
    return reference.at if reference.at is not None else (scene.time.end,)


def _sample(name: str, reference: FieldReference, asked: float, frame: Frame) -> FieldSample:
    particles = frame.set_named(reference.set)
    position = particles.fields["position"]
    coordinates = dict(zip(AXES, position.T, strict=False))
    expected = evaluate(reference.expression, {**coordinates, "t": frame.time})
    values = _field_values(particles, reference.field)
    errors = relative_errors(values, expected, reference.relative_to)
    return FieldSample(name, asked, frame.time, *representative(values, expected, errors, reference.norm))


def _stored_name(field: str) -> str:
    """Name of the array that holds a field: velocity for velocity_x."""
    return field.rpartition("_")[0] or field


def _field_values(particles: SetFrame, field: str) -> np.ndarray:
    name, _, axis = field.rpartition("_")
    if name:
        return np.asarray(particles.fields[name], dtype=np.float64)[:, "xyz".index(axis)]
    return np.asarray(particles.fields[field], dtype=np.float64)


def _nearest(samples: Iterable[FieldSample], asked: float) -> Sample:
    candidates = [sample for sample in samples if sample.asked_time == asked]
    if not candidates:
        return Sample(asked, math.nan, math.nan, math.nan)
    best = min(candidates, key=lambda sample: abs(sample.frame_time - asked))
    return Sample(best.frame_time, best.value, best.expected, best.error)
