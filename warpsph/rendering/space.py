"""Three-dimensional frames: water as a lit surface, obstacles before and behind it, tanks open to the eye.

A tank would hide what it holds, so only the inside of its far walls is drawn.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from warpsph.rendering.cache import RenderedFrame, RenderedSet
from warpsph.rendering.camera import frame_box
from warpsph.rendering.canvas import Canvas, Material, Spheres
from warpsph.rendering.colour import ColourScale
from warpsph.rendering.figure import BAR_STRIP, add_colour_bar, add_time, page, pixels
from warpsph.rendering.pathlines import Pathline, draw_pathlines
from warpsph.rendering.surroundings import encloses, inner_layer, neighbour_counts

TANK = Material(np.array([[0.87, 0.88, 0.90]]))
SOLID = Material(np.array([[0.62, 0.63, 0.66]]))
FLUID_WITHOUT_VALUE = Material(np.array([[0.12, 0.47, 0.74]]), gloss=1.0)

_BULK_RADIUS = 0.9
_DROP_RADIUS = 0.5
"""Radii in particle diameters: inside, spheres must overlap also where the fluid is stretched; a lone drop is small."""

_NEIGHBOURS_OF_BULK = 10
"""Neighbours from which a particle counts as part of a surface rather than as spray."""


class SpaceView:
    """Draws the frames of one run from one place; walls that stand still are painted only once."""

    def __init__(
        self,
        scale: ColourScale,
        extent: tuple[np.ndarray, np.ndarray],
        size: tuple[int, int],
        up_axis: int,
        pathlines: Sequence[Pathline] = (),
    ) -> None:
        """Frame the extent [m] in pictures of that size in pixels, with paths over it, also where they are behind."""
        self._pathlines = pathlines
        self._scale = scale
        self._size = size
        self._picture_width = round(size[0] * (1.0 - BAR_STRIP))
        self._camera = frame_box(*extent, (self._picture_width, size[1]), up_axis=up_axis)
        self._walls: tuple[RenderedSet, ...] = ()
        self._backdrop = Canvas(self._camera)

    def draw(self, frame: RenderedFrame) -> np.ndarray:
        """The frame as (height, width, 3) bytes."""
        canvas = self._with_walls(frame)
        for body in frame.of_kind("fluid", "structure"):
            if body.value is None:
                canvas.paint_front(_body_spheres(body), np.zeros(len(body.position)), FLUID_WITHOUT_VALUE)
            else:
                canvas.paint_front(_body_spheres(body), body.value, _water(self._scale))
        figure = page(self._size)
        axes = figure.add_axes((0.0, 0.0, self._picture_width / self._size[0], 1.0))
        axes.imshow(canvas.image(), aspect="auto", interpolation="none")
        axes.set_axis_off()
        axes.autoscale(False)
        draw_pathlines(axes, self._pathlines, frame.time, self._camera.project)
        add_colour_bar(figure, self._scale, 1.0 - BAR_STRIP + 0.015, 0.25, 0.5)
        add_time(figure, frame.time, 0.022, 0.965)
        return pixels(figure)

    def _with_walls(self, frame: RenderedFrame) -> Canvas:
        walls = frame.of_kind("boundary")
        if not _stand_where_they_stood(walls, self._walls):
            self._walls = walls
            self._backdrop = Canvas(self._camera)
            for wall in walls:
                _paint_wall(self._backdrop, wall, frame.of_kind("fluid"))
        return self._backdrop.copy()


def _stand_where_they_stood(walls: Sequence[RenderedSet], before: Sequence[RenderedSet]) -> bool:
    return len(walls) == len(before) and all(
        np.array_equal(now.position, then.position) for now, then in zip(walls, before, strict=True)
    )


def _paint_wall(canvas: Canvas, wall: RenderedSet, fluids: Sequence[RenderedSet]) -> None:
    if encloses(wall, fluids):
        canvas.paint_back(_wall_spheres(inner_layer(wall), wall.diameter), TANK)
    else:
        nothing = np.zeros(len(wall.position))
        canvas.paint_front(_wall_spheres(wall.position, wall.diameter), nothing, SOLID)


def _wall_spheres(position: np.ndarray, diameter: float) -> Spheres:
    return Spheres(position, np.full(len(position), _BULK_RADIUS * diameter), diameter)


def _body_spheres(body: RenderedSet) -> Spheres:
    bulk = np.minimum(1.0, neighbour_counts(body) / _NEIGHBOURS_OF_BULK)
    radii = (_DROP_RADIUS + (_BULK_RADIUS - _DROP_RADIUS) * bulk) * body.diameter
    return Spheres(body.position, radii, body.diameter)


def _water(scale: ColourScale) -> Material:
    shades = np.linspace(scale.low, scale.high, 256)
    return Material(scale.rgb(shades), scale.low, scale.high, gloss=1.0)
