"""What the structures of a run show: fields of their particles, and energies."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set

import numpy as np

from warpsph.frame import SetFrame
from warpsph.particles.state import host_view
from warpsph.sampling import SampledSet
from warpsph.sampling.kinematics import rigid_motions
from warpsph.scene.schema import Scene
from warpsph.solver.structure_assembly import StructureParts

USUAL_FIELDS = ("position", "velocity", "mass", "displacement")
OBSERVED = frozenset({"strain_energy", "hourglass_energy", "cauchy_stress", "von_mises"})
"""Fields that take a pass over the bonds."""


class StructureFields:
    """Evaluates fields of the present state; bodies lie in the order of their laws, sets in that of the scene."""

    def __init__(
        self,
        scene: Scene,
        parts: StructureParts,
        now: Callable[[], float],
        rigid_motion: Callable[[], Mapping[str, np.ndarray]] = dict,
    ) -> None:
        """`now` tells the simulated time [s], `rigid_motion` how the rigid bodies move (6, 3), by name."""
        self._scene = scene
        self._parts = parts
        self._now = now
        self._model = parts.model
        self._makers: Mapping[str, Callable[[], np.ndarray]] = {
            "position": lambda: self._host_reference() + self._state("displacement"),
            "velocity": lambda: self._state("velocity"),
            "acceleration": lambda: self._state("acceleration"),
            "displacement": lambda: self._state("displacement"),
            "mass": lambda: parts.mass,
            "strain_energy": lambda: self._energy(0),
            "hourglass_energy": lambda: self._energy(1),
            "contact_energy": self._contact_energy,
            "work": lambda: self._state("work"),
            "dissipated": lambda: self._state("dissipated"),
            "volume": lambda: host_view(self._model.reference.volume).astype(np.float64),
            "reaction": self._reaction,
            "cauchy_stress": lambda: host_view(self._model.scratch.cauchy),
            "von_mises": lambda: von_mises(host_view(self._model.scratch.cauchy).astype(np.float64)),
            "green_lagrange_strain": lambda: green_lagrange(self._gradient()),
            "volume_ratio": lambda: np.linalg.det(np.eye(scene.dimension) + self._gradient()),
        }
        if parts.rigid:
            self._makers = {**self._makers, "rigid_motion": lambda: self._rigid_motion(rigid_motion())}
        self._motions = rigid_motions(scene)
        self._touched = {patch.name: patch for patch in parts.contact.walls} if parts.contact else {}

    @property
    def names(self) -> frozenset[str]:
        """Fields that there are."""
        return frozenset(self._makers) | {"id"} | self._contact_fields

    def frame_sets(self, sampled: Sequence[SampledSet], fields: Sequence[str] | None) -> tuple[SetFrame, ...]:
        """All sets in the order of the scene; raises KeyError if there is no such field."""
        wanted = {"position", *(USUAL_FIELDS if fields is None else fields)} - {"id"}
        unknown = sorted(wanted - self.names)
        if unknown:
            raise KeyError(f"no field {unknown[0]!r}; there are {', '.join(sorted(self.names))}")
        if wanted & OBSERVED:
            self._model.observe()
        columns = {name: self._makers[name]() for name in wanted - self._contact_fields}
        sets, first_id = [], 0
        for one in sampled:
            ids = np.arange(first_id, first_id + len(one.position))
            first_id += len(one.position)
            own = (
                self._wall_columns(one, wanted)
                if one.kind == "boundary"
                else self._body_columns(one.name, columns)
            )
            kept = {name: values for name, values in own.items() if name in wanted}
            sets.append(SetFrame(one.name, one.kind, kept | {"id": ids}))
        return tuple(sets)

    def energies(self) -> dict[str, float]:
        """Strain, hourglass and contact energy of the present state, work done on the structures, dissipation [J]."""
        self._model.observe()
        strain, hourglass = host_view(self._model.scratch.energies).sum(axis=0)
        touching = {"contact": float(self._contact_energy().sum())} if self._parts.contact else {}
        return {
            "strain": float(strain),
            "hourglass": float(hourglass),
            **touching,
            "work": float(self._state("work").sum()),
            "dissipated": float(self._state("dissipated").sum()),
        }

    def _body_columns(self, name: str, columns: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        body = next(body for body in self._parts.bodies if body.name == name)
        return {field: np.array(values[body.range]) for field, values in columns.items()}

    def _wall_columns(self, wall: SampledSet, wanted: Set[str]) -> dict[str, np.ndarray]:
        position, velocity = wall.position, wall.velocity
        if wall.name in self._motions:
            pose = self._motions[wall.name](self._now())
            position, velocity = pose.position_of(wall.position), pose.velocity_of(wall.position)
        own = {
            "position": position,
            "velocity": velocity,
            "volume": np.full(len(position), wall.volume),
        }
        return own | ({"force": self._wall_force(wall)} if "force" in wanted else {})

    def _wall_force(self, wall: SampledSet) -> np.ndarray:
        """Force of contact on the particles of a wall (n, dim) [N]."""
        assert self._parts.contact is not None
        force, patch = np.zeros_like(wall.position), self._touched[wall.name]
        force[patch.particles] = self._parts.contact.model.wall_force()[patch.range]
        return force

    @property
    def _contact_fields(self) -> frozenset[str]:
        """Fields of walls that are there with contact."""
        return frozenset({"force"}) if self._parts.contact else frozenset()

    def _state(self, name: str) -> np.ndarray:
        return host_view(getattr(self._model.state, name))

    def _energy(self, column: int) -> np.ndarray:
        return host_view(self._model.scratch.energies)[:, column]

    def _contact_energy(self) -> np.ndarray:
        contact = self._parts.contact
        return contact.model.energy() if contact else np.zeros_like(self._parts.mass)

    def _rigid_motion(self, motion: Mapping[str, np.ndarray]) -> np.ndarray:
        """How the body of each particle moves (n, 6, 3), zero of flexible ones."""
        rows = np.zeros((len(self._parts.mass), 6, 3))
        for body in self._parts.bodies:
            if body.name in motion:
                rows[body.range] = motion[body.name]
        return rows

    def _host_reference(self) -> np.ndarray:
        return host_view(self._model.reference.position)

    def _gradient(self) -> np.ndarray:
        return host_view(self._model.scratch.gradient).astype(np.float64)

    def _reaction(self) -> np.ndarray:
        """Force of clamps on their particles (n, dim) [N]: what moves them as prescribed, less all other forces."""
        held = 1.0 - host_view(self._model.reference.free).astype(np.float64)
        for body in self._parts.rigid.bodies if self._parts.rigid else ():
            held[body.first : body.first + body.count] = 0.0
        return (
            self._parts.mass[:, None] * held * (self._prescribed_acceleration() - self._state("acceleration"))
        )

    def _prescribed_acceleration(self) -> np.ndarray:
        acceleration = np.zeros_like(self._state("acceleration"))
        time = self._now()
        for clamp in self._parts.clamps:
            if clamp.motion is not None:
                rest = self._host_reference()[clamp.particles]
                acceleration[clamp.particles] = clamp.motion(time).acceleration_of(rest)
        return acceleration


def green_lagrange(gradient: np.ndarray) -> np.ndarray:
    """E = (H + H^T + H^T H) / 2 of displacement gradients H (n, dim, dim)."""
    turned = np.swapaxes(gradient, 1, 2)
    return 0.5 * (gradient + turned + turned @ gradient)


def von_mises(cauchy: np.ndarray) -> np.ndarray:
    """sqrt(3/2 s : s) [Pa] with the deviator s of Cauchy stresses (n, 3, 3) [Pa]."""
    mean = np.trace(cauchy, axis1=1, axis2=2)[:, None, None] / 3.0
    deviator = cauchy - mean * np.eye(3)
    return np.sqrt(1.5 * np.einsum("nij,nij->n", deviator, deviator))
