"""How much fluid there is."""

import numpy as np

from warpsph.frame import Frame
from warpsph.probes.probe import Probe
from warpsph.scene.probes import VolumeProbe as VolumeSpec
from warpsph.scene.schema import Scene


class VolumeProbe(Probe):
    """Sum of m / rho over all fluids, the number of their particles, and how many are gone since the start."""

    def __init__(self, name: str, spec: VolumeSpec, scene: Scene) -> None:
        needs = {"fluid": ("mass", "density")}
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._first_count = 0

    def start(self, frame: Frame) -> None:
        """Count the particles that there are at the start."""
        self._first_count = _count(frame)

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Volume [m3], in the plane [m2], count, and loss since the start."""
        fields = [fluid.fields for fluid in frame.of_kind("fluid")]
        volume = sum(float(np.sum(f["mass"] / f["density"], dtype=np.float64)) for f in fields)
        count = _count(frame)
        return volume, float(count), float(self._first_count - count)


def _count(frame: Frame) -> int:
    return sum(fluid.count for fluid in frame.of_kind("fluid"))
