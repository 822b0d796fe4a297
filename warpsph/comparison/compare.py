"""Compare a run with the references of its scene: pure functions of probe histories and frames.

Two steps, so that no frame has to be kept: `field_samples` takes from each frame, as it passes, what the
references need of it, and `compare_run` makes the rows at the end.
"""

from __future__ import annotations

from collections.abc import Iterable

from warpsph.comparison.features import compare_feature
from warpsph.comparison.fields import FieldSample, compare_field, field_samples, fields_needed
from warpsph.comparison.limits import compare_limit
from warpsph.comparison.row import Comparison, History
from warpsph.comparison.series import compare_series
from warpsph.scene.references import (
    FeatureReference,
    FieldReference,
    LimitReference,
    ProfileReference,
    SeriesReference,
)
from warpsph.scene.schema import Scene

__all__ = ["Comparison", "FieldSample", "History", "compare_run", "field_samples", "fields_needed"]


def compare_run(
    scene: Scene, history: History, samples: Iterable[FieldSample] = ()
) -> tuple[Comparison, ...]:
    """One row for each reference of the scene, in its order.

    `history` holds every probe column that a reference names, `samples` the `field_samples` of all frames
    of the run. What the run did not reach, or what is no number, never holds. Raises KeyError where a
    column is missing.
    """
    samples = tuple(samples)
    rows = []
    for name, reference in scene.references.items():
        match reference:
            case SeriesReference():
                rows.append(compare_series(name, reference, scene, history))
            case FieldReference() | ProfileReference():
                rows.append(compare_field(name, reference, scene, samples))
            case FeatureReference():
                rows.append(compare_feature(name, reference, scene, history))
            case LimitReference():
                rows.append(compare_limit(name, reference, scene, history))
    return tuple(rows)
