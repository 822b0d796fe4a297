"""Mass through an open boundary."""

from warpsph.frame import Frame
from warpsph.probes.probe import Probe
from warpsph.scene.probes import FluxProbe as FluxSpec
from warpsph.scene.schema import Scene


class FluxProbe(Probe):
    """What has passed an open boundary into the domain."""

    def __init__(self, name: str, spec: FluxSpec, scene: Scene) -> None:
        super().__init__(spec.columns(name, scene.dimension), {})
        self._patch = spec.patch

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Mass a second [kg/s], its integral and the counted mass [kg]; in the plane per metre of depth."""
        passed = frame.inflows[self._patch]
        return passed.flux, passed.mass, passed.counted_mass
