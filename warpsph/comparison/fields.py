"""Fields against expressions at particles, and against tables along lines, taken from frames as they pass."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from warpsph.comparison.profiles import INTERPOLATED_FROM, profile_values
from warpsph.comparison.row import Comparison, Points, Sample, relative_errors, representative
from warpsph.frame import Frame, SetFrame
from warpsph.scene.expressions import evaluate
from warpsph.scene.references import FieldReference, ProfileReference, bound_at
from warpsph.scene.schema import Scene
from warpsph.scene.types import AXES

FrameReference = FieldReference | ProfileReference


@dataclass(frozen=True)
class FieldSample:
    """A field against its reference at one frame, reduced over particles or points in the norm of the reference.

    `asked_time` is the time that the reference names [s], `frame_time` that of the frame, `points` those of a profile.
    """

    reference: str
    asked_time: float
    frame_time: float
    value: float
    expected: float
    error: float
    points: Points = ()


def fields_needed(scene: Scene) -> frozenset[str]:
    """Fields that every frame must carry for `field_samples`, beside `position`."""
    references = [reference for _, reference in _frame_references(scene)]
    own = {_stored_name(reference.field) for reference in references}
    along_lines = any(isinstance(reference, ProfileReference) for reference in references)
    return frozenset(own | set(INTERPOLATED_FROM if along_lines else ()))


def field_samples(scene: Scene, frame: Frame) -> tuple[FieldSample, ...]:
    """What the field references of the scene need from this frame; empty if none asks for a time near it."""
    half_interval = 0.5 / scene.time.frame_rate * (1.0 + 1e-6)
    return tuple(
        _sample(name, reference, scene, asked, frame)
        for name, reference in _frame_references(scene)
        for asked in _asked_times(reference, scene)
        if abs(frame.time - asked) <= half_interval
    )


def compare_field(
    name: str, reference: FrameReference, scene: Scene, samples: Iterable[FieldSample]
) -> Comparison:
    """The row of a field or profile reference, from the samples of all frames; a time without a frame is no number."""
    asked = _asked_times(reference, scene)
    own = [sample for sample in samples if sample.reference == name]
    nearest = tuple(_nearest(own, time) for time in asked)
    values, targets, errors = np.array([(s.value, s.reference, s.error) for s in nearest]).T
    value, target, error = representative(values, targets, errors, reference.norm)
    missing = [time for time, sample in zip(asked, nearest, strict=True) if not math.isfinite(sample.error)]
    return Comparison(
        quantity=name,
        compared=_compared(reference),
        norm=reference.norm,
        value=value,
        reference=target,
        error=error,
        bound=bound_at(reference.bound, scene.spacing),
        uncertainty=reference.uncertainty,
        source=reference.source,
        samples=nearest,
        note=f"no value at t = {missing[0]:.6g} s" if missing else None,
    )


def field_unit(field: str) -> str:
    """Unit of a compared field."""
    return {"pressure": "Pa", "density": "kg/m3"}.get(field, "m/s")


def _compared(reference: FrameReference) -> str:
    if isinstance(reference, FieldReference):
        return f"{reference.set}.{reference.field}"
    return f"{reference.field} along {reference.axis}"


def _frame_references(scene: Scene) -> list[tuple[str, FrameReference]]:
    return [(n, r) for n, r in scene.references.items() if isinstance(r, FieldReference | ProfileReference)]


def _asked_times(reference: FrameReference, scene: Scene) -> tuple[float, ...]:
    return reference.at if reference.at is not None else (scene.time.end,)


def _sample(name: str, reference: FrameReference, scene: Scene, asked: float, frame: Frame) -> FieldSample:
    points: Points = ()
    if isinstance(reference, ProfileReference):
        position, values, expected = profile_values(reference, scene, frame)
        points = tuple(zip(position.tolist(), values.tolist(), expected.tolist(), strict=True))
    else:
        values, expected = _particle_values(reference, frame)
    errors = relative_errors(values, expected, reference.relative_to)
    return FieldSample(
        name, asked, frame.time, *representative(values, expected, errors, reference.norm), points
    )


def _particle_values(reference: FieldReference, frame: Frame) -> tuple[np.ndarray, np.ndarray]:
    """The field at each particle of the set, and its exact values there."""
    particles = frame.set_named(reference.set)
    coordinates = dict(zip(AXES, particles.fields["position"].T, strict=False))
    expected = evaluate(reference.expression, {**coordinates, "t": frame.time})
    return _field_values(particles, reference.field), expected


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
    return Sample(best.frame_time, best.value, best.expected, best.error, best.points)
