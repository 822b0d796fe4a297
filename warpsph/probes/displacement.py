"""How a material point of a structure moves."""

import numpy as np

from warpsph.frame import Frame
from warpsph.probes.probe import Probe
from warpsph.sampling.distance import signed_distance
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.probes import DisplacementProbe as DisplacementSpec
from warpsph.scene.schema import Scene

FARTHEST = 0.5
"""Spacings outside the shape at which a point still counts as one of its surface."""
BEYOND_NEAREST = 1.5
"""Spacings beyond the nearest particle to which others take part: at least the corners of a lattice cell."""
SMALLEST_SPREAD = 1e-4
"""Part of the largest moment below which particles do not determine a gradient in a direction."""


class DisplacementProbe(Probe):
    """First-order moving least squares over the particles near the point at rest; the weights never change.

    Exact for linear fields, also where the point lies on the surface, outside of all particle centres.
    """

    def __init__(self, name: str, spec: DisplacementSpec, scene: Scene) -> None:
        needs = {"structure": ("position", "displacement", "velocity")}
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._structure, self._point = spec.structure, np.array(spec.at)
        self._key, self._spacing = f"probes.{name}.at", scene.spacing
        self._shape = scene.structures[spec.structure].shape
        self._near, self._weights = np.empty(0, dtype=np.int64), np.empty(0)

    def start(self, frame: Frame) -> None:
        """Find the particles around the point and their weights. Raises SceneError if it is not in the structure."""
        outside = float(signed_distance(self._shape, self._point[None])[0])
        if outside > FARTHEST * self._spacing:
            message = f"the point is {outside:.3g} m outside of the structure {self._structure!r}"
            problem = Problem.at(self._key, message, "a point of the structure at rest", self._point.tolist())
            raise SceneError([problem])
        fields = frame.set_named(self._structure).fields
        offsets = (fields["position"] - fields["displacement"] - self._point) / self._spacing
        distance = np.linalg.norm(offsets, axis=1)
        reach = distance.min() + BEYOND_NEAREST
        self._near = np.flatnonzero(distance < reach)
        nearness = (1.0 - (distance[self._near] / reach) ** 2) ** 2
        self._weights = consistent_weights(offsets[self._near], nearness)

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Displacement [m], then velocity [m/s], by component."""
        if not len(self._near):
            raise ValueError("start() comes before evaluate()")
        fields = frame.set_named(self._structure).fields
        values = np.column_stack([fields[name][self._near] for name in ("displacement", "velocity")])
        return tuple(map(float, self._weights @ values))


def consistent_weights(offsets: np.ndarray, nearness: np.ndarray) -> np.ndarray:
    """Weights (n,) that give the value at the origin from values at `offsets` (n, dimension) of order one.

    The value of the linear polynomial that fits best with the weights `nearness` (n,) (Lancaster & Salkauskas
    1981). In directions in which the offsets do not spread, as across a single row, the fit has no slope.
    """
    share = nearness / nearness.sum()
    centre = share @ offsets
    spread = offsets - centre
    moments = spread.T @ (share[:, None] * spread)
    slope = np.linalg.pinv(moments, rcond=SMALLEST_SPREAD, hermitian=True)
    return share * (1.0 - spread @ slope @ centre)
