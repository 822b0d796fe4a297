"""Fluid where there must be none: behind the surfaces of walls and structures."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from warpsph.frame import Frame, SetFrame
from warpsph.sampling.regions import body_region
from warpsph.sampling.walls import period_of
from warpsph.scene.schema import Scene
from warpsph.solver.behind_walls import BehindWalls

Depth = Callable[[np.ndarray], np.ndarray]
"""How deep (n,) [m] points (n, dimension) [m] of the body at rest lie in it."""

NEAREST = 9
"""Particles of a structure whose affine map takes a place among them back to the body at rest."""


@dataclass(frozen=True)
class Leak:
    """Particles of a fluid (rows of its set) in a wall or structure."""

    fluid: SetFrame
    rows: np.ndarray
    solid: str


class LeakFinder:
    """Finds particles of fluid a spacing behind the surface of a wall, or half a spacing inside of a structure.

    A plate is two particles thick at least, so that it has places of that depth.
    A place in a deformed structure is taken back to the body at rest by the affine map that fits its nearest particles
    best.
    """

    def __init__(self, scene: Scene) -> None:
        self._half = 0.5 * scene.spacing
        self._period = period_of(scene)
        self._walls = BehindWalls(scene)
        self._bodies: dict[str, Depth] = {
            name: _negated(body_region(one.shape, self._period)) for name, one in scene.structures.items()
        }

    @property
    def fields(self) -> tuple[str, ...]:
        """Fields beside positions that frames have to carry."""
        return ("displacement",) if self._bodies else ()

    def leaks(self, frame: Frame) -> Iterator[Leak]:
        """All leaks of one time, one a fluid and solid."""
        for fluid in frame.of_kind("fluid"):
            points = self._within_period(fluid.fields["position"])
            found = self._walls.rows(points, frame.time)
            found |= {name: self.inside(frame.set_named(name), points) for name in self._bodies}
            yield from (Leak(fluid, rows, name) for name, rows in found.items() if len(rows))

    def _within_period(self, points: np.ndarray) -> np.ndarray:
        wrapped = np.array(points)
        for axis, (low, high) in self._period.items():
            wrapped[:, axis] = low + (wrapped[:, axis] - low) % (high - low)
        return wrapped

    def inside(self, body: SetFrame, points: np.ndarray) -> np.ndarray:
        """Rows of the points (n, dimension) [m] that are more than half a spacing inside of a structure."""
        now = body.fields["position"]
        # Among particles half a spacing off the surface and a spacing apart, stretched by half at most.
        reach = 1.5 * self._half * np.sqrt(points.shape[1])
        low, high = now.min(axis=0) - reach, now.max(axis=0) + reach
        close = np.flatnonzero(np.all((points > low) & (points < high), axis=1))
        if not len(close):
            return close
        tree = cKDTree(now)
        close = close[np.isfinite(tree.query(points[close], distance_upper_bound=reach)[0])]
        _, nearest = tree.query(points[close], k=range(1, min(NEAREST, len(now)) + 1))
        near, home = now[nearest], (now - body.fields["displacement"])[nearest]
        middle, rest = near.mean(axis=1, keepdims=True), home.mean(axis=1, keepdims=True)
        map_back = np.linalg.pinv(near - middle) @ (home - rest)
        back = rest + (points[close, None, :] - middle) @ map_back
        return close[self._bodies[body.name](back[:, 0]) > self._half]


def _negated(distance: Callable[[np.ndarray], np.ndarray]) -> Depth:
    return lambda points: -distance(points)
