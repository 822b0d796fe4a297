"""Geometry of open boundaries: frames, buffers, and the stations at which their values are found."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product

import numpy as np

from warpsph.sampling.lattice import TIE
from warpsph.sampling.regions import Period
from warpsph.scene.open_boundaries import OpenBoundary
from warpsph.scene.schema import Scene
from warpsph.scene.types import AXES

FLUX_DEPTH = 2.0
"""Depth on either side of a patch, in spacings, within which particles count for its flux."""
EDGE_MARGIN = 0.5
"""Distance beside a patch, in spacings, within which fluid behind it belongs to its buffer, and counts for its flux."""
_SUBDIVISION = 16
"""Points along an edge of a station's cell from which its part inside of a disc is counted."""


@dataclass(frozen=True)
class Patch:
    """A patch and its buffer.

    axes: (dimension, dimension), columns: the normal into the domain, then the directions across it; half: half lengths
    across [m], of a disc its radius twice; length: of the buffer [m]; counts: stations along each direction across; up:
    direction against gravity, and level: height of the water level over the center [m], where one is given.
    """

    name: str
    center: np.ndarray
    axes: np.ndarray
    half: np.ndarray
    is_disc: bool
    length: float
    counts: tuple[int, ...]
    up: np.ndarray
    level: float

    @property
    def has_level(self) -> bool:
        """Whether its section is filled to a water level only."""
        return math.isfinite(self.level)

    def below_level(self, points: np.ndarray) -> np.ndarray:
        """Depths (n,) [m] of points (n, dimension) below the water level; infinite where none is given."""
        return self.level - (points - self.center) @ self.up

    def coordinates(self, points: np.ndarray, period: Period | None = None) -> np.ndarray:
        """Coordinates (n, dimension) [m] of points (n, dimension): depth inside of the patch, then those across it."""
        away = points - self.center
        for axis, (low, high) in (period or {}).items():
            away[:, axis] -= (high - low) * np.round(away[:, axis] / (high - low))
        return away @ self.axes

    def covers(self, across: np.ndarray, margin: float) -> np.ndarray:
        """Which coordinates (n, dimension - 1) across lie on the patch or within `margin` [m] of it."""
        if self.is_disc:
            return np.linalg.norm(across, axis=1) <= self.half[0] + margin
        return np.all(np.abs(across) <= self.half + margin, axis=1)

    def behind(self, points: np.ndarray, margin: float, period: Period | None = None) -> np.ndarray:
        """Which points (n, dimension) lie in the buffer or within `margin` [m] beside it."""
        at = self.coordinates(points, period)
        return (at[:, 0] < 0.0) & (at[:, 0] >= -self.length) & self.covers(at[:, 1:], margin)

    def share_inside(
        self,
        points: np.ndarray,
        in_buffer: np.ndarray,
        depth: float,
        margin: float,
        period: Period | None = None,
    ) -> np.ndarray:
        """Part (n,) of points (n, dimension) that lies inside, from nought `depth` [m] behind the patch to one as far
        before it; one of what is not `in_buffer` (n,) and lies behind the buffer or more than `margin` [m] beside it.

        The integral of a hat of that half width: its sum over particles changes by the flux that is weighted with the
        hat (kernels/warpsph_kernels/patch_flux.py), not by a whole layer at a time.
        """
        at = self.coordinates(points, period)
        s = np.clip(at[:, 0] / depth, -1.0, 1.0)
        near = (at[:, 0] >= -self.length) & self.covers(at[:, 1:], margin)
        return np.where(near | in_buffer, 0.5 * (1.0 + s * (2.0 - np.abs(s))), 1.0)

    @property
    def area(self) -> float:
        """Area [m2], in 2D length [m]; that below its water level."""
        return float(self.weights.sum())

    @property
    def cell(self) -> np.ndarray:
        """Edges of a station's cell [m]."""
        return 2.0 * self.half / np.array(self.counts)

    @property
    def stations(self) -> np.ndarray:
        """Coordinates (s, dimension - 1) [m] across the patch of the middles of all cells, the last axis fastest."""
        return self._grid(1)

    @property
    def weights(self) -> np.ndarray:
        """Area (s,) of each station's cell that lies on the patch, and below its water level [m2; m in 2D]."""
        if not self.is_disc:
            return self._wet_shares() * float(np.prod(self.cell))
        inside = self.covers(self._grid(_SUBDIVISION), 0.0).astype(float)
        fine = [n for count in self.counts for n in (count, _SUBDIVISION)]
        share = inside.reshape(fine).mean(axis=(1, 3)).ravel()
        return self._wet_shares() * share * math.pi * float(self.half[0]) ** 2 / share.sum()

    @property
    def lower(self) -> np.ndarray:
        """Of each station (s,) the next one below it, of the lowest -1; without a water level -1 of all."""
        index = np.arange(math.prod(self.counts)).reshape(self.counts)
        below = np.full_like(index, -1)
        if self.has_level:
            rise = self.axes[:, 1:].T @ self.up
            k = int(np.argmax(np.abs(rise)))
            index, filled = np.moveaxis(index, k, 0), np.moveaxis(below, k, 0)
            if rise[k] > 0.0:
                filled[1:] = index[:-1]
            else:
                filled[:-1] = index[1:]
        return below.ravel()

    @property
    def stand_ins(self) -> np.ndarray:
        """Of each station (s,) the station whose middle lies on the patch and that stands for it."""
        places = self.stations
        on_patch = np.flatnonzero(self.covers(places, 0.0))
        distance = np.linalg.norm(places[:, None] - places[on_patch][None], axis=2)
        return on_patch[np.argmin(distance, axis=1)]

    def points(self, across: np.ndarray, depth: float = 0.0) -> np.ndarray:
        """Places (n, dimension) [m] of coordinates across the patch, at a depth [m] inside."""
        return self.center + depth * self.axes[:, 0] + across @ self.axes[:, 1:].T

    def middles(self, k: int, parts: int = 1) -> np.ndarray:
        """Coordinates [m] along the k-th direction across of the middles of cells, each cut into `parts`."""
        n = parts * self.counts[k]
        return self.half[k] * ((2.0 * np.arange(n) + 1.0) / n - 1.0)

    def _wet_shares(self) -> np.ndarray:
        """Part (s,) of the height of each station's cell that lies below the water level."""
        if not self.has_level:
            return np.ones(math.prod(self.counts))
        height = float(np.abs(self.axes[:, 1:].T @ self.up) @ self.cell)
        depth = self.below_level(self.points(self.stations))
        return np.clip(0.5 + depth / height, 0.0, 1.0)

    def _grid(self, parts: int) -> np.ndarray:
        return np.array(list(product(*(self.middles(k, parts) for k in range(len(self.counts))))))


