"""How a material point of a structure moves."""

import numpy as np

from warpsph.frame import Frame
from warpsph.probes.material_point import MaterialPoint
from warpsph.probes.probe import Probe
from warpsph.sampling.kinematics import RigidMotion, rigid_motion
from warpsph.scene.probes import DisplacementProbe as DisplacementSpec
from warpsph.scene.schema import Scene


class DisplacementProbe(Probe):
    """Displacement and velocity of a material point, as seen at rest or by someone who moves with a clamp."""

    def __init__(self, name: str, spec: DisplacementSpec, scene: Scene) -> None:
        needs = {"structure": (*MaterialPoint.needs, "velocity")}
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._point = MaterialPoint(spec.structure, spec.at, scene, f"probes.{name}.at")
        self._frame = _motion_of_clamp(spec, scene)

    def start(self, frame: Frame) -> None:
        """Find the particles around the point. Raises SceneError if it is not in the structure."""
        self._point.find(frame)

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Displacement [m], then velocity [m/s], by component."""
        shift, velocity = (self._point.value(frame, field) for field in ("displacement", "velocity"))
        if self._frame is not None:
            shift, velocity = self._seen_from(self._frame, frame.time, shift, velocity)
        return (*map(float, shift), *map(float, velocity))

    def _seen_from(
        self, motion: RigidMotion, time: float, shift: np.ndarray, velocity: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """The same in the coordinates of a body that moves by x = R Y + b.

        The point stands at Y = R^T (x - b) there, so that dY/dt = R^T (v - omega x (R Y) - db/dt).
        """
        pose = motion(time)
        inside = (self._point.rest + shift - pose.translation) @ pose.rotation
        return inside - self._point.rest, (velocity - pose.velocity_of(inside)) @ pose.rotation


def _motion_of_clamp(spec: DisplacementSpec, scene: Scene) -> RigidMotion | None:
    """Motion of the clamp with which the frame moves; none where it does not move."""
    if spec.frame is None:
        return None
    motion = scene.structures[spec.structure].clamps[spec.frame].motion
    key = f"structures.{spec.structure}.clamps.{spec.frame}.motion"
    return rigid_motion(scene, motion, key) if motion else None
