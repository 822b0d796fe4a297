"""Particles on a lattice, relaxed to the surface that bounds them.

Where a surface cuts the lattice obliquely, centres come as near to it as they like. Here each particle near the surface
moves against the gradient of the kernel sum (Colagrossi, Bouscasse, Antuono & Marrone 2012), which evens out the
distances, and none stays nearer to the surface than half a spacing (Zhu, Zhang, Yu & Hu 2021, surface bounding). The
cells beyond the surface do the same, so that the sum is complete everywhere, at edges and corners, too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from warpsph.laws.smoothing import SMOOTHING_LAWS
from warpsph.sampling.distance import DistanceFunction, steepest_direction
from warpsph.sampling.lattice import Lattice
from warpsph.sampling.packing import pushed_inside
from warpsph.sampling.sets import Evenness, Placed

# Lengths in units of the spacing.
_DEPTH_OF_FIRST_LAYER = 0.5
_REACH = 4.0
_SMOOTHING_LENGTH = 1.0
_LONGEST_MOVE = 0.1
_CROWDED = 0.4
_DIFFERENCE = 1e-3

_MOVE = 0.2
"""Move over the gradient of the kernel sum, in spacings squared: 0.1 takes twice as long, 0.4 ends as even."""
_SWEEPS = 40
_SWEEPS_AT_ONCE = 5
"""Sweeps with the same neighbours, for which the surface near a particle counts as a plane: distances are dear."""
_SKIN = 0.25
_LAW = SMOOTHING_LAWS["wendland_c2"]
_SUPPORT = _LAW.support * _SMOOTHING_LENGTH


@dataclass
class _Cloud:
    """Particles on both sides of a surface.

    x: places (n, dim) in spacings; side: (n,), 1 inside and -1 outside; height: height above the surface, in
    spacings, at such places.
    """

    x: np.ndarray
    side: np.ndarray
    height: DistanceFunction

    def height_on(self, side: float) -> DistanceFunction:
        """Minus the depth below the surface for those of a side."""
        return lambda at: side * self.height(at)


def relaxed(points: np.ndarray, distance: DistanceFunction, lattice: Lattice) -> Placed:
    """The points (n, dim) [m] of a lattice in a region, those near its surface evened out.

    The region is where the `distance` is negative. Points in wedges too narrow for a layer stay where they are.
    """
    spacing, result = lattice.spacing, points.copy()
    shallow = np.flatnonzero(distance(points) > -(_REACH + _SUPPORT) * spacing)
    if len(shallow) == 0:
        return Placed(points)
    beyond = _cells_beyond(points[shallow], distance, lattice)
    cloud = _Cloud(
        x=np.concatenate([points[shallow], beyond]) / spacing,
        side=np.repeat([1.0, -1.0], [len(shallow), len(beyond)]),
        height=lambda at: distance(at * spacing) / spacing,
    )
    near = np.flatnonzero(np.abs(cloud.height(cloud.x)) < _REACH)
    moving = _pushed_off(cloud, near)
    for _ in range(_SWEEPS // _SWEEPS_AT_ONCE):
        _sweep(cloud, moving)
    result[shallow] = cloud.x[: len(shallow)] * spacing
    return Placed(result, _evenness(cloud, near[near < len(shallow)]))


def _evenness(cloud: _Cloud, near: np.ndarray) -> Evenness:
    x = cloud.x
    total = _kernel_sum(x, cKDTree(x).query_pairs(_SUPPORT, output_type="ndarray"))[near]
    depth = -cloud.height(x[near])
    return Evenness(
        unevenness=float(np.sqrt(np.mean((total / _lattice_sum(x.shape[1]) - 1.0) ** 2))),
        closest=float(cKDTree(x).query(x[near], k=2)[0][:, 1].min()),
        spread=float(np.std(depth[depth < 1.0])),
    )


def _cells_beyond(points: np.ndarray, distance: DistanceFunction, lattice: Lattice) -> np.ndarray:
    """Centres (m, dim) [m] of the cells beyond the surface, as many layers as move or are seen by those that do.

    Points (n, dim) [m] are all that lie as near to the surface on the other side.
    """
    dim = points.shape[1]
    steps = np.moveaxis(np.indices((3,) * dim), 0, -1).reshape(-1, dim) - 1
    front = lattice.cells_of(points[distance(points) > -lattice.spacing])
    inside = lattice.cells_of(points)
    found = np.empty((0, dim), dtype=np.int64)
    for _ in range(int(_REACH + _SUPPORT)):
        around = np.unique((front[:, None] + steps).reshape(-1, dim), axis=0)
        front = _without(around, np.concatenate([inside, found]))
        found = np.concatenate([found, front])
    return lattice.centers(found)


def _without(cells: np.ndarray, others: np.ndarray) -> np.ndarray:
    """The different cells (n, dim) that are none of the others (m, dim)."""
    kinds, kind = np.unique(np.concatenate([others, cells]), axis=0, return_inverse=True)
    taken = np.zeros(len(kinds), dtype=bool)
    taken[kind.ravel()[: len(others)]] = True
    return cells[~taken[kind.ravel()[len(others) :]]]


def _pushed_off(cloud: _Cloud, near: np.ndarray) -> np.ndarray:
    """Moves the particles `near` the surface to the depth of the first layer, in place, and returns which can go on.

    In the tip of a wedge there is one place of that depth for several particles; they stay on the lattice.
    """
    moved, fits = _bounded(cloud, near)
    trial = cloud.x.copy()
    trial[near[fits]] = moved[fits]
    crowded = cKDTree(trial).query_pairs(_CROWDED, output_type="ndarray")
    moving = np.setdiff1d(near[fits], crowded)
    cloud.x[moving] = trial[moving]
    return moving


def _sweep(cloud: _Cloud, moving: np.ndarray) -> None:
    """Some moves of the particles (m,) of a cloud, in place."""
    x, start = cloud.x, cloud.x[moving]
    height = cloud.height(start)
    first = np.flatnonzero(np.abs(height) < _DEPTH_OF_FIRST_LAYER + _SWEEPS_AT_ONCE * _LONGEST_MOVE)
    place, level, side = start[first], height[first], cloud.side[moving[first]]
    normal = steepest_direction(cloud.height, place, _DIFFERENCE)
    pairs = cKDTree(x).query_pairs(_SUPPORT + _SKIN, output_type="ndarray")
    for _ in range(_SWEEPS_AT_ONCE):
        gradient = _kernel_gradient(x, pairs)[moving]
        length = np.linalg.norm(gradient, axis=1, keepdims=True)
        x[moving] -= gradient * np.minimum(_MOVE, _LONGEST_MOVE / np.maximum(length, np.finfo(float).tiny))
        above = level + np.einsum("ni,ni->n", normal, x[moving[first]] - place)
        lacking = np.maximum(_DEPTH_OF_FIRST_LAYER + side * above, 0.0)
        x[moving[first]] -= (side * lacking)[:, None] * normal
    moved, fits = _bounded(cloud, moving)
    x[moving] = np.where(fits[:, None], moved, start)


def _bounded(cloud: _Cloud, chosen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places (m, dim) of chosen particles, on their side at the depth of the first layer or more; whether they fit."""
    moved, fits = cloud.x[chosen], np.zeros(len(chosen), dtype=bool)
    for side in (1.0, -1.0):
        own = cloud.side[chosen] == side
        moved[own], fits[own] = pushed_inside(moved[own], cloud.height_on(side), _DEPTH_OF_FIRST_LAYER, 1.0)
    return moved, fits


