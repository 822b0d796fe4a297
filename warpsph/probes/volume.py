"""How much fluid there is."""

import numpy as np

from warpsph.frame import Frame
from warpsph.probes.probe import Probe
from warpsph.scene.probes import VolumeProbe as VolumeSpec
from warpsph.scene.schema import Scene


class VolumeProbe(Probe):
    """Sum of m / rho over all fluids, and the number of their particles."""

    def __init__(self, name: str, spec: VolumeSpec, scene: Scene) -> None:
        needs = {"fluid": ("mass", "density")}
        super().__init__(spec.columns(name, scene.dimension), needs)

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Volume [m3], in the plane [m2], and count."""
        fields = [fluid.fields for fluid in frame.of_kind("fluid")]
        volume = sum(float(np.sum(f["mass"] / f["density"], dtype=np.float64)) for f in fields)
        return volume, float(sum(len(f["mass"]) for f in fields))
