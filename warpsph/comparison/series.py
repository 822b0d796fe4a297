"""Probe columns over time against reference series, with the start-up lag that fits best."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from warpsph.comparison.row import (
    Comparison,
    History,
    Sample,
    column_of,
    relative_errors,
    representative,
)
from warpsph.output.probes_csv import TIME_COLUMN
from warpsph.scene.references import InlineTable, SeriesReference, bound_at
from warpsph.scene.schema import Scene
from warpsph.scene.tables import read_columns

LARGEST_LAG = 0.2
"""Lags are sought within this fraction of the last time of comparison, early and late."""

_TRIAL_LAGS = 201
_FEWEST_TIMES_FOR_LAG = 3
_TIME_TOLERANCE = 1e-9


@dataclass(frozen=True)
class Series:
    """Values over increasing times [s], both of shape (n,)."""

    time: np.ndarray
    value: np.ndarray

    def at(self, time: np.ndarray) -> np.ndarray:
        """Linear interpolation; not a number outside the times of the series."""
        slack = _TIME_TOLERANCE * max(1.0, abs(float(self.time[-1])))
        inside = (time >= self.time[0] - slack) & (time <= self.time[-1] + slack)
        return np.where(inside, np.interp(time, self.time, self.value), np.nan)


@dataclass(frozen=True)
class Lagged:
    """The run at times t + lag, the reference at times t, and their signed errors, each of shape (times,)."""

    times: np.ndarray
    values: np.ndarray
    references: np.ndarray
    errors: np.ndarray


def compare_series(name: str, reference: SeriesReference, scene: Scene, history: History) -> Comparison:
    """The row of a series reference; times that the run did not reach are no number.

    With `lag: fit` the reference is shifted by the lag that makes the root mean square of the row's errors
    least: the run at t + lag then stands against the reference at t.
    """
    computed = Series(history[TIME_COLUMN], column_of(history, reference.column, reference.unroll))
    expected = _expected(reference, scene)
    lag, note = _fitted_lag(computed, expected, reference) if reference.lag == "fit" else (None, None)
    pairs = _lagged(computed, expected, reference, lag or 0.0)
    value, target, error = representative(pairs.values, pairs.references, pairs.errors, reference.norm)
    columns = (pairs.times, pairs.values, pairs.references, np.abs(pairs.errors))
    return Comparison(
        quantity=name,
        compared=reference.column,
        norm=reference.norm,
        value=value,
        reference=target,
        error=error,
        bound=bound_at(reference.bound, scene.spacing),
        uncertainty=reference.uncertainty,
        source=reference.source,
        lag=lag,
        samples=tuple(Sample(*row) for row in np.column_stack(columns).tolist()),
        note=_why_missing(pairs, computed) or note,
    )


def read_table(reference: SeriesReference, scene: Scene) -> Series:
    """The whole reference series, in seconds and in the unit of the compared column. Raises TableError."""
    table = reference.table
    if isinstance(table, InlineTable):
        return Series(np.array(table.time), np.array(table.value))
    time, value = read_columns(scene.base_directory / table.file, (table.time, table.value))
    return Series(time * table.time_scale, value * table.value_scale)


def _expected(reference: SeriesReference, scene: Scene) -> Series:
    """The reference at the times of comparison: those asked for, or those of the table within the run."""
    table = read_table(reference, scene)
    if reference.at is not None:
        times = np.array(reference.at)
        return Series(times, table.at(times))
    within = (table.time >= 0.0) & (table.time <= scene.time.end * (1.0 + _TIME_TOLERANCE))
    return Series(table.time[within], table.value[within])


def _lagged(computed: Series, expected: Series, reference: SeriesReference, lag: float) -> Lagged:
    """Before its first sample the run is taken to have been at rest in its first value."""
    values = computed.at(np.maximum(expected.time + lag, computed.time[0]))
    errors = relative_errors(values, expected.value, reference.relative_to)
    return Lagged(expected.time, values, expected.value, errors)


def _fitted_lag(
    computed: Series, expected: Series, reference: SeriesReference
) -> tuple[float | None, str | None]:
    """The lag [s] of least mismatch, and what is doubtful about it; among equals the smallest."""
    if len(expected.time) < _FEWEST_TIMES_FOR_LAG:
        return None, f"no lag fitted: that takes {_FEWEST_TIMES_FOR_LAG} times of comparison"

    def mismatch(lag: float) -> float:
        return float(np.sqrt(np.mean(_lagged(computed, expected, reference, lag).errors ** 2)))

    largest = LARGEST_LAG * float(expected.time[-1])
    latest = min(largest, float(computed.time[-1] - expected.time[-1]))
    trials = np.linspace(-largest, max(latest, -largest), _TRIAL_LAGS)
    mismatches = np.array([mismatch(lag) for lag in trials])
    if not np.isfinite(mismatches).any():
        return None, "no lag fitted: the run or the table lacks values"
    best = int(np.lexsort((np.abs(trials), mismatches))[0])
    if best in (0, _TRIAL_LAGS - 1):
        return float(trials[best]), "the best lag is at the edge of what the run allows to try"
    bracket = (trials[best - 1], trials[best + 1])
    return float(minimize_scalar(mismatch, bounds=bracket, method="bounded").x), None


def _why_missing(pairs: Lagged, computed: Series) -> str | None:
    if pairs.times.size == 0:
        return "the table has no time within the run"
    missing = pairs.times[~np.isfinite(pairs.errors)]
    if missing.size == 0:
        return None
    return f"no value at t = {missing[0]:.6g} s; the run reached {computed.time[-1]:.6g} s"
