"""Kernel sums over the particles near a place, on the host."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from warpsph.frame import SetFrame
from warpsph.laws.smoothing import SMOOTHING_LAWS
from warpsph.scene.schema import Scene
from warpsph.scene.types import AXES


@dataclass(frozen=True)
class Smoothing:
    """The kernel of a scene and its periodic space; lengths in m."""

    kernel: str
    dimension: int
    smoothing_length: float
    support_radius: float
    periods: tuple[float | None, ...]

    @classmethod
    def of(cls, scene: Scene) -> "Smoothing":
        """Kernel and space that the scene computes with."""
        periodic = scene.domain.periodic
        return cls(
            kernel=scene.numerics.kernel,
            dimension=scene.dimension,
            smoothing_length=scene.numerics.h_over_dp * scene.spacing,
            support_radius=scene.support_radius,
            periods=tuple(
                periodic[axis][1] - periodic[axis][0] if axis in periodic else None
                for axis in AXES[: scene.dimension]
            ),
        )

    def weight(self, distance: np.ndarray) -> np.ndarray:
        """W [m^-dimension] at distances [m]."""
        h = self.smoothing_length
        return SMOOTHING_LAWS[self.kernel].value(distance / h, self.dimension) / h**self.dimension

    def separation(self, position: np.ndarray, place: float, axis: int) -> np.ndarray:
        """position - place along an axis, to the nearest periodic image."""
        distance = np.asarray(position, dtype=np.float64) - place
        period = self.periods[axis]
        return distance if period is None else distance - period * np.round(distance / period)

    def near(self, position: np.ndarray, place: Iterable[tuple[int, float]]) -> np.ndarray:
        """Indices of the particles (n, dimension) within the support radius of a place along each axis named.

        `place` pairs an axis with a coordinate; axes that it leaves out are free.
        """
        indices = np.arange(len(position))
        for axis, coordinate in place:
            separation = self.separation(position[indices, axis], coordinate, axis)
            indices = indices[np.abs(separation) < self.support_radius]
        return indices


def particle_volume(particle_set: SetFrame, indices: np.ndarray) -> np.ndarray:
    """Volume [m^dimension] of some particles: m / rho in a fluid, the given volume in a wall."""
    fields = particle_set.fields
    if particle_set.kind == "fluid":
        return np.asarray(fields["mass"][indices], dtype=np.float64) / fields["density"][indices]
    return np.asarray(fields["volume"][indices], dtype=np.float64)
