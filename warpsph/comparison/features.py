"""Single figures taken from probe columns: peaks, arrivals, periods, rates."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from warpsph.comparison.limits import unit_of, window_of
from warpsph.comparison.row import Comparison, History, relative_errors
from warpsph.scene.probes import ForceCoefficientsProbe
from warpsph.scene.references import FeatureReference, Figure, bound_at
from warpsph.scene.schema import Scene

PASSAGE_MARGIN = 0.25
"""A passage of the mean counts once the column has been this many standard deviations below it: noise does not."""


def compare_feature(name: str, reference: FeatureReference, scene: Scene, history: History) -> Comparison:
    """The row of a feature reference; without a `value` the figure is reported and judged by nothing."""
    figure, reached = figure_of(reference, scene, history)
    expected = math.nan if reference.value is None else reference.value
    error = relative_errors(np.array([figure]), np.array([expected]), reference.relative_to)[0]
    return Comparison(
        quantity=name,
        compared=f"{reference.feature} of {reference.column}",
        norm="max",
        value=figure,
        reference=expected,
        error=abs(float(error)),
        bound=bound_at(reference.bound, scene.spacing),
        uncertainty=reference.uncertainty,
        source=reference.source,
        note=_why_missing(reference, figure, reached) or _scatter(reference, scene, history),
    )


def figure_of(figure: Figure, scene: Scene, history: History) -> tuple[float, bool]:
    """The figure of a run, not a number where there is none, and whether the run reached the end of its window."""
    time, column, reached = window_of(figure, scene, history)
    value = feature_of(figure, time, column) if reached else math.nan
    return value * _scale(figure, scene), reached


def feature_of(figure: Figure, time: np.ndarray, column: np.ndarray) -> float:
    """The figure from times [s] and values, each of shape (n,); not a number where there is none."""
    if time.size == 0 or not np.isfinite(column).all():
        return math.nan
    if figure.average is not None:
        column = moving_mean(time, column, figure.average)
    if figure.feature in OF_PERIODS:
        return OF_PERIODS[figure.feature](passages(time, column, figure.periods))
    if figure.periods is not None:
        time, column = last_periods(time, column, figure.periods)
    if time.size == 0:
        return math.nan
    if figure.feature in THRESHOLD_FEATURES:
        return THRESHOLD_FEATURES[figure.feature](time, column, float(figure.threshold or 0.0))
    return FEATURES[figure.feature](time, column)


def feature_unit(figure: Figure) -> str:
    """Unit of the figure, from that of the column."""
    unit = unit_of(figure.column)
    units = {"integral": f"{unit} s", "decay_rate": "1/s", "frequency": "1/s", "strouhal": "1"}
    times = dict.fromkeys(("arrival", "first_peak_time", "period", "maximum_time", "minimum_time"), "s")
    return (units | times).get(figure.feature, unit)


def moving_mean(time: np.ndarray, column: np.ndarray, duration: float) -> np.ndarray:
    """Mean of the column, taken as linear between its samples, over a duration [s] about each; shorter at the ends."""
    integral = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(time) * (column[1:] + column[:-1]))])
    begin = np.maximum(time - 0.5 * duration, time[0])
    end = np.minimum(time + 0.5 * duration, time[-1])
    return (np.interp(end, time, integral) - np.interp(begin, time, integral)) / (end - begin)


def arrival(time: np.ndarray, column: np.ndarray, threshold: float) -> float:
    """First time at which the column reaches the threshold, by linear interpolation."""
    reached = np.flatnonzero(column >= threshold)
    if not len(reached):
        return math.nan
    first = reached[0]
    if first == 0:
        return float(time[0])
    return _passage(time, column, first, threshold)


def first_peak(time: np.ndarray, column: np.ndarray, threshold: float) -> tuple[float, float]:
    """Time and value of the largest value from the arrival until the column has fallen below half of it."""
    reached = np.flatnonzero(column >= threshold)
    if not len(reached):
        return math.nan, math.nan
    after = column[reached[0] :]
    fallen = np.flatnonzero(after < 0.5 * np.maximum.accumulate(after))
    end = fallen[0] if len(fallen) else len(after)
    peak = int(np.argmax(after[:end]))
    return float(time[reached[0] + peak]), float(after[peak])


def maximum_time(time: np.ndarray, column: np.ndarray) -> float:
    """Time of the largest value: the vertex of the parabola through it and the samples beside it.

    At an end of the window, or where the three samples are level, the time of the sample itself.
    """
    top = int(np.argmax(column))
    if not 0 < top < len(column) - 1:
        return float(time[top])
    near = slice(top - 1, top + 2)
    curvature, slope, _ = np.polyfit(time[near] - time[top], column[near], 2)
    return float(time[top] - 0.5 * slope / curvature) if curvature < 0.0 else float(time[top])


def period(times: np.ndarray) -> float:
    """Mean time between passages."""
    return float(np.diff(times).mean()) if len(times) > 1 else math.nan


def period_error(times: np.ndarray) -> float:
    """Standard error of the period, from the scatter of the single ones; not a number for less than three."""
    singles = np.diff(times)
    return float(singles.std(ddof=1) / math.sqrt(len(singles))) if len(singles) > 2 else math.nan


def last_periods(time: np.ndarray, column: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The samples of the last whole periods, with those interpolated at both ends; none where there are too few."""
    times = passages(time, column, count)
    if not len(times):
        return time[:0], column[:0]
    begin, end = times[0], times[-1]
    within = time[(time > begin) & (time < end)]
    chosen = np.concatenate([[begin], within, [end]])
    return chosen, np.interp(chosen, time, column)


