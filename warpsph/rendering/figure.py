"""The page around a picture: size in pixels, colour bar and time stamp."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from warpsph.rendering.colour import ColourScale

WIDTH_IN_INCHES = 9.6
"""Type keeps its size relative to the picture at any resolution."""

BAR_STRIP = 0.12
"""Part of the page's width that the colour bar takes with its labels."""

INK = "#2b2f36"
_BAR_WIDTH = 0.014
_LABEL_SIZE, _TICK_SIZE, _TIME_SIZE = 11, 10, 13

Box = tuple[float, float, float, float]
"""Left, bottom, width and height as parts of the page."""


def page(size: tuple[int, int]) -> Figure:
    """An empty white figure of width by height pixels that needs no display."""
    width, height = size
    figure = Figure((WIDTH_IN_INCHES, WIDTH_IN_INCHES * height / width), dpi=width / WIDTH_IN_INCHES)
    FigureCanvasAgg(figure)
    return figure


def add_colour_bar(figure: Figure, scale: ColourScale, left: float, bottom: float, height: float) -> None:
    """A colour bar in a box of the page."""
    axes = figure.add_axes((left, bottom, _BAR_WIDTH, height))
    bar = figure.colorbar(scale.mappable(), cax=axes)
    bar.outline.set_visible(False)
    bar.set_label(scale.label, color=INK, fontsize=_LABEL_SIZE, labelpad=8)
    axes.tick_params(colors=INK, labelsize=_TICK_SIZE, length=3, width=0.6)


def add_time(figure: Figure, time: float, left: float, top: float) -> None:
    """The time with its upper left corner there."""
    figure.text(left, top, f"t = {time:.3f} s", color=INK, fontsize=_TIME_SIZE, va="top")


def style_axes(axes: Axes, *labels: str) -> None:
    """Thin, quiet axes with these labels for x and y."""
    axes.set_xlabel(labels[0], color=INK, fontsize=_LABEL_SIZE)
    axes.set_ylabel(labels[1], color=INK, fontsize=_LABEL_SIZE)
    axes.tick_params(colors=INK, labelsize=_TICK_SIZE, length=3, width=0.6)
    for spine in axes.spines.values():
        spine.set(linewidth=0.6, edgecolor="#b9bec6")


def pixels(figure: Figure) -> np.ndarray:
    """The drawn figure as (height, width, 3) bytes."""
    canvas = figure.canvas
    assert isinstance(canvas, FigureCanvasAgg)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].copy()
