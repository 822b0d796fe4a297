"""How much fluid there is."""

from collections.abc import Iterator

import numpy as np

from warpsph.frame import Frame, SetFrame
from warpsph.probes.probe import Probe
from warpsph.scene.probes import VolumeProbe as VolumeSpec
from warpsph.scene.schema import Scene


class VolumeProbe(Probe):
    """Sum of m / rho over all fluids, or what of them lies in a region, and the number of the particles.

    Beside these, how many particles are gone since the start.
    """

    def __init__(self, name: str, spec: VolumeSpec, scene: Scene) -> None:
        needs = {"fluid": ("position", "mass", "density")}
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._region = spec.region
        self._first_count = 0

    def start(self, frame: Frame) -> None:
        """Count the particles that there are at the start."""
        self._first_count = sum(int(counts.sum()) for _, counts in self._counted(frame))

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Volume [m3], in the plane [m2], count, and loss since the start."""
        volume, number = 0.0, 0
        for fluid, counts in self._counted(frame):
            volume += float(
                np.sum((fluid.fields["mass"] / fluid.fields["density"])[counts], dtype=np.float64)
            )
            number += int(counts.sum())
        return volume, float(number), float(self._first_count - number)

    def _counted(self, frame: Frame) -> Iterator[tuple[SetFrame, np.ndarray]]:
        """Each fluid with which of its particles count (n,)."""
        for fluid in frame.of_kind("fluid"):
            position = fluid.fields["position"]
            counts = np.ones(len(position), dtype=bool)
            if self._region is not None:
                counts = np.all((position >= self._region.min) & (position <= self._region.max), axis=1)
            yield fluid, counts
