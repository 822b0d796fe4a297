"""Until when a run has to go for what it is compared with."""

from __future__ import annotations

from warpsph.comparison.series import read_table
from warpsph.scene.references import (
    FeatureReference,
    FieldReference,
    LimitReference,
    ProfileReference,
    Reference,
    SeriesReference,
)
from warpsph.scene.schema import Scene

ONCE = frozenset({"arrival", "first_peak", "first_peak_time"})
"""Features that are complete when they have happened, however long the run goes on."""


def beyond_the_end(scene: Scene, whole: float) -> dict[str, float]:
    """The references that a shortened scene cannot serve, with the times [s] until which they look at a run.

    `whole` is the end [s] of the scene that has not been shortened, where references look that name no times. Limits
    without a window and series without chosen times are of whatever lies within the run.
    """
    times = {name: last_time(reference, scene, whole) for name, reference in scene.references.items()}
    return {name: time for name, time in times.items() if time > scene.time.end * (1.0 + 1e-9)}


def last_time(reference: Reference, scene: Scene, whole: float) -> float:
    """The time [s] to which a run has to come for a reference."""
    match reference:
        case SeriesReference():
            return max(reference.at) if reference.at else float(read_table(reference, scene).time.min())
        case FieldReference() | ProfileReference():
            return max(reference.at) if reference.at else whole
        case LimitReference():
            return reference.window[1] if reference.window else 0.0
        case FeatureReference():
            return _end_of(reference, whole)


def _end_of(reference: FeatureReference, whole: float) -> float:
    if reference.window:
        return reference.window[1]
    if reference.feature not in ONCE:
        return whole
    is_time = reference.feature != "first_peak"
    return reference.value if is_time and reference.value else 0.0
