"""What a clamp does to its structure."""

import numpy as np

from warpsph.frame import Frame
from warpsph.probes.mechanics import resultant
from warpsph.probes.probe import Probe
from warpsph.sampling.distance import signed_distance
from warpsph.scene.probes import ReactionProbe as ReactionSpec
from warpsph.scene.schema import Scene

NEAR = 0.1
"""Spacings beyond the region within which a particle is counted: clamped ones stand on its surface, up to rounding, and
free ones have no reaction."""


class ReactionProbe(Probe):
    """Sum of the forces that hold or move the clamped particles as prescribed, and their torque about a fixed point.

    The point is the scene's, or the centre of the clamped particles at rest. Where clamps overlap each counts
    all particles of its own region.
    """

    def __init__(self, name: str, spec: ReactionSpec, scene: Scene) -> None:
        needs = {"structure": ("position", "displacement", "reaction")}
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._structure, self._spacing = spec.structure, scene.spacing
        self._region = scene.structures[spec.structure].clamps[spec.clamp].region
        self._about = None if spec.about is None else np.array(spec.about)
        self._held = np.empty(0, dtype=bool)

    def start(self, frame: Frame) -> None:
        """Find the clamped particles, and their centre where the scene names no other point."""
        fields = frame.set_named(self._structure).fields
        rest = fields["position"] - fields["displacement"]
        self._held = signed_distance(self._region, rest) <= NEAR * self._spacing
        if self._about is None:
            self._about = rest[self._held].mean(axis=0)

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Force [N] and torque [N m] by component; in the plane per metre of depth."""
        if self._about is None or not len(self._held):
            raise ValueError("start() comes before evaluate()")
        fields = frame.set_named(self._structure).fields
        return resultant(fields["position"][self._held], fields["reaction"][self._held], self._about)
