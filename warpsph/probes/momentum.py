"""Momentum of structures."""

import numpy as np

from warpsph.frame import Frame
from warpsph.probes.mechanics import resultant
from warpsph.probes.probe import Probe
from warpsph.scene.probes import MomentumProbe as MomentumSpec
from warpsph.scene.schema import Scene


class MomentumProbe(Probe):
    """Sum of m v and of x cross m v over the particles of structures."""

    def __init__(self, name: str, spec: MomentumSpec, scene: Scene) -> None:
        needs = {"structure": ("position", "velocity", "mass")}
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._structure = spec.structure
        self._origin = np.zeros(scene.dimension)

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Momentum [kg m/s] and angular momentum about the origin [kg m2/s]; in the plane per metre of depth."""
        bodies = [s for s in frame.of_kind("structure") if self._structure in (None, s.name)]
        sums = [
            resultant(s.fields["position"], s.fields["mass"][:, None] * s.fields["velocity"], self._origin)
            for s in bodies
        ]
        return tuple(float(total) for total in np.sum(sums, axis=0))
