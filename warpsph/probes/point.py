"""Fluid fields at a fixed point."""

import math
from collections.abc import Sequence

import numpy as np

from warpsph.frame import Frame, SetFrame
from warpsph.probes.probe import Probe
from warpsph.probes.smoothing import Smoothing, particle_volume
from warpsph.scene.probes import PointProbe as PointSpec
from warpsph.scene.schema import Scene

LARGEST_CONDITION = 1e4


class PointProbe(Probe):
    """First-order consistent interpolation of fluid fields; NaN where the point is not in the fluid.

    A point is in the fluid where phi_fluid / (1 - phi_wall) >= 1/2, phi = sum_b V_b W_b over the particles of
    the fluids or of walls and structures: half of the space that the walls leave free around it is filled.
    """

    def __init__(self, name: str, spec: PointSpec, scene: Scene) -> None:
        fluid_fields = tuple(dict.fromkeys(("position", "density", "mass", *spec.fields)))
        solids = dict.fromkeys(("boundary", "structure"), ("position", "volume"))
        needs = {"fluid": fluid_fields, **solids}
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._point = tuple(spec.at)
        self._fields = spec.fields
        self._smoothing = Smoothing.of(scene)

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """The fields in the order of the columns, vectors by component."""
        offsets, weights, values = self._gather(frame.of_kind("fluid"))
        _, wall_weights, _ = self._gather(frame.of_kind("boundary", "structure"))
        if weights.sum() < 0.5 * (1.0 - wall_weights.sum()) or not weights.any():
            return (math.nan,) * len(self.columns)
        return tuple(map(float, interpolate(offsets / self._smoothing.smoothing_length, weights, values)))

    def _gather(self, sets: Sequence[SetFrame]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of the particles near the point: x_b - x (n, dimension), V_b W_b (n,), fields (n, columns)."""
        parts = [self._gather_set(particle_set) for particle_set in sets]
        dimension = self._smoothing.dimension
        empty = (np.empty((0, dimension)), np.empty(0), np.empty((0, len(self.columns))))
        offsets, weights, values = zip(empty, *parts, strict=True)
        return np.concatenate(offsets), np.concatenate(weights), np.concatenate(values)

    def _gather_set(self, particle_set: SetFrame) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        smoothing, position = self._smoothing, particle_set.fields["position"]
        near = smoothing.near(position, enumerate(self._point))
        offsets = np.empty((len(near), smoothing.dimension))
        for axis, place in enumerate(self._point):
            offsets[:, axis] = smoothing.separation(position[near, axis], place, axis)
        weights = particle_volume(particle_set, near) * smoothing.weight(np.linalg.norm(offsets, axis=1))
        values = np.zeros((len(near), len(self.columns)))
        if particle_set.kind == "fluid":
            values = np.column_stack([particle_set.fields[field][near] for field in self._fields])
        return offsets, weights, values


def interpolate(offsets: np.ndarray, weights: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Values (k,) at the origin from `values` (n, k) at `offsets` (n, dimension), by moving least squares.

    The linear polynomial that fits best with the weights (n,), exact for linear fields (Lancaster &
    Salkauskas 1981; as a kernel correction Liu, Jun & Zhang 1995). Where the particles do not determine it,
    because they are few or lie in line, the weighted mean (Shepard 1968). Offsets should be of order one.
    """
    basis = np.column_stack([np.ones(len(offsets)), offsets])
    moments = basis.T @ (weights[:, None] * basis)
    if np.linalg.cond(moments) > LARGEST_CONDITION:
        return weights @ values / weights.sum()
    return np.linalg.solve(moments, basis.T @ (weights[:, None] * values))[0]
