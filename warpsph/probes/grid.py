"""Fluid fields at all points of a grid, by consistent interpolation."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from warpsph.frame import Frame, SetFrame
from warpsph.probes.point import LARGEST_CONDITION
from warpsph.probes.smoothing import Smoothing, particle_volume
from warpsph.scene.schema import Scene

CHUNK = 20_000
"""Particles that are spread over the grid at once, which bounds memory."""


@dataclass(frozen=True)
class Grid:
    """Points low + spacing * (i, j, ...), `shape` of them along the axes; lengths in m."""

    low: np.ndarray
    spacing: float
    shape: tuple[int, ...]

    @classmethod
    def between(cls, low: Sequence[float], high: Sequence[float], spacing: float) -> Grid:
        """Points from the corner `low` up to the corner `high`."""
        counts = (np.floor((np.array(high) - low) / spacing * (1.0 + 1e-9)) + 1).astype(int)
        return cls(np.array(low), spacing, tuple(map(int, counts)))

    @property
    def size(self) -> int:
        return int(np.prod(self.shape))

    def axes(self) -> list[np.ndarray]:
        """Coordinates of the points along each axis."""
        return [x + self.spacing * np.arange(n) for x, n in zip(self.low, self.shape, strict=True)]


class GridInterpolation:
    """First-order moving least squares, as a probe at a point has it; points that are not in the fluid get NaN."""

    def __init__(self, grid: Grid, scene: Scene) -> None:
        self._grid, self._smoothing = grid, Smoothing.of(scene)
        reach = int(np.ceil(self._smoothing.support_radius / grid.spacing))
        steps = range(-reach, reach + 2)
        self._stencil = np.array(list(itertools.product(steps, repeat=scene.dimension)))

    def evaluate(self, frame: Frame, fields: Sequence[str]) -> np.ndarray:
        """Values (points, columns) of fields of the fluid, vectors by component."""
        dim, size = self._smoothing.dimension, self._grid.size
        first = frame.of_kind("fluid")[0].fields
        width = sum(_columns(first[field]).shape[1] for field in fields)
        moments = np.zeros((size, dim + 1, dim + 1))
        sums = np.zeros((size, dim + 1, width))
        for position, volume, values in self._particles(frame.of_kind("fluid"), fields):
            self._spread(position, volume, values, moments, sums)
        solid = np.zeros((size, 1, 1))
        for position, volume, _ in self._particles(frame.of_kind("boundary", "structure"), ()):
            self._spread(position, volume, np.zeros((len(position), 0)), solid, np.zeros((size, 1, 0)))
        return self._solve(moments, sums, solid[:, 0, 0])

    def _solve(self, moments: np.ndarray, sums: np.ndarray, solid: np.ndarray) -> np.ndarray:
        filled = moments[:, 0, 0]
        values = np.full((len(moments), sums.shape[2]), np.nan)
        inside = (filled > 0.0) & (filled >= 0.5 * (1.0 - solid))
        values[inside] = sums[inside, 0] / filled[inside, None]
        fitted = inside.copy()
        fitted[inside] = np.linalg.cond(moments[inside]) <= LARGEST_CONDITION
        values[fitted] = np.linalg.solve(moments[fitted], sums[fitted])[:, 0]
        return values

    def _particles(
        self, sets: Sequence[SetFrame], fields: Sequence[str]
    ) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Positions, volumes and values of the particles near the grid, in chunks, with their periodic images."""
        reach = self._smoothing.support_radius
        high = self._grid.low + self._grid.spacing * (np.array(self._grid.shape) - 1)
        shifts = [(0.0,) if p is None else (-p, 0.0, p) for p in self._smoothing.periods]
        for particle_set, shift in itertools.product(sets, itertools.product(*shifts)):
            position = particle_set.fields["position"] + np.array(shift)
            near = np.all((position > self._grid.low - reach) & (position < high + reach), axis=1)
            chosen = np.flatnonzero(near)
            for part in np.array_split(chosen, max(-(-len(chosen) // CHUNK), 1)):
                columns = [_columns(particle_set.fields[field][part]) for field in fields]
                values = np.concatenate([np.zeros((len(part), 0)), *columns], axis=1)
                yield position[part], particle_volume(particle_set, part), values

    def _spread(
        self,
        position: np.ndarray,
        volume: np.ndarray,
        values: np.ndarray,
        moments: np.ndarray,
        sums: np.ndarray,
    ) -> None:
        """Add the weighted products of basis and values of each particle to the points in its reach."""
        grid, smoothing = self._grid, self._smoothing
        base = np.floor((position - grid.low) / grid.spacing).astype(int)
        point = base[:, None, :] + self._stencil
        offset = position[:, None, :] - (grid.low + grid.spacing * point)
        distance = np.linalg.norm(offset, axis=2)
        particle, place = np.nonzero(
            (distance < smoothing.support_radius) & np.all((point >= 0) & (point < grid.shape), axis=2)
        )
        index = np.ravel_multi_index(tuple(point[particle, place].T), grid.shape)
        weight = volume[particle] * smoothing.weight(distance[particle, place])
        scaled = offset[particle, place] / smoothing.smoothing_length
        basis = np.column_stack([np.ones(len(index)), scaled])[:, : moments.shape[1]]

        def add(target: np.ndarray, products: np.ndarray) -> None:
            target += np.bincount(index, weight * products, minlength=grid.size)

        for row in range(basis.shape[1]):
            for column in range(basis.shape[1]):
                add(moments[:, row, column], basis[:, row] * basis[:, column])
            for column in range(values.shape[1]):
                add(sums[:, row, column], basis[:, row] * values[particle, column])


def _columns(values: np.ndarray) -> np.ndarray:
    """A scalar (n,) or vector (n, dimension) field with one column a component."""
    return values[:, None] if values.ndim == 1 else values
