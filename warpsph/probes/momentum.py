"""Momentum of fluids and structures."""

import numpy as np

from warpsph.frame import Frame, SetFrame
from warpsph.probes.mechanics import resultant
from warpsph.probes.probe import Probe
from warpsph.scene.probes import MomentumProbe as MomentumSpec
from warpsph.scene.schema import Scene


class MomentumProbe(Probe):
    """Sum of m v and of x cross m v over the particles of the sets that count."""

    def __init__(self, name: str, spec: MomentumSpec, scene: Scene) -> None:
        fields = ("position", "velocity", "mass")
        super().__init__(spec.columns(name, scene.dimension), {"fluid": fields, "structure": fields})
        named = {one for one in (spec.fluid, spec.structure) if one is not None}
        self._counted = named or {*scene.fluids, *scene.structures}
        self._origin = np.zeros(scene.dimension)

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Momentum [kg m/s] and angular momentum about the origin [kg m2/s]; in the plane per metre of depth."""
        sums = [self._of(one) for one in frame.sets if one.name in self._counted]
        return tuple(float(total) for total in np.sum(sums, axis=0))

    def _of(self, body: SetFrame) -> tuple[float, ...]:
        position, velocity, mass = (
            np.asarray(body.fields[name], dtype=np.float64) for name in ("position", "velocity", "mass")
        )
        return resultant(position, mass[:, None] * velocity, self._origin)
