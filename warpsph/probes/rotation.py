"""How far a material point of a structure has turned about an axis."""

import math

import numpy as np

from warpsph.frame import Frame
from warpsph.probes.material_point import MaterialPoint
from warpsph.probes.probe import Probe
from warpsph.scene.probes import RotationProbe as RotationSpec
from warpsph.scene.schema import Scene

ACROSS = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}
"""The two axes across each, in the order in which a right-handed turn takes the first to the second."""


class RotationProbe(Probe):
    """Angle between where the point is and where it was at rest, both seen from the axis."""

    def __init__(self, name: str, spec: RotationSpec, scene: Scene) -> None:
        super().__init__(spec.columns(name, scene.dimension), {"structure": MaterialPoint.needs})
        self._point = MaterialPoint(spec.structure, spec.at, scene, f"probes.{name}.at")
        self._across = list(ACROSS[spec.axis])
        self._arm = (self._point.rest - np.array(spec.about))[self._across]

    def start(self, frame: Frame) -> None:
        """Find the particles around the point. Raises SceneError if it is not in the structure."""
        self._point.find(frame)

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """The angle [rad] from -pi to pi."""
        rest, now = self._arm, self._arm + self._point.value(frame, "displacement")[self._across]
        turned = math.atan2(rest[0] * now[1] - rest[1] * now[0], float(rest @ now))
        return (turned,)
