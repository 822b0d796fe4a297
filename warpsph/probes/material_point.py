"""A material point of a structure, between, at the edge of or on its particles."""

from collections.abc import Sequence

import numpy as np

from warpsph.frame import Frame
from warpsph.sampling.distance import signed_distance
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.schema import Scene

FARTHEST = 0.5
"""Spacings outside the shape at which a point still counts as one of its surface."""
BEYOND_NEAREST = 1.5
"""Spacings beyond the nearest particle to which others take part: at least the corners of a lattice cell."""
SMALLEST_SPREAD = 1e-4
"""Part of the largest moment below which particles do not determine a gradient in a direction."""


class MaterialPoint:
    """First-order moving least squares over the particles near the point at rest; the weights never change.

    Exact for linear fields, also where the point lies on the surface, outside of all particle centres.
    """

    needs = ("position", "displacement")
    """Fields that `find` reads."""

    def __init__(self, structure: str, at: Sequence[float], scene: Scene, key: str) -> None:
        """A point at rest at `at` [m]; `key` is its place in the scene."""
        self.rest = np.array(at)
        self._structure, self._key, self._spacing = structure, key, scene.spacing
        self._shape = scene.structures[structure].shape
        self._near, self._weights = np.empty(0, dtype=np.int64), np.empty(0)

    def find(self, frame: Frame) -> None:
        """Choose particles and weights. Raises SceneError if the point is not in the structure."""
        outside = float(signed_distance(self._shape, self.rest[None])[0])
        if outside > FARTHEST * self._spacing:
            message = f"the point is {outside:.3g} m outside of the structure {self._structure!r}"
            problem = Problem.at(self._key, message, "a point of the structure at rest", self.rest.tolist())
            raise SceneError([problem])
        fields = frame.set_named(self._structure).fields
        offsets = (fields["position"] - fields["displacement"] - self.rest) / self._spacing
        distance = np.linalg.norm(offsets, axis=1)
        reach = distance.min() + BEYOND_NEAREST
        self._near = np.flatnonzero(distance < reach)
        nearness = (1.0 - (distance[self._near] / reach) ** 2) ** 2
        self._weights = consistent_weights(offsets[self._near], nearness)

    def value(self, frame: Frame, field: str) -> np.ndarray:
        """A vector field at the point (dimension,)."""
        if not len(self._near):
            raise ValueError("find() comes before value()")
        return self._weights @ frame.set_named(self._structure).fields[field][self._near]


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