def patches_of(scene: Scene) -> list[Patch]:
    """The patches of a scene in its order."""
    return [
        _patch(name, boundary, scene.gravity, scene.spacing, buffer_length(scene))
        for name, boundary in scene.open_boundaries.items()
    ]


def buffer_length(scene: Scene) -> float:
    """Length of a buffer [m]: a whole number of spacings, one more than the neighbour lists reach."""
    return (math.ceil(scene.search_radius / scene.spacing - TIE) + 1) * scene.spacing


def _patch(
    name: str, boundary: OpenBoundary, gravity: tuple[float, ...], spacing: float, length: float
) -> Patch:
    shape, center = boundary.shape, np.array(boundary.shape.center)
    normal = np.array(shape.normal) / np.linalg.norm(shape.normal)
    if shape.width is not None:
        half = np.array([0.5 * shape.width])
    elif shape.size is not None:
        half = 0.5 * np.array(shape.size)
    else:
        half = np.full(2, float(shape.radius or 0.0))
    counts = tuple(max(round(float(2.0 * h) / spacing), 1) for h in half)
    axes = _frame(normal, shape.along)
    up, level = np.zeros(len(center)), math.inf
    elevation = getattr(boundary, "level", None)
    if elevation is not None:
        up = -np.array(gravity) / np.linalg.norm(gravity)
        level = elevation - float(center @ up)
    return Patch(name, center, axes, half, shape.radius is not None, length, counts, up, level)


def _frame(normal: np.ndarray, along: tuple[float, ...] | None) -> np.ndarray:
    """The normal and the directions across it, as columns."""
    if len(normal) == 2:
        return np.column_stack([normal, [-normal[1], normal[0]]])
    wanted = np.array(along) if along is not None else _first_axis_across(normal)
    first = wanted - (wanted @ normal) * normal
    first = first / np.linalg.norm(first)
    return np.column_stack([normal, first, np.cross(normal, first)])


def _first_axis_across(normal: np.ndarray) -> np.ndarray:
    steep = np.abs(normal) > 0.9
    return np.eye(len(AXES))[int(np.argmin(steep))]
