"""Pictures of a report: errors against resolution and cost, curves over their references. Needs Matplotlib."""

from __future__ import annotations

import io
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Literal

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from warpsph.rendering.figure import INK, style_axes
from warpsph.report.curves import Chart, Curve, Mark
from warpsph.report.words import order_in_words, quantity_in_words
from warpsph.validation.study import Cost, Point, Study, on_front

COLOURS = (
    "#0072b2",
    "#d55e00",
    "#009e73",
    "#cc79a7",
    "#e69f00",
    "#56b4e9",
    "#7f5539",
    "#6a4c93",
    "#8a8d91",
    "#3a5a40",
)
"""After Okabe & Ito (2008), told apart by most eyes, and four more."""

BAND, GRID = "#b9bec6", "#e6e8eb"
_DPI, _WIDTH = 110, 10.0
_LEGEND_LINE, _LEGEND_CHARACTER, _LEGEND_KEY, _MOST_COLUMNS = 0.22, 0.078, 0.7, 4
"""Height of an entry of a legend, width of a character and of what stands before the text, all in inches."""

_FEW_POINTS = 40
"""A reference with fewer points than this is drawn as points."""


def errors_picture(studies: Sequence[Study], title: str) -> bytes | None:
    """Error against resolution, wall time and particle-steps, one colour a study, as a PNG.

    Studies of the same quantity share their efficient front. None where nothing varies, or where no error is greater
    than zero, which a logarithmic axis needs.
    """
    studies = [study for study in studies if _drawable(study)]
    if sum(len(_drawable(study)) for study in studies) <= len({study.quantity for study in studies}):
        return None
    explanations = _explanations(studies)
    figure = _figure(3.4, [*map(_label, studies), *(str(line.get_label()) for line in explanations)])
    panels = figure.subplots(1, 3, sharey=True)
    for study, colour in zip(studies, _colours(), strict=False):
        _draw_errors(panels, study, colour)
    _mark_fronts(panels, studies)
    _error_axes(panels, [point for study in studies for point in _drawable(study)])
    figure.suptitle(title, color=INK, fontsize=12, x=0.01, ha="left")
    _legend(figure, [*panels[0].get_legend_handles_labels()[0], *explanations])
    return _png(figure)


def chart_picture(chart: Chart) -> bytes:
    """The curves of runs over their reference with its band of uncertainty, as a PNG."""
    figure = _figure(3.2, [part.label for part in (*chart.runs, *chart.marks, chart.reference) if part])
    axes = figure.subplots()
    for run, colour, weight in zip(chart.runs, _colours(), _weights(len(chart.runs)), strict=False):
        axes.plot(run.x, run.y, color=colour, linewidth=weight, label=run.label)
    if chart.reference is not None:
        _draw_reference(axes, chart.reference)
    for number, mark in enumerate(chart.marks):
        _draw_mark(axes, mark, ("--", ":", "-.")[number % 3])
    axes.set_title(chart.title, color=INK, fontsize=12, loc="left", pad=14)
    _style(axes, chart.x_label, chart.y_label)
    _legend(figure, axes.get_legend_handles_labels()[0])
    return _png(figure)


def _drawable(study: Study) -> list[Point]:
    """Points with an error that a logarithmic axis can show."""
    return [point for point in study.points if point.quoted]


def _draw_errors(panels: Sequence[Axes], study: Study, colour: str) -> None:
    points = _drawable(study)
    errors = [_percent(point) for point in points]
    for axes, x in zip(panels, _abscissae(points), strict=True):
        axes.plot(x, errors, color=colour, linewidth=1.5, label=_label(study), zorder=2)
        for here, error, point in zip(x, errors, points, strict=True):
            shape, face = ("v", "white") if point.at_uncertainty else ("o", colour)
            axes.plot(here, error, shape, color=colour, markerfacecolor=face, markersize=6, zorder=3)


def _abscissae(points: Sequence[Point]) -> tuple[list[float], list[float], list[float]]:
    """Particle spacings [m], wall times [s], and particle-steps in millions."""
    return (
        [point.resolution for point in points],
        [point.wall_seconds or math.nan for point in points],
        [(point.particle_steps or math.nan) / 1e6 for point in points],
    )


def _percent(point: Point) -> float:
    return 100.0 * (point.quoted or 0.0)


def _label(study: Study) -> str:
    order = "" if study.order is None else f", order {order_in_words(study.order)}"
    return (study.label or quantity_in_words(study.quantity)) + order


def _mark_fronts(panels: Sequence[Axes], studies: Sequence[Study]) -> None:
    costs: Mapping[Cost, tuple[Axes, float]] = {
        "wall_seconds": (panels[1], 1.0),
        "particle_steps": (panels[2], 1e-6),
    }
    for quantity in dict.fromkeys(study.quantity for study in studies):
        own = [study for study in studies if study.quantity == quantity]
        for cost, (axes, scale) in costs.items():
            _mark_front(axes, own, cost, scale)


def _mark_front(axes: Axes, studies: Sequence[Study], cost: Cost, scale: float) -> None:
    """Rings about the points of the front, and where several studies compete the stairs between them."""
    front = sorted(
        (scale * getattr(point, cost), _percent(point))
        for study, flags in zip(studies, on_front(studies, cost), strict=True)
        for point, flag in zip(study.points, flags, strict=True)
        if flag and point.quoted
    )
    x, y = zip(*front, strict=True) if front else ((), ())
    style = "o--" if len(studies) > 1 else "o"
    (ring,) = axes.plot(
        x, y, style, color=INK, linewidth=0.9, markersize=10, drawstyle="steps-post", zorder=1
    )
    ring.set(markerfacecolor="none", markeredgewidth=0.8)