def _kernel_sum(x: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """Sum of V W (n,) over the pairs (m, 2) of particles x (n, dim), themselves included."""
    dim, (i, j) = x.shape[1], pairs.T
    value = _value(np.linalg.norm(x[i] - x[j], axis=1), dim)
    one_by_one = np.bincount(i, value, minlength=len(x)) + np.bincount(j, value, minlength=len(x))
    return np.asarray(one_by_one + _value(np.zeros(1), dim))


def _kernel_gradient(x: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """Sum of V grad W (n, dim) over the pairs (m, 2) of particles x (n, dim)."""
    i, j = pairs.T
    way = x[i] - x[j]
    r = np.linalg.norm(way, axis=1)
    pull = way * np.divide(_slope(r, x.shape[1]), r, out=np.zeros_like(r), where=r > 0.0)[:, None]
    columns = [
        np.bincount(i, along, minlength=len(x)) - np.bincount(j, along, minlength=len(x)) for along in pull.T
    ]
    return np.stack(columns, axis=1)


def _value(r: np.ndarray, dim: int) -> np.ndarray:
    return _LAW.value(r / _SMOOTHING_LENGTH, dim) / _SMOOTHING_LENGTH**dim


def _slope(r: np.ndarray, dim: int) -> np.ndarray:
    """dW/dr by a central difference: the law of a kernel on the host is its value alone."""
    step = 1e-5
    return (_value(r + step, dim) - _value(np.abs(r - step), dim)) / (2.0 * step)


def _lattice_sum(dim: int) -> float:
    ticks = np.arange(-int(_SUPPORT), int(_SUPPORT) + 1)
    cells = np.stack(np.meshgrid(*[ticks] * dim), axis=-1).reshape(-1, dim)
    return float(_value(np.linalg.norm(cells, axis=1), dim).sum())
