"""Probes of structures and rigid bodies."""

from __future__ import annotations

from typing import Literal

from warpsph.scene.probe_model import ProbeModel, force_columns
from warpsph.scene.types import AXES, Axis, Name, Vector

STRUCTURE_ENERGIES = (
    "kinetic",
    "strain",
    "hourglass",
    "contact",
    "dissipated",
    "work",
    "potential",
    "total",
    "drift",
)
"""Columns of the energies of structures."""


class DisplacementProbe(ProbeModel):
    """Displacement and velocity of a material point of a structure, by first-order consistent interpolation."""

    type: Literal["displacement"] = "displacement"
    structure: Name
    """The structure."""

    at: Vector
    """Where the point is at rest [m]; in the structure or on its surface."""

    frame: Name | None = None
    """Clamp of the structure with which the frame of reference moves and turns; null: one at rest. Default: null."""

    def quantities(self, dimension: int) -> tuple[str, ...]:
        shifts = tuple(f"displacement_{axis}[m]" for axis in AXES[:dimension])
        return shifts + tuple(f"velocity_{axis}[m/s]" for axis in AXES[:dimension])


class RotationProbe(ProbeModel):
    """Angle by which a material point of a structure has turned about an axis, right-handed, from -pi to pi."""

    type: Literal["rotation"] = "rotation"
    structure: Name
    """The structure."""

    at: Vector
    """Where the point is at rest [m]; in the structure or on its surface, and not on the axis."""

    about: Vector
    """A point of the axis [m]."""

    axis: Axis = "z"
    """Direction of the axis; z in two dimensions. Default: z."""

    def quantities(self, dimension: int) -> tuple[str, ...]:
        return ("angle[rad]",)


class ReactionProbe(ProbeModel):
    """Force and torque of a clamp on its structure."""

    type: Literal["reaction"] = "reaction"
    structure: Name
    """The structure."""

    clamp: Name
    """Name of its clamp."""

    about: Vector | None = None
    """Point about which the torque is taken [m]; null: the centre of the clamped particles at rest. Default: null."""

    def quantities(self, dimension: int) -> tuple[str, ...]:
        return force_columns(dimension)


class RigidBodyProbe(ProbeModel):
    """Motion of a rigid body, and the force and torque of all that acts on it but what holds its axes.

    Position and velocity are those of its centre of mass, and so is the torque about it. The angle is the integral of
    the angular velocity: in the plane it counts turns, in space each component is that of an axis fixed in space.
    """

    type: Literal["rigid_body"] = "rigid_body"
    structure: Name
    """The structure, which has to be rigid."""

    def quantities(self, dimension: int) -> tuple[str, ...]:
        axes, about = AXES[:dimension], AXES if dimension == 3 else ("z",)
        place = tuple(f"position_{axis}[m]" for axis in axes)
        place += tuple(f"velocity_{axis}[m/s]" for axis in axes)
        turn = tuple(f"angle_{axis}[rad]" for axis in about)
        turn += tuple(f"angular_velocity_{axis}[rad/s]" for axis in about)
        return place + turn + force_columns(dimension)


class StructureEnergyProbe(ProbeModel):
    """Energies of structures.

    `work` has been done by loads and moving clamps, `dissipated` has been lost to damping and friction; `potential`
    is that of gravity, zero at rest. `total` = kinetic + strain + hourglass + contact + potential + dissipated - work:
    it keeps its value where energy is conserved, and `drift` is how far it has come from that at the start.
    """

    type: Literal["structure_energy"] = "structure_energy"
    structure: Name | None = None
    """One structure only; null: all. Default: null."""

    def quantities(self, dimension: int) -> tuple[str, ...]:
        unit = "J/m" if dimension == 2 else "J"
        return tuple(f"{energy}[{unit}]" for energy in STRUCTURE_ENERGIES)
