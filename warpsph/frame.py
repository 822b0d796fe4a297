"""The state of every particle set at one time, as handed to writers, probes and callbacks."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

FIELD_UNITS: dict[str, str] = {
    "id": "1",
    "position": "m",
    "velocity": "m/s",
    "acceleration": "m/s2",
    "density": "kg/m3",
    "pressure": "Pa",
    "mass": "kg",
    "volume": "m3",
    "force": "N",
    "viscous_force": "N",
    "wall_shear_stress": "Pa",
    "vorticity": "1/s",
    "age": "s",
    "patch": "1",
    "displacement": "m",
    "reaction": "N",
    "cauchy_stress": "Pa",
    "von_mises": "Pa",
    "strain_energy": "J",
    "hourglass_energy": "J",
    "contact_energy": "J",
    "work": "J",
    "dissipated": "J",
}
"""Units of the fields in three dimensions; see `field_unit` for the plane."""

_PER_METRE_DEPTH = {"kg": "kg/m", "m3": "m2", "N": "N/m", "J": "J/m"}


def field_unit(name: str, dimension: int) -> str:
    """Unit of a field; in 2D extensive fields are per metre of depth. Unknown fields are pure numbers."""
    unit = FIELD_UNITS.get(name, "1")
    return _PER_METRE_DEPTH.get(unit, unit) if dimension == 2 else unit


@dataclass(frozen=True)
class SetFrame:
    """One particle set: its fields by name, each of shape (n,), (n, dimension) or, for tensors,
    (n, rows, columns), in the same particle order.

    `id` is int64; `position` is float64 in m; the other fields are in the units of `FIELD_UNITS`.
    `kind` is "fluid", "boundary" or "structure".
    """

    name: str
    kind: str
    fields: Mapping[str, np.ndarray]

    @property
    def count(self) -> int:
        """Number of particles in the set at this time."""
        return len(self.fields["position"])


@dataclass(frozen=True)
class Inflow:
    """What has passed an open boundary into the domain; in 2D per metre of depth.

    flux: mass that enters a second [kg/s]; mass: its integral over time [kg], both from density and velocity on the
    patch; counted_mass: of the particles that have entered less those that have left [kg]; entered, left, removed:
    particles that have entered the domain from the buffer, left it into the buffer, and left the buffer at its far end
    or been removed behind an inlet.
    """

    flux: float
    mass: float
    counted_mass: float
    entered: int
    left: int
    removed: int


@dataclass(frozen=True)
class Frame:
    """All particle sets at one time [s], and what has passed the open boundaries; `index` numbers the frames of a run
    from 0, `spacing` is in m."""

    index: int
    time: float
    dimension: int
    spacing: float
    sets: tuple[SetFrame, ...]
    inflows: Mapping[str, Inflow] = field(default_factory=dict)

    def set_named(self, name: str) -> SetFrame:
        """The set of that name; KeyError names the sets there are."""
        for particle_set in self.sets:
            if particle_set.name == name:
                return particle_set
        raise KeyError(f"no particle set {name!r}; there are {', '.join(s.name for s in self.sets)}")

    def of_kind(self, *kinds: str) -> tuple[SetFrame, ...]:
        """The sets of one kind or a few, in scene order."""
        return tuple(s for s in self.sets if s.kind in kinds)
