"""Load of the fluid on a wall or a structure."""

import numpy as np

from warpsph.frame import Frame
from warpsph.probes.mechanics import resultant
from warpsph.probes.probe import Probe
from warpsph.scene.probes import ForceProbe as ForceSpec
from warpsph.scene.schema import Scene


class ForceProbe(Probe):
    """Sum of the forces on the particles of a wall or a structure, and their torque about a fixed point.

    The point is the scene's, or the centre of mass at the start. Torque in the plane is about z.
    """

    def __init__(self, name: str, spec: ForceSpec, scene: Scene) -> None:
        needs = dict.fromkeys(("boundary", "structure"), ("position", "force"))
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._solid = spec.solid
        self._about = None if spec.about is None else np.array(spec.about)

    def start(self, frame: Frame) -> None:
        """Take the centre of mass, where the scene names no other point."""
        if self._about is None:
            self._about = frame.set_named(self._solid).fields["position"].mean(axis=0)

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Force [N] and torque [N m] by component; in the plane per metre of depth."""
        if self._about is None:
            raise ValueError("start() comes before evaluate()")
        fields = frame.set_named(self._solid).fields
        return resultant(fields["position"], fields["force"], self._about)