def passages(time: np.ndarray, column: np.ndarray, periods: int | None = None) -> np.ndarray:
    """Times of the upward passages of the mean value, by linear interpolation: all, or those around the last so many
    periods, none where there are too few."""
    deviation = column - column.mean()
    low = -PASSAGE_MARGIN * deviation.std()
    found, armed = [], False
    for index in range(1, len(time)):
        armed = armed or deviation[index - 1] <= low
        if armed and deviation[index - 1] < 0.0 <= deviation[index]:
            found.append(_passage(time, deviation, index, 0.0))
            armed = False
    if periods is not None:
        found = found[-1 - periods :] if len(found) > periods else []
    return np.array(found)


def decay_rate(time: np.ndarray, column: np.ndarray) -> float:
    """k of exp(-k t), by least squares in the logarithm; not a number unless every value is positive."""
    if len(time) < 2 or (column <= 0.0).any():
        return math.nan
    return -float(np.polyfit(time, np.log(column), 1)[0])


def _passage(time: np.ndarray, column: np.ndarray, index: int, level: float) -> float:
    """Time of a level between a sample and the one before it."""
    below, above = column[index - 1], column[index]
    return float(time[index - 1] + (level - below) / (above - below) * (time[index] - time[index - 1]))


def _scale(figure: Figure, scene: Scene) -> float:
    """What turns a frequency into a Strouhal number [s], and leaves other figures as they are."""
    probe = scene.probes[figure.column.partition(".")[0]]
    if figure.feature == "strouhal" and isinstance(probe, ForceCoefficientsProbe):
        return probe.length / probe.speed
    return 1.0


def _scatter(reference: FeatureReference, scene: Scene, history: History) -> str | None:
    """The standard error of a figure that is a mean over periods, where there are enough of them."""
    if reference.feature not in OF_PERIODS:
        return None
    time, column, _ = window_of(reference, scene, history)
    if reference.average is not None:
        column = moving_mean(time, column, reference.average)
    times = passages(time, column, reference.periods)
    if not math.isfinite(error := period_error(times)):
        return None
    return f"standard error {error / period(times):.2%}, from the scatter of {len(times) - 1} periods"


def _why_missing(reference: FeatureReference, figure: float, reached: bool) -> str | None:
    if not reached:
        return "the run ended before the window did"
    if not math.isfinite(figure):
        return f"the column shows no {reference.feature}"
    return None if reference.value is not None else f"in {feature_unit(reference)}"


FEATURES: Mapping[str, Callable[[np.ndarray, np.ndarray], float]] = {
    "maximum": lambda _, column: float(column.max()),
    "minimum": lambda _, column: float(column.min()),
    "maximum_time": maximum_time,
    "minimum_time": lambda time, column: maximum_time(time, -column),
    "deviation": lambda _, column: float(column.std()),
    "mean": lambda time, column: float(np.trapezoid(column, time) / (time[-1] - time[0])),
    "change": lambda _, column: float(column[-1] - column[0]),
    "integral": lambda time, column: float(np.trapezoid(column, time)),
    "amplitude": lambda _, column: 0.5 * float(column.max() - column.min()),
    "centre": lambda _, column: 0.5 * float(column.max() + column.min()),
    "decay_rate": decay_rate,
}
OF_PERIODS: Mapping[str, Callable[[np.ndarray], float]] = {
    "period": period,
    "frequency": lambda times: 1.0 / period(times),
    "strouhal": lambda times: 1.0 / period(times),
}
"""From the times of passages; a Strouhal number still needs its scale."""
THRESHOLD_FEATURES: Mapping[str, Callable[[np.ndarray, np.ndarray, float], float]] = {
    "arrival": arrival,
    "first_peak": lambda time, column, threshold: first_peak(time, column, threshold)[1],
    "first_peak_time": lambda time, column, threshold: first_peak(time, column, threshold)[0],
}
