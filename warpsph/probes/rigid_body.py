"""How a rigid body moves, and what acts on it."""

from warpsph.frame import Frame
from warpsph.probes.probe import Probe
from warpsph.scene.probes import RigidBodyProbe as RigidBodySpec
from warpsph.scene.schema import Scene

MOVING, TURNING = (0, 1), (2, 3)
FORCE, TORQUE = 4, 5
"""Rows of the field `rigid_motion`."""


class RigidBodyProbe(Probe):
    """The row of the field `rigid_motion` that all particles of the body share."""

    def __init__(self, name: str, spec: RigidBodySpec, scene: Scene) -> None:
        super().__init__(spec.columns(name, scene.dimension), {"structure": ("rigid_motion",)})
        self._structure = spec.structure
        self._along = slice(0, scene.dimension)
        self._about = slice(0, 3) if scene.dimension == 3 else slice(2, 3)

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Position [m], velocity [m/s], angle [rad], angular velocity [rad/s], force [N] and torque [N m]."""
        motion = frame.set_named(self._structure).fields["rigid_motion"][0]
        moving = (motion[row, self._along] for row in MOVING)
        turning = (motion[row, self._about] for row in TURNING)
        rows = (*moving, *turning, motion[FORCE, self._along], motion[TORQUE, self._about])
        return tuple(float(component) for row in rows for component in row)
