"""Probe columns that must stay between limits over a window of time."""

from __future__ import annotations

import math

import numpy as np

from warpsph.comparison.row import Comparison, History, column_of
from warpsph.output.probes_csv import TIME_COLUMN
from warpsph.scene.references import Figure, LimitReference
from warpsph.scene.schema import Scene


def compare_limit(name: str, reference: LimitReference, scene: Scene, history: History) -> Comparison:
    """The row of a limit: its error is the violation, in the unit of the column, and its bound is zero.

    `value` is the value that comes nearest to breaking a limit or breaks it most, `reference` that limit. A
    run that ended before the window did, or a value that is no number, does not hold.
    """
    _, values, reached = window_of(reference, scene, history)
    value, limit, violation = _worst(values, reference) if reached and values.size else (math.nan,) * 3
    return Comparison(
        quantity=name,
        compared=reference.column,
        norm="max",
        value=value,
        reference=limit,
        error=violation,
        bound=0.0,
        uncertainty=0.0,
        source=reference.source,
        error_unit=unit_of(reference.column),
        note=None if reached else f"the run ended before t = {_window(reference, scene)[1]:.6g} s",
    )


def window_of(
    reference: LimitReference | Figure, scene: Scene, history: History
) -> tuple[np.ndarray, np.ndarray, bool]:
    """Times [s] and values of the column within the window, and whether the run reached its end."""
    first, last = _window(reference, scene)
    time = history[TIME_COLUMN]
    slack = 1e-9 * max(1.0, last)
    within = (time >= first - slack) & (time <= last + slack)
    reached = time.size > 0 and time[-1] >= last - _sampling_interval(scene) - slack
    unroll = reference.unroll if isinstance(reference, Figure) else None
    return time[within], column_of(history, reference.column, unroll)[within], bool(reached)


def _window(reference: LimitReference | Figure, scene: Scene) -> tuple[float, float]:
    return reference.window or (0.0, scene.time.end)


def unit_of(column: str) -> str:
    """The unit in the brackets of a probe column."""
    return column.rpartition("[")[2].rstrip("]")


def _sampling_interval(scene: Scene) -> float:
    return 1.0 / (scene.output.probe_rate or scene.time.frame_rate)


def _worst(values: np.ndarray, reference: LimitReference) -> tuple[float, float, float]:
    """Value, limit and violation where the signed distance beyond a limit is largest; NaN wins over all."""
    candidates = []
    if reference.low is not None:
        candidates.append((reference.low - np.min(values), np.min(values), reference.low))
    if reference.high is not None:
        candidates.append((np.max(values) - reference.high, np.max(values), reference.high))
    if not all(math.isfinite(beyond) for beyond, _, _ in candidates):
        return math.nan, candidates[0][2], math.nan
    beyond, value, limit = max(candidates)
    return float(value), float(limit), max(0.0, float(beyond))
