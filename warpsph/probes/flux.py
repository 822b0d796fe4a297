"""Mass through open boundaries."""

import numpy as np

from warpsph.frame import Frame
from warpsph.probes.probe import Probe
from warpsph.scene.probes import FluxProbe as FluxSpec
from warpsph.scene.schema import Scene


class FluxProbe(Probe):
    """What has passed one open boundary into the domain, or all."""

    def __init__(self, name: str, spec: FluxSpec, scene: Scene) -> None:
        super().__init__(spec.columns(name, scene.dimension), {})
        self._patch = spec.patch

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Mass a second [kg/s], its integral and the counted mass [kg]; in the plane per metre of depth."""
        patches = frame.inflows.values() if self._patch is None else [frame.inflows[self._patch]]
        passed = np.array([(one.flux, one.mass, one.counted_mass) for one in patches])
        flux, mass, counted_mass = passed.sum(axis=0)
        return float(flux), float(mass), float(counted_mass)
