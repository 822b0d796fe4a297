"""Curves of runs over their references, as numbers: series over time, profiles along a line, figures of a column."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from warpsph.comparison.features import feature_unit
from warpsph.comparison.fields import field_unit
from warpsph.comparison.limits import unit_of
from warpsph.comparison.row import History, column_of
from warpsph.comparison.series import Series, read_table
from warpsph.output.probes_csv import TIME_COLUMN, read_probes
from warpsph.output.run_directory import RunDirectory
from warpsph.report.words import percent, quantity_in_words
from warpsph.scene.references import FeatureReference, ProfileReference, RelativeTo, SeriesReference
from warpsph.validation.options import as_mapping, options_in_words
from warpsph.validation.runner import CaseResult

TIMES = ("arrival", "first_peak_time", "maximum_time", "minimum_time")
LEVELS = ("maximum", "minimum", "mean", "first_peak")


@dataclass(frozen=True)
class Curve:
    """Values over times [s] or coordinates [m], of shape (n,), and the half width of their band of uncertainty."""

    label: str
    x: np.ndarray
    y: np.ndarray
    half_width: np.ndarray | None = None


@dataclass(frozen=True)
class Mark:
    """A time [s] or a level that the curve of a column should reach, and the uncertainty of either."""

    label: str
    at: float
    half_width: float
    is_time: bool


@dataclass(frozen=True)
class Chart:
    """What is drawn on one pair of axes; `name` tells it from the other charts of its scene."""

    name: str
    title: str
    x_label: str
    y_label: str
    runs: tuple[Curve, ...]
    reference: Curve | None = None
    marks: tuple[Mark, ...] = ()


def charts_of(results: Sequence[CaseResult], directory: Path) -> tuple[Chart, ...]:
    """The charts of one scene from the runs below `directory`; a run that failed has no curve.

    Runs that compare options show their finest resolutions only.
    """
    shown = _shown([result for result in results if result.failure is None])
    if not shown:
        return ()
    histories = [_history(directory / result.case.directory) for result in shown]
    return (*_table_charts(shown, histories), *_feature_charts(shown, histories))


def half_width(values: np.ndarray, relative_to: RelativeTo, uncertainty: float) -> np.ndarray:
    """Uncertainty in the unit of the values, shape (n,), from that relative to what errors are divided by."""
    match relative_to:
        case "value":
            return uncertainty * np.abs(values)
        case "peak":
            return np.full(len(values), uncertainty * np.max(np.abs(values), initial=0.0))
        case _:
            return np.full(len(values), uncertainty * relative_to)


def _shown(results: Sequence[CaseResult]) -> list[CaseResult]:
    if not any(result.case.options for result in results):
        return list(results)
    finest = {result.case.options: result for result in results}
    return list(finest.values())


def _history(run: Path) -> History:
    return {name: np.asarray(values) for name, values in read_probes(RunDirectory(run).probes).items()}


def _label(result: CaseResult) -> str:
    spacing = f"{result.case.scene.spacing:.4g} m"
    return ", ".join(filter(None, (options_in_words(as_mapping(result.case.options)), spacing)))


def _table_charts(results: Sequence[CaseResult], histories: Sequence[History]) -> Iterator[Chart]:
    for name, reference in results[-1].case.scene.references.items():
        match reference:
            case SeriesReference():
                yield _series_chart(name, reference, results, histories)
            case ProfileReference():
                yield from _profile_chart(name, reference, results)


def _series_chart(
    name: str, reference: SeriesReference, results: Sequence[CaseResult], histories: Sequence[History]
) -> Chart:
    runs = tuple(_series_run(name, reference, *pair) for pair in zip(results, histories, strict=True))
    scene = results[-1].case.scene
    table = read_table(reference, scene)
    during = (table.time >= 0.0) & (table.time <= scene.time.end * (1.0 + 1e-9))
    expected = Series(table.time[during], table.value[during])
    return Chart(
        name=name,
        title=quantity_in_words(name),
        x_label="time [s]",
        y_label=_axis_label(reference.column),
        runs=runs,
        reference=_reference(expected.time, expected.value, reference),
    )


def _series_run(name: str, reference: SeriesReference, result: CaseResult, history: History) -> Curve:
    """The run with its fitted lag taken off, as it is compared."""
    lag = _row(result, name).get("lag") or 0.0
    label = _label(result) + (f", without its lag of {lag:.3g} s" if lag else "")
    return Curve(label, history[TIME_COLUMN] - lag, column_of(history, reference.column, reference.unroll))


def _profile_chart(name: str, reference: ProfileReference, results: Sequence[CaseResult]) -> Iterator[Chart]:
    """The profile at the last time of comparison; none where the runs ended before it."""
    samples = [_row(result, name)["samples"][-1] for result in results]
    if not all("points" in sample for sample in samples):
        return
    points = [_columns(sample["points"]) for sample in samples]
    runs = tuple(Curve(_label(result), x, y) for result, (x, y, _) in zip(results, points, strict=True))
    x, _, expected = points[-1]
    yield Chart(
        name=name,
        title=f"{quantity_in_words(name)} at t = {samples[-1]['time']:.4g} s",
        x_label=f"{reference.axis} [m]",
        y_label=f"{quantity_in_words(reference.field)} [{field_unit(reference.field)}]",
        runs=runs,
        reference=_reference(x, expected, reference),
    )


def _reference(x: np.ndarray, y: np.ndarray, reference: SeriesReference | ProfileReference) -> Curve:
    if not reference.uncertainty:
        return Curve("reference", x, y)
    label = f"reference ± {percent(reference.uncertainty)}"
    return Curve(label, x, y, half_width(y, reference.relative_to, reference.uncertainty))


def _feature_charts(results: Sequence[CaseResult], histories: Sequence[History]) -> Iterator[Chart]:
    """One chart a column, with all the times and levels that it should reach."""
    columns: dict[str, list[tuple[str, FeatureReference]]] = {}
    for name, reference in results[-1].case.scene.references.items():
        if isinstance(reference, FeatureReference) and reference.value is not None:
            columns.setdefault(reference.column, []).append((name, reference))
    for column, features in columns.items():
        marks = tuple(mark for feature in features for mark in _marks(*feature))
        if marks:
            yield _feature_chart(column, features, marks, results, histories)


def _feature_chart(
    column: str,
    features: Sequence[tuple[str, FeatureReference]],
    marks: tuple[Mark, ...],
    results: Sequence[CaseResult],
    histories: Sequence[History],
) -> Chart:
    name, first = features[0]
    runs = tuple(
        Curve(_label(result), history[TIME_COLUMN], column_of(history, column, first.unroll))
        for result, history in zip(results, histories, strict=True)
    )
    label = _axis_label(column)
    return Chart(name, label.partition(" [")[0], "time [s]", label, runs, marks=marks)


def _marks(name: str, reference: FeatureReference) -> Iterator[Mark]:
    """A time or a level; other figures, such as periods, have no place on a chart of the column."""
    if reference.value is None or reference.feature not in (*TIMES, *LEVELS):
        return
    scale = abs(reference.value) if reference.relative_to == "value" else reference.relative_to
    given = f"reference {quantity_in_words(name)}: {reference.value:.4g} {feature_unit(reference)}"
    label = given + (f" ± {percent(reference.uncertainty)}" if reference.uncertainty else "")
    yield Mark(label, reference.value, reference.uncertainty * scale, reference.feature in TIMES)


def _row(result: CaseResult, name: str) -> Mapping[str, Any]:
    return next(row for row in result.rows if row["quantity"] == name)


def _columns(points: Sequence[Sequence[float | None]]) -> np.ndarray:
    """Columns of a table in which None is no number."""
    return np.array(points, dtype=np.float64).T


def _axis_label(column: str) -> str:
    """`tip: displacement y [m]` of `tip.displacement_y[m]`."""
    probe, _, quantity = column.partition("[")[0].partition(".")
    return f"{quantity_in_words(probe)}: {quantity_in_words(quantity)} [{unit_of(column)}]"
