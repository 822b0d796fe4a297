"""Voids between particles: the empty balls of their Delaunay triangulation."""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial import Delaunay

from warpsph.frame import Frame
from warpsph.probes.probe import Probe
from warpsph.scene.probes import VoidsProbe as VoidsSpec
from warpsph.scene.schema import Scene
from warpsph.scene.types import AXES

MARGIN = 0.25
"""Part of a period that is repeated beyond its ends; no void should be larger."""
FLAT = 1e-6
"""Volume over that of a cube of one spacing below which a simplex has no circumball of its own."""


class VoidsProbe(Probe):
    """Radius of the largest empty ball over the spacing, and volume of the voids.

    The balls are those through the corners of the simplices of a Delaunay triangulation of all particles, which are
    empty and the largest around their centres. Simplices between solids alone do not count. A void is made of
    simplices with a ball larger than `size` spacings: what an alpha shape leaves open (Edelsbrunner & Mücke 1994).
    """

    def __init__(self, name: str, spec: VoidsSpec, scene: Scene) -> None:
        needs = dict.fromkeys(("fluid", "boundary", "structure"), ("position",))
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._size, self._region, self._spacing = spec.size, spec.region, scene.spacing
        self._periods = {AXES.index(axis): ends for axis, ends in scene.domain.periodic.items()}

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Radius over the spacing [1], NaN without any ball, and volume [m3], in the plane [m2]."""
        position = np.concatenate([s.fields["position"] for s in frame.sets])
        is_fluid = np.repeat([s.kind == "fluid" for s in frame.sets], [s.count for s in frame.sets])
        low, high = self._bounds(position)
        position, is_fluid = self._repeated(position, is_fluid)
        # In spacings and around the middle, so that nothing is lost in squares of coordinates.
        points = (position - 0.5 * (low + high)) / self._spacing
        simplices = Delaunay(points).simplices
        simplices = simplices[is_fluid[simplices].any(axis=1)]
        center, radius, volume = circumballs(points[simplices])
        half = 0.5 * (high - low) / self._spacing
        counts = np.all(np.abs(center) <= half, axis=1)
        if not counts.any():
            return math.nan, 0.0
        is_void = counts & (radius > self._size)
        return float(radius[counts].max()), float(volume[is_void].sum()) * self._spacing**frame.dimension

    def _bounds(self, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Lowest and highest coordinates of centres that count, (dimension,)."""
        low, high = position.min(axis=0), position.max(axis=0)
        for axis, ends in self._periods.items():
            low[axis], high[axis] = ends
        if self._region is not None:
            low, high = np.maximum(low, self._region.min), np.minimum(high, self._region.max)
        return low, high

    def _repeated(self, position: np.ndarray, is_fluid: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Particles brought into their periods, and those near the ends once more beyond the others."""
        for axis, (low, high) in self._periods.items():
            period = high - low
            position = position.copy()
            position[:, axis] = low + np.mod(position[:, axis] - low, period)
            shift = np.zeros(position.shape[1])
            shift[axis] = period
            first = position[:, axis] < low + MARGIN * period
            last = position[:, axis] > high - MARGIN * period
            position = np.concatenate([position, position[first] + shift, position[last] - shift])
            is_fluid = np.concatenate([is_fluid, is_fluid[first], is_fluid[last]])
        return position, is_fluid


def circumballs(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Centres (n, dimension), radii (n,) and volumes (n,) of simplices, without those that are flat.

    Their corners are given in spacings, shape (simplices, dimension + 1, dimension).
    """
    edges = corners[:, 1:] - corners[:, :1]
    determinant = np.abs(np.linalg.det(edges))
    solid = determinant > FLAT
    edges, first = edges[solid], corners[solid, 0]
    # The centre c is as far from every corner: 2 (x_k - x_0) . (c - x_0) = |x_k - x_0|^2.
    to_center = np.linalg.solve(2.0 * edges, np.square(edges).sum(axis=2)[..., None])[..., 0]
    volume = determinant[solid] / math.factorial(corners.shape[2])
    return first + to_center, np.linalg.norm(to_center, axis=1), volume
