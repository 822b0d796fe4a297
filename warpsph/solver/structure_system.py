"""Structures alone as a system that a simulation advances."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import warp as wp

from warpsph.frame import Inflow, SetFrame
from warpsph.particles.launch import Launcher
from warpsph.particles.state import host_view, write_array
from warpsph.physics.contact import UNITS as CONTACT_UNITS
from warpsph.physics.rigid import UNITS as RIGID_UNITS
from warpsph.physics.structure import UNITS, arrays_in
from warpsph.sampling import SampledSet
from warpsph.scene.schema import Scene
from warpsph.solver.errors import SimulationDiverged
from warpsph.solver.ledger import Ledger, sum_up
from warpsph.solver.relaxation import NotConverged, RelaxationStepper
from warpsph.solver.structure_assembly import Body, StructureParts, assemble_structures, is_static
from warpsph.solver.structure_fields import StructureFields
from warpsph.solver.structure_step import StructureStepper
from warpsph.solver.system import StepReport

TYPICAL_RATE = 5.0e6
"""Particle-steps a second of one CPU core, for a first estimate."""
NOTABLE_HOURGLASS = 0.25
"""Share of the hourglass energy in the elastic energy from which the penalty carries the result."""
NOTABLE_PENETRATION = 0.5
"""Depth in spacings from which contact is no longer a small disturbance of the geometry."""


class StructureSystem:
    """Structures of a scene, with the walls that they touch. Raises SceneError if they cannot be assembled."""

    def __init__(self, scene: Scene, sampled: Sequence[SampledSet], launcher: Launcher) -> None:
        self._scene = scene
        # Beside fluids walls belong to them.
        self._shown = [s for s in sampled if s.kind == "structure" or not scene.fluids]
        self.parts: StructureParts = assemble_structures(scene, sampled, launcher)
        make = RelaxationStepper if is_static(scene) else StructureStepper
        self.stepper: StructureStepper = make(scene, self.parts)
        self.stepper.start()
        self._fields = StructureFields(scene, self.parts, lambda: self.time, self.stepper.rigid_motion)

    @property
    def time(self) -> float:
        return self.stepper.time

    @property
    def particle_count(self) -> int:
        return sum(len(s.position) for s in self._shown)

    @property
    def removed_count(self) -> int:
        """Structures lose no particle."""
        return 0

    @property
    def list_builds(self) -> int:
        """The bonds of structures are made once, the lists of contact whenever something has moved far enough."""
        return 1 + (self.parts.contact.model.builds if self.parts.contact else 0)

    @property
    def sound_speed(self) -> float:
        """The largest sound speed at rest [m/s]."""
        return max(s.material.sound_speed for s in self._scene.structures.values())

    @property
    def sets(self) -> tuple[tuple[str, str, int], ...]:
        return tuple((s.name, s.kind, len(s.position)) for s in self._shown)

    @property
    def extremes(self) -> Mapping[str, float]:
        return self.stepper.extremes

    @property
    def fields(self) -> frozenset[str]:
        return self._fields.names

    @property
    def arrays(self) -> Mapping[str, wp.array]:
        return arrays_in(self.parts.model.state)

    def step(self, step_count: int) -> StepReport:
        try:
            report = self.stepper.step()
        except NotConverged as error:
            raise self._diverged(step_count, 0, str(error), math.nan) from error
        if self.stepper.failed:
            raise self.fault(step_count + report.count)
        return report

    def set_target(self, time: float) -> None:
        self.stepper.target = time

    def frame_sets(self, fields: Sequence[str] | None, ordered: bool) -> tuple[SetFrame, ...]:
        """See `StructureFields.names`; the particles of a structure always come in the order of their ids."""
        return self._fields.frame_sets(self._shown, fields)

    def ledger(self) -> Ledger:
        """Totals over all structures, with strain, hourglass and contact energy, work and dissipation."""
        sets = self.frame_sets(("velocity", "mass"), ordered=False)
        bodies = tuple(particles for particles in sets if particles.kind == "structure")
        return sum_up(self.time, bodies, np.asarray(self._scene.gravity), self._fields.energies())

    def warnings(self, largest: Mapping[str, float]) -> list[str]:
        warnings = [*self._thin_warnings(), *self._penetration_warnings(largest.get("penetration", 0.0))]
        energies = self._fields.energies()
        elastic = energies["strain"] + energies["hourglass"]
        if elastic > 0.0 and energies["hourglass"] > NOTABLE_HOURGLASS * elastic:
            share = energies["hourglass"] / elastic
            warnings.append(
                f"the hourglass penalty carries {share:.0%} of the elastic energy: the shape is not resolved; "
                "use a smaller spacing"
            )
        return warnings

    def _penetration_warnings(self, depth: float) -> list[str]:
        if depth <= NOTABLE_PENETRATION * self._scene.spacing:
            return []
        return [
            f"bodies in contact went {depth / self._scene.spacing:.2g} spacings into each other: "
            "use a larger contact.stiffness or a smaller spacing"
        ]

    def _thin_warnings(self) -> list[str]:
        bonds, what = self.parts.bonds, "plane" if self._scene.dimension == 3 else "line"
        warnings = []
        if flat := int((bonds.thin & (bonds.seen > 0.0)).sum()):
            warnings.append(
                f"{flat} particles have all their neighbours in one {what}: no strain is measured across it"
            )
        if lost := int((bonds.seen == 0.0).sum()):
            warnings.append(
                f"{lost} particles have too few neighbours to span a {what}: they carry no stress"
            )
        return warnings

    def inflows(self) -> dict[str, Inflow]:
        """Nothing flows."""
        return {}

    def describe(self) -> dict[str, Any]:
        model = self.parts.model
        groups = (model.reference, model.state, model.scratch)
        arrays = {name: array for group in groups for name, array in arrays_in(group).items()}
        contact = self.parts.contact
        if contact:
            arrays |= contact.model.named_arrays()
        if self.parts.rigid:
            arrays |= self.parts.rigid.model.arrays
        sizes = {name: int(array.capacity) for name, array in arrays.items()}
        units = UNITS | CONTACT_UNITS | RIGID_UNITS
        limits = {name: dt for name, dt in self.stepper.limits.items() if math.isfinite(dt)}
        end = self._scene.time.end
        steps = math.ceil(end / min(limits.values(), default=end))
        return {
            "sets": [{"name": name, "kind": kind, "particles": count} for name, kind, count in self.sets],
            "particles": self.particle_count,
            "passes": self._passes(),
            "pairs": [*self._bonded_pairs(), *self._touching_pairs()],
            "fields": [{"name": name, "unit": units[name], "bytes": size} for name, size in sizes.items()],
            "list_bytes": sizes["neighbours"] + sizes["bonds"] + sizes.get("contact_rows", 0),
            "neighbours": float(self.parts.bonds.count.mean()),
            "bytes_per_particle": sum(sizes.values()) / max(self.particle_count, 1),
            "sound_speed_m_s": self.sound_speed,
            "step_limits_s": limits,
            "estimated_steps": steps,
            "estimated_wall_s": steps * self.particle_count / TYPICAL_RATE,
        }

    def _passes(self) -> list[str]:
        timed = ["structure time laws"] if self.parts.model.has_time_laws else []
        touching = ["contact places", "contact sensing", "contact forces"] if self.parts.contact else []
        rigid = self.parts.rigid is not None
        return [
            "structure drift",
            *(["rigid motion"] if rigid else []),
            "structure stress",
            *touching,
            "structure forces",
            *(["rigid forces"] if rigid else []),
            *timed,
            "structure survey",
        ]

    def _bonded_pairs(self) -> list[str]:
        groups = [f"{' - '.join(group)} (bonded)" for group in self._scene.bonds]
        return ["structure - structure (bonds at rest)", *groups]

    def _touching_pairs(self) -> list[str]:
        contact = self.parts.contact
        if contact is None:
            return []
        return ["structure - structure (contact)", *(["structure - wall (contact)"] if contact.walls else [])]

    def save(self) -> dict[str, Any]:
        arrays = {name: np.array(host_view(array)) for name, array in self.arrays.items()}
        return arrays | self.stepper.save()

    def load(self, saved: Mapping[str, Any]) -> None:
        for name, array in self.arrays.items():
            write_array(array, saved[name])
        self.stepper.load(saved)

    def fault(self, step: int) -> SimulationDiverged:
        """What has stopped the stepper, which has looked after every step."""
        stepper = self.stepper
        ratio = -stepper.extremes["flattening"]
        if ratio <= 0.0:
            limit = "it is inverted: the determinant J of its deformation gradient is not positive"
            return self._diverged(step, stepper.flattest, limit, ratio)
        if stepper.faults:
            return self._diverged(step, self._not_finite(), "its state is not finite", math.nan)
        limit = "it is compressed so much that its stiffness allows no step; J of its deformation gradient is small"
        return self._diverged(step, stepper.flattest, limit, ratio)

    def _not_finite(self) -> int:
        state = self.parts.model.state
        total = host_view(state.velocity).sum(axis=1) + host_view(state.acceleration).sum(axis=1)
        return int(np.argmax(~np.isfinite(total)))

    def _diverged(self, step: int, particle: int, limit: str, value: float) -> SimulationDiverged:
        body = self._body_of(particle)
        model = self.parts.model
        place = host_view(model.reference.position)[particle] + host_view(model.state.displacement)[particle]
        return SimulationDiverged(
            set=body.name,
            particle=particle - body.first,
            position=tuple(float(x) for x in place),
            time=self.time,
            step=step,
            limit=limit,
            value=value,
            advice="Try a smaller spacing or numerics.structure.cfl, smaller loads, a law that resists compression "
            "(neo_hookean), or more numerics.structure.hourglass.",
        )

    def _body_of(self, particle: int) -> Body:
        return next(b for b in self.parts.bodies if b.first <= particle < b.first + b.count)
