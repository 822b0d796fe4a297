"""Two-dimensional frames: discs of particle size between axes in metres."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection

from warpsph.rendering.cache import RenderedFrame, RenderedSet
from warpsph.rendering.colour import ColourScale
from warpsph.rendering.figure import BAR_STRIP, Box, add_colour_bar, add_time, page, pixels, style_axes
from warpsph.rendering.pathlines import Pathline, draw_pathlines
from warpsph.rendering.streamlines import draw_streamlines

WALL_COLOUR = "#a3a8b0"
FLUID_WITHOUT_VALUE = "#1f79bd"

_OVERLAP = 1.5
"""Discs a little larger than the spacing leave no holes inside the fluid."""

_ROOM: Box = (0.07, 0.10, 1.0 - 0.07 - BAR_STRIP, 0.81)
"""What axis labels, time stamp and colour bar leave of the page."""


class PlaneView:
    """Draws the frames of one run in one window."""

    def __init__(
        self,
        scale: ColourScale,
        extent: tuple[np.ndarray, np.ndarray],
        size: tuple[int, int],
        *,
        streamlines: bool = False,
        pathlines: Sequence[Pathline] = (),
    ) -> None:
        """Show the extent [m] in pictures of that size in pixels, with paths over it; streamlines need frames with
        velocities."""
        self._pathlines = pathlines
        self._scale = scale
        self._streamlines = streamlines
        self._size = size
        self._low, self._high = _with_margin(*extent)

    def draw(self, frame: RenderedFrame) -> np.ndarray:
        """The frame as (height, width, 3) bytes."""
        figure = page(self._size)
        left, bottom, width, height = _box_of_same_shape(self._high - self._low, self._size)
        axes = figure.add_axes((left, bottom, width, height))
        axes.set_xlim(self._low[0], self._high[0])
        axes.set_ylim(self._low[1], self._high[1])
        style_axes(axes, "x [m]", "y [m]")
        for walls in frame.of_kind("boundary"):
            _discs(axes, walls, WALL_COLOUR)
        for body in frame.of_kind("fluid", "structure"):
            colours = FLUID_WITHOUT_VALUE if body.value is None else self._scale.rgb(body.value)
            _discs(axes, body, colours)
        if self._streamlines:
            draw_streamlines(axes, frame.of_kind("fluid"))
        draw_pathlines(axes, self._pathlines, frame.time)
        add_colour_bar(figure, self._scale, left + width + 0.015, bottom, height)
        add_time(figure, frame.time, left, bottom + height + 0.055)
        return pixels(figure)


def _with_margin(low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    margin = 0.02 * float(np.max(high - low))
    return low[:2] - margin, high[:2] + margin


def _box_of_same_shape(lengths: np.ndarray, size: tuple[int, int]) -> Box:
    """The largest box in the middle of the room in which both axes have the same scale."""
    left, bottom, width, height = _ROOM
    pixels_per_metre = min(width * size[0] / lengths[0], height * size[1] / lengths[1])
    fitted_width, fitted_height = pixels_per_metre * lengths / np.array(size)
    return (
        left + (width - fitted_width) / 2,
        bottom + (height - fitted_height) / 2,
        fitted_width,
        fitted_height,
    )


def _discs(axes: Axes, particles: RenderedSet, colours: str | np.ndarray) -> None:
    diameters = np.full(len(particles.position), _OVERLAP * particles.diameter)
    discs = EllipseCollection(
        diameters,
        diameters,
        np.zeros_like(diameters),
        units="xy",
        offsets=particles.position[:, :2],
        offset_transform=axes.transData,
        facecolors=colours,
        linewidths=0.0,
    )
    axes.add_collection(discs)