def _explanations(studies: Sequence[Study]) -> list[Line2D]:
    ring = Line2D([], [], color=INK, marker="o", markersize=9, markerfacecolor="none", linestyle="none")
    ring.set_label("on the efficient front")
    hollow = Line2D([], [], color=INK, marker="v", markersize=6, markerfacecolor="white", linestyle="none")
    hollow.set_label("not above the reference's uncertainty")
    at_uncertainty = any(point.at_uncertainty for study in studies for point in study.points)
    return [ring, hollow] if at_uncertainty else [ring]


def _error_axes(panels: Sequence[Axes], points: Sequence[Point]) -> None:
    labels = ("particle spacing [m]", "wall time [s]", "particle-steps [million]")
    for axes, label, values in zip(panels, labels, _abscissae(points), strict=True):
        _style(axes, label, "error [%]" if axes is panels[0] else "")
        _logarithmic(axes, "x", values)
    _logarithmic(panels[0], "y", [_percent(point) for point in points])
    spacings = sorted({point.resolution for point in points})
    if len(spacings) <= 4:
        panels[0].set_xticks(spacings, [f"{spacing:.4g}" for spacing in spacings])


def _logarithmic(axes: Axes, direction: Literal["x", "y"], values: Sequence[float]) -> None:
    """A logarithmic axis with plain numbers, and no more of them than a short axis can carry."""
    known = [value for value in values if math.isfinite(value)]
    low, high = min(known), max(known)
    margin = max(1.25, (high / low) ** 0.08)
    if direction == "x":
        axes.set_xscale("log")
        axes.set_xlim(low / margin, high * margin)
    else:
        axes.set_yscale("log")
        axes.set_ylim(low / margin, high * margin)
    axis = axes.xaxis if direction == "x" else axes.yaxis
    axis.set_major_locator(LogLocator(subs=_ticks(math.log10(high / low * margin**2)), numticks=30))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_locator(NullLocator())


def _ticks(decades: float) -> tuple[float, ...]:
    """Numbers of a decade that stand at an axis of so many decades."""
    if decades < 0.9:
        return (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0)
    return (1.0, 2.0, 5.0) if decades < 2.2 else (1.0,)


def _draw_reference(axes: Axes, reference: Curve) -> None:
    """Few points as points, many as a dashed line."""
    style = "o" if len(reference.x) < _FEW_POINTS else "--"
    (line,) = axes.plot(
        reference.x, reference.y, style, color=INK, markersize=5, label=reference.label, zorder=5
    )
    line.set_markerfacecolor("white")
    if reference.half_width is not None:
        _draw_band(axes, reference, reference.half_width)


def _draw_band(axes: Axes, reference: Curve, half_width: np.ndarray) -> None:
    """A band, or a bar where there is one point only."""
    if len(reference.x) == 1:
        axes.errorbar(reference.x, reference.y, half_width, color=INK, capsize=4, linestyle="none")
        return
    low, high = reference.y - half_width, reference.y + half_width
    axes.fill_between(reference.x, low, high, color=BAND, alpha=0.5, linewidth=0)


def _draw_mark(axes: Axes, mark: Mark, dashes: str) -> None:
    line, band = (axes.axvline, axes.axvspan) if mark.is_time else (axes.axhline, axes.axhspan)
    line(mark.at, color=INK, linewidth=1.0, linestyle=dashes, label=mark.label)
    if mark.half_width:
        band(mark.at - mark.half_width, mark.at + mark.half_width, color=BAND, alpha=0.5, linewidth=0)


def _figure(height: float, labels: Sequence[str]) -> Figure:
    """A figure without display, of that height in inches and room for a legend of these labels."""
    height += _LEGEND_LINE * math.ceil(len(labels) / _columns(labels))
    figure = Figure((_WIDTH, height), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def _legend(figure: Figure, handles: Sequence[Artist]) -> None:
    """Below the axes, so that these are as wide with long labels as with short ones."""
    figure.legend(
        handles=list(handles),
        loc="outside lower left",
        ncols=_columns([str(handle.get_label()) for handle in handles]),
        frameon=False,
        fontsize=9,
        labelcolor=INK,
    )


def _columns(labels: Sequence[str]) -> int:
    """Columns of a legend that fit beside each other."""
    widest = _LEGEND_KEY + _LEGEND_CHARACTER * max(map(len, labels), default=0)
    return max(1, min(_MOST_COLUMNS, int(_WIDTH / widest)))


def _style(axes: Axes, x_label: str, y_label: str) -> None:
    style_axes(axes, x_label, y_label)
    axes.grid(True, color=GRID, linewidth=0.7)
    axes.set_axisbelow(True)


def _colours() -> Iterator[str]:
    while True:
        yield from COLOURS


def _weights(count: int) -> np.ndarray:
    """Line widths, the last of the runs strongest."""
    return np.linspace(1.0, 1.8, count) if count > 1 else np.array([1.8])


def _png(figure: Figure) -> bytes:
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", facecolor="white")
    return buffer.getvalue()
