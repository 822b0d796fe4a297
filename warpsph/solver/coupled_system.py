"""Fluids and structures together as a system that a simulation advances."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from typing import Any

import numpy as np
import warp as wp

from warpsph.frame import Inflow, SetFrame
from warpsph.particles.launch import Launcher
from warpsph.particles.state import host_view
from warpsph.physics.material import material, smoothing_length
from warpsph.sampling import SampledSet
from warpsph.scene.schema import Scene
from warpsph.solver.coupled_step import CoupledStepper, inertial_step
from warpsph.solver.fluid_system import FluidSystem
from warpsph.solver.ledger import Ledger, sum_up
from warpsph.solver.rigid_assembly import density_of
from warpsph.solver.structure_system import StructureSystem
from warpsph.solver.system import StepReport

ON_FACES = ("force", "pressure", "viscous_force", "wall_shear_stress")
"""Fields that structures have only in a fluid."""
USUAL_ON_FACES = ("force", "pressure")
STRUCTURE = "structure_"
"""Before the names of arrays, extremes and saved values of structures."""


class CoupledSystem:
    """Fluids, walls and structures of a scene. Raises SceneError if they cannot be assembled."""

    def __init__(self, scene: Scene, sampled: Sequence[SampledSet], launcher: Launcher) -> None:
        self._scene = scene
        self.structure = StructureSystem(scene, sampled, launcher)
        self.fluid = FluidSystem(scene, sampled, launcher, self.structure.parts)
        self._bodies = [s for s in sampled if s.kind == "structure"]
        self._couple()

    def _couple(self) -> None:
        """Make the step that fluid and structures share; needed again when the fluid has been assembled anew."""
        faces = self.fluid.parts.faces
        assert faces is not None
        self._faces, self._face_fields = faces, self.fluid.wall_fields(faces.model.walls)
        self.stepper = CoupledStepper(
            self._scene, self.fluid.stepper, self.structure.stepper, faces, self._inertial_step()
        )

    def _grow(self) -> None:
        """Give the fluid more places."""
        before = self.stepper
        self.fluid.grow()
        self._couple()
        self.stepper.target, self.stepper.lead, self.stepper.size = before.target, before.lead, before.size

    def _inertial_step(self) -> float:
        """The longest step of the fluid [s] beside the lightest structure."""
        lightest = min(density_of(self._scene, body) for body in self._bodies)
        ratio = lightest / material(self._scene).density
        return inertial_step(ratio, smoothing_length(self._scene), self.fluid.sound_speed)

    @property
    def time(self) -> float:
        return self.fluid.time

    @property
    def particle_count(self) -> int:
        return self.fluid.particle_count + sum(len(body.position) for body in self._bodies)

    @property
    def removed_count(self) -> int:
        return self.fluid.removed_count

    @property
    def list_builds(self) -> int:
        return self.fluid.list_builds

    @property
    def sound_speed(self) -> float:
        """The artificial sound speed of the fluid [m/s]."""
        return self.fluid.sound_speed

    @property
    def sets(self) -> tuple[tuple[str, str, int], ...]:
        return (*self.fluid.sets, *((s.name, s.kind, len(s.position)) for s in self._bodies))

    @property
    def extremes(self) -> Mapping[str, float]:
        """Those of the fluid, and those of structures with `structure_` before their names."""
        return {**self.fluid.extremes, **_prefixed(self.structure.extremes)}

    @property
    def fields(self) -> frozenset[str]:
        return self.fluid.fields | self.structure.fields

    @property
    def arrays(self) -> Mapping[str, wp.array]:
        """Those of the fluid under their names, those of structures with `structure_` before them."""
        return {**self.fluid.arrays, **_prefixed(self.structure.arrays)}

    def step(self, step_count: int) -> StepReport:
        if self.fluid.is_short_of_places:
            self._grow()
        report = self.stepper.step()
        self.fluid.check(step_count, report)
        if self.structure.stepper.failed:
            raise self.structure.fault(step_count)
        return report

    def set_target(self, time: float) -> None:
        self.stepper.target = time

    def frame_sets(self, fields: Sequence[str] | None, ordered: bool) -> tuple[SetFrame, ...]:
        """Fields of fluids and walls as without structures; structures have also the force of the fluid on each
        particle, its viscous part, and the pressure and the shear stress that the particle's first face shows."""
        unknown = sorted(set(fields or ()) - self.fields)
        if unknown:
            raise KeyError(f"no field {unknown[0]!r}; there are {', '.join(sorted(self.fields))}")
        flowing = self.fluid.frame_sets(_among(fields, self.fluid.fields), ordered)
        solid = self.structure.frame_sets(_among(fields, self.structure.fields), ordered)
        asked = USUAL_ON_FACES if fields is None else fields
        of_fluid = {name: self._of_fluid(name) for name in ON_FACES if name in asked}
        return (*flowing, *(self._with(of_fluid, body) for body in solid))

    def _of_fluid(self, field: str) -> np.ndarray:
        """What the fluid does to each structure particle: forces [N], and the stresses on its first face [Pa]."""
        faces, assembly = self._faces.faces, self.fluid.parts.assembly
        match field:
            case "force":
                return faces.sums(host_view(self._faces.model.react()))
            case "viscous_force":
                return faces.sums(self._face_fields.viscous_force())
            case "wall_shear_stress":
                return faces.first_faces(self._face_fields.shear_stress())
        pressure = host_view(assembly.scratch.position_pressure)[assembly.layout.first_face :, -1]
        return faces.first_faces(pressure)

    def _with(self, columns: Mapping[str, np.ndarray], body: SetFrame) -> SetFrame:
        """The particles of a structure with further columns over all structures."""
        place = next(b.range for b in self.structure.parts.bodies if b.name == body.name)
        own = {name: values[place] for name, values in columns.items()}
        return SetFrame(body.name, body.kind, {**body.fields, **own})

    def ledger(self) -> Ledger:
        """Totals over fluids and structures, with the energies of structures."""
        sets = self.frame_sets(("velocity", "mass"), ordered=False)
        moving = tuple(particles for particles in sets if particles.kind != "boundary")
        energies = self.structure.ledger().energies
        return sum_up(self.time, moving, np.asarray(self._scene.gravity), energies)

    def warnings(self, largest: Mapping[str, float]) -> list[str]:
        return [*self.fluid.warnings(largest), *self.structure.warnings(_own(largest))]

    def inflows(self) -> dict[str, Inflow]:
        """What has passed the open boundaries, by name."""
        return self.fluid.inflows()

    def describe(self) -> dict[str, Any]:
        fluid, structure = self.fluid.describe(), self.structure.describe()
        bytes_used = sum(d["bytes_per_particle"] * d["particles"] for d in (fluid, structure))
        fields = [{**field, "name": STRUCTURE + field["name"]} for field in structure["fields"]]
        return {
            **fluid,
            "sets": [{"name": name, "kind": kind, "particles": n} for name, kind, n in self.sets],
            "particles": self.particle_count,
            "passes": [*fluid["passes"], "place faces", "push structures", *structure["passes"]],
            "pairs": [*fluid["pairs"], *structure["pairs"]],
            "fields": [*fluid["fields"], *fields],
            "list_bytes": fluid["list_bytes"] + structure["list_bytes"],
            "bytes_per_particle": bytes_used / max(self.particle_count, 1),
            "step_limits_s": {
                **fluid["step_limits_s"],
                "added_mass": self.stepper.inertial_step,
                **{f"{name}, a sub-step": dt for name, dt in structure["step_limits_s"].items()},
            },
        }

    def save(self) -> dict[str, Any]:
        own = {"lead": self.stepper.lead, "size": self.stepper.size}
        return self.fluid.save() | _prefixed(self.structure.save()) | own

    def load(self, saved: Mapping[str, Any]) -> None:
        self.structure.load(_own(saved))
        self.fluid.load(saved)
        target = self.stepper.target
        self._couple()
        self.stepper.target = target
        self.stepper.lead, self.stepper.size = float(saved["lead"]), float(saved["size"])


def _prefixed(values: Mapping[str, Any]) -> dict[str, Any]:
    return {STRUCTURE + name: value for name, value in values.items()}


def _own(values: Mapping[str, Any]) -> dict[str, Any]:
    """What has been prefixed among the values."""
    return {
        name.removeprefix(STRUCTURE): value for name, value in values.items() if name.startswith(STRUCTURE)
    }


def _among(fields: Sequence[str] | None, known: Set[str]) -> list[str] | None:
    return None if fields is None else [field for field in fields if field in known]
