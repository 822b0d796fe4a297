"""Total-Lagrangian structures: the arrays of a run and the passes over them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import Any

import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.pose import make_pose_struct
from warpsph_kernels.structure import (
    CLOCK_SIZE,
    StructureOptions,
    make_stress_kernel,
    make_structure_kernels,
)
from warpsph_kernels.structure_survey import (
    BLOCK,
    EXTREMES,
    make_observation_kernel,
    make_survey_kernel,
)

from warpsph.particles.launch import Launcher, Pass

SUB_STEPS = 32
"""Steps of structures between two looks of the host at their state."""


UNITS = {
    "position": "m",
    "volume": "m^dim",
    "structure": "1",
    "materials": "SI",
    "neighbours": "1",
    "bonds": "m, m^-2",
    "ends": "1",
    "penalty": "Pa",
    "correction": "1",
    "thin_normal": "1",
    "own_gradient": "1/m",
    "other_gradient": "1/m",
    "stress": "Pa",
    "free": "1",
    "clamp": "1",
    "load": "m/s^2",
    "displacement": "m",
    "velocity": "m/s",
    "acceleration": "m/s^2",
    "work": "J",
    "dissipated": "J",
    "gradient": "1",
    "traction": "Pa",
    "contact_force": "N",
    "fluid_force": "N",
    "extremes": "SI",
    "load_factor": "1",
    "prescriptions": "SI",
    "energies": "J",
    "cauchy": "Pa",
}


@dataclass(frozen=True)
class LawRange:
    """A contiguous range of particles whose structures share a constitutive law and a plane state."""

    law: str
    plane_stress: bool
    first: int
    count: int

    @property
    def blocks(self) -> int:
        """Threads that survey the range."""
        return -(-self.count // BLOCK)


@dataclass(frozen=True)
class StructureReference:
    """What never changes in a run; n particles, rows of m neighbours.

    position: (n,) at rest [m]; volume: (n,) [m^dim]; structure: (n,) index into `materials`; neighbours: (n, m);
    bonds: (n, m) records (X_ab [m], w_ab [m^-2]); ends: (n, 2) of the bonds without and with rigid
    particles; penalty: (n,) of each particle, zero of rigid ones, in scenes that bond structures [Pa];
    correction: (n,) L_a [1]; thin_normal: (n,) records
    (normal of coplanar neighbours, 1 or 0 where even a plane is not seen); free: (n,) vectors, 1 where a component of
    the displacement is free and 0 where a clamp prescribes it; clamp: (n,) index of the moving clamp or -1;
    load: (loads, n) force per mass of each load before its time law [m/s^2]; own_gradient, other_gradient: (n, m) of
    scattered particles, see `warpsph.particles.consistency`.
    """

    position: wp.array
    volume: wp.array
    structure: wp.array
    materials: wp.array
    neighbours: wp.array
    bonds: wp.array
    ends: wp.array
    penalty: wp.array
    correction: wp.array
    thin_normal: wp.array
    free: wp.array
    clamp: wp.array
    load: wp.array
    own_gradient: wp.array
    other_gradient: wp.array


@dataclass(frozen=True)
class StructureState:
    """What evolves, and what a checkpoint keeps; every array has shape (n,), all in double precision.

    displacement [m]; velocity [m/s]; acceleration [m/s^2] before clamps; work: done by loads and moving clamps [J];
    dissipated: by damping and friction [J].
    """

    displacement: wp.array
    velocity: wp.array
    acceleration: wp.array
    work: wp.array
    dissipated: wp.array


@dataclass(frozen=True)
class StructureScratch:
    """What is computed anew: H [1], Q and P [Pa] (see the kernels), forces of contact and fluid [N], extremes, time
    laws, output."""

    gradient: wp.array
    traction: wp.array
    stress: wp.array
    contact_force: wp.array
    fluid_force: wp.array
    extremes: wp.array
    load_factor: wp.array
    prescriptions: wp.array
    energies: wp.array
    cauchy: wp.array


def arrays_in(group: StructureReference | StructureState | StructureScratch) -> dict[str, wp.array]:
    """Name and array of each member of a group."""
    return {member.name: getattr(group, member.name) for member in fields(group)}


def allocate_state(arithmetic: Arithmetic, count: int, device: Any) -> StructureState:
    """Return a state at rest."""
    vectors = (wp.zeros(count, dtype=arithmetic.point, device=device) for _ in range(3))
    scalars = (wp.zeros(count, dtype=wp.float64, device=device) for _ in range(2))
    return StructureState(*vectors, *scalars)


def allocate_scratch(
    options: StructureOptions, count: int, blocks: int, motions: int, device: Any
) -> StructureScratch:
    """Return zeroed scratch arrays; what the options leave out has a single entry.

    `motions` is the number of moving clamps and walls.
    """
    arithmetic = options.arithmetic
    matrix, real = arithmetic.matrix, arithmetic.real
    zeros: Callable[..., wp.array] = lambda shape, dtype: wp.zeros(shape, dtype=dtype, device=device)  # noqa: E731
    return StructureScratch(
        gradient=zeros(count, matrix),
        traction=zeros(count, matrix),
        stress=zeros(count if options.scattered else 1, matrix),
        contact_force=zeros(count if options.contact else 1, arithmetic.vector),
        fluid_force=zeros(count if options.immersed else 1, arithmetic.vector),
        extremes=zeros((max(blocks, 1), EXTREMES), wp.float64),
        load_factor=zeros((SUB_STEPS + 1, max(options.loads, 1)), wp.float64),
        prescriptions=zeros((SUB_STEPS + 1, max(motions, 1)), make_pose_struct(arithmetic)),
        energies=zeros((count, 2), wp.float64),
        cauchy=zeros(count, wp.types.matrix((3, 3), real)),
    )


class StructureModel:
    """The passes of all structures.

    Args:
        gravity: acceleration [m/s^2], one component a dimension.
        ranges: of particles by law; together they are all particles.
    """

    def __init__(
        self,
        launcher: Launcher,
        options: StructureOptions,
        ranges: Sequence[LawRange],
        gravity: Sequence[float],
        reference: StructureReference,
        state: StructureState,
        scratch: StructureScratch,
    ) -> None:
        self.launcher = launcher
        self.options = options
        self.ranges = tuple(ranges)
        self.gravity = tuple(gravity)
        self.reference, self.state, self.scratch = reference, state, scratch
        self.clock = wp.zeros(CLOCK_SIZE, dtype=wp.float64, device=launcher.device)
        self.count = sum(one.count for one in ranges)
        self._kernels = make_structure_kernels(options)
        self._drift, self._accelerate = self._bind_motion(options.arithmetic.vector(*gravity))
        self._tick = launcher.bind("structure time laws", self._kernels.tick, self.clock)
        self._strain = [self._bind_strain(one) for one in ranges]
        self._survey = self._bind_surveys()
        self._observe = [self._bind_observation(one) for one in ranges]

    @property
    def has_time_laws(self) -> bool:
        """Whether loads, clamps or walls change with time."""
        return self.options.loads > 0 or self.options.moving_clamps or self.options.moving_walls

    def drift(self) -> None:
        """Advance the velocity over half a step and the displacement over the whole."""
        self._drift.run(self.count)

    def strain(self) -> None:
        """Find the deformation gradient and the stress of every particle."""
        for one, bound in zip(self.ranges, self._strain, strict=True):
            bound.run(one.count)

    def accelerate(self) -> None:
        """Sum the forces, and advance the velocity over the second half of the step."""
        self._accelerate.run(self.count)

    def tick(self) -> None:
        """Let time laws go on by a step."""
        if self.has_time_laws:
            self._tick.run(1)

    def survey(self) -> None:
        """Find the extremes of the state."""
        for one, bound in zip(self.ranges, self._survey, strict=True):
            bound.run(one.blocks)

    def observe(self) -> None:
        """Find the energies and stresses of every particle."""
        for one, bound in zip(self.ranges, self._observe, strict=True):
            bound.run(one.count)

    def _bind_motion(self, gravity: Any) -> tuple[Pass, Pass]:
        r, s, t = self.reference, self.state, self.scratch
        drift = self.launcher.bind(
            "structure drift",
            self._kernels.drift,
            self.clock,
            r.materials,
            r.structure,
            r.volume,
            r.free,
            r.clamp,
            t.prescriptions,
            r.position,
            r.load,
            t.load_factor,
            t.fluid_force,
            s.acceleration,
            s.displacement,
            s.velocity,
            s.work,
        )
        accelerate = self.launcher.bind(
            "structure forces",
            self._kernels.accelerate,
            self.clock,
            gravity,
            r.materials,
            r.structure,
            r.neighbours,
            r.bonds,
            r.ends,
            r.penalty,
            t.traction,
            t.stress,
            r.own_gradient,
            r.other_gradient,
            s.displacement,
            r.volume,
            r.free,
            r.clamp,
            t.prescriptions,
            r.position,
            r.load,
            t.load_factor,
            t.contact_force,
            t.fluid_force,
            s.acceleration,
            s.velocity,
            s.work,
            s.dissipated,
        )
        return drift, accelerate

    def _bind_strain(self, one: LawRange) -> Pass:
        r, s, t = self.reference, self.state, self.scratch
        return self.launcher.bind(
            "structure stress",
            make_stress_kernel(self.options, one.law, one.plane_stress),
            one.first,
            r.materials,
            r.structure,
            r.neighbours,
            r.bonds,
            r.ends,
            r.correction,
            r.thin_normal,
            r.own_gradient,
            s.displacement,
            t.gradient,
            t.traction,
            t.stress,
        )

    def _bind_surveys(self) -> list[Pass]:
        r, s, t = self.reference, self.state, self.scratch
        passes, first_row = [], 0
        for one in self.ranges:
            kernel = make_survey_kernel(self.options, one.law, one.plane_stress)
            moving = (t.gradient, s.velocity, s.acceleration, t.extremes)
            place = (one.first, one.count, first_row, r.materials, r.structure, r.thin_normal)
            passes.append(self.launcher.bind("structure survey", kernel, *place, *moving))
            first_row += one.blocks
        return passes

    def _bind_observation(self, one: LawRange) -> Pass:
        r, s, t = self.reference, self.state, self.scratch
        return self.launcher.bind(
            "structure output",
            make_observation_kernel(self.options, one.law, one.plane_stress),
            one.first,
            r.materials,
            r.structure,
            r.volume,
            r.neighbours,
            r.bonds,
            r.ends,
            r.correction,
            r.thin_normal,
            s.displacement,
            t.gradient,
            t.traction,
            t.energies,
            t.cauchy,
        )
