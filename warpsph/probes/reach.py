"""How far fluid has come from a point."""

import math

import numpy as np

from warpsph.frame import Frame
from warpsph.probes.probe import Probe
from warpsph.scene.probes import ReachProbe as ReachSpec
from warpsph.scene.schema import Scene


class ReachProbe(Probe):
    """Largest distance of a fluid particle from the point, plus half the diagonal of its cell; NaN without fluid.

    With the half diagonal a box of particles reaches exactly to its corners.
    """

    def __init__(self, name: str, spec: ReachSpec, scene: Scene) -> None:
        super().__init__(spec.columns(name, scene.dimension), {"fluid": ("position",)})
        self._center = np.array(spec.center)
        self._fluid = spec.fluid
        self._half_diagonal = 0.5 * scene.spacing * math.sqrt(scene.dimension)

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """The distance [m]."""
        fluids = [s for s in frame.of_kind("fluid") if self._fluid in (None, s.name)]
        position = np.concatenate([s.fields["position"] for s in fluids])
        if not len(position):
            return (math.nan,)
        return (float(np.linalg.norm(position - self._center, axis=1).max()) + self._half_diagonal,)
