"""From a scene and its particles to the arrays and passes of its structures."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.materials import make_material_struct
from warpsph_kernels.structure import StructureOptions

from warpsph.particles.bonds import Bonds
from warpsph.particles.consistency import Gradients
from warpsph.particles.launch import Launcher
from warpsph.particles.rows import row_array
from warpsph.particles.state import write_array
from warpsph.physics.structure import (
    LawRange,
    StructureModel,
    StructureReference,
    allocate_scratch,
    allocate_state,
)
from warpsph.sampling import SampledSet
from warpsph.sampling.clamps import onto_surface
from warpsph.sampling.initial_state import initial_field
from warpsph.sampling.kinematics import RigidMotion, rigid_motion, rigid_motions
from warpsph.sampling.loads import inside, specific_load
from warpsph.sampling.scene_lattices import lattices_of
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.schema import Scene
from warpsph.scene.structures import Load
from warpsph.scene.types import AXES
from warpsph.solver.bond_assembly import (
    bond_gradients,
    bond_radius,
    bonds_of,
    composites_of,
    unbonded_problems,
)
from warpsph.solver.contact_assembly import ContactParts, assemble_contact
from warpsph.solver.rigid_assembly import RigidParts, assemble_rigid, density_of


@dataclass(frozen=True)
class Body:
    """A structure of the scene and where its particles are: `first` .. `first + count - 1`.

    `position` (count, dim) [m] at rest is that of the sampled lattice, but for clamped particles at a surface.
    Structures that are bonded to each other have the same number `composite`.
    """

    name: str
    sampled: SampledSet
    first: int
    position: np.ndarray
    composite: int

    @property
    def count(self) -> int:
        return len(self.sampled.position)

    @property
    def range(self) -> slice:
        return slice(self.first, self.first + self.count)


@dataclass(frozen=True)
class HeldRegion:
    """A clamp with the indices of its particles; `motion` is None where it rests."""

    structure: str
    name: str
    particles: np.ndarray
    motion: RigidMotion | None


@dataclass(frozen=True)
class StructureParts:
    """Structures, assembled. `factors` are the time laws of the loads, expressions in t, in their order.

    `wall_motions` are those of the walls that structures may touch, by name.
    """

    model: StructureModel
    bodies: tuple[Body, ...]
    clamps: tuple[HeldRegion, ...]
    factors: tuple[str, ...]
    bonds: Bonds
    mass: np.ndarray
    contact: ContactParts | None
    wall_motions: Mapping[str, RigidMotion]
    rigid: RigidParts | None = None


def assemble_structures(scene: Scene, sets: Sequence[SampledSet], launcher: Launcher) -> StructureParts:
    """Allocate everything that the structures of the scene need and bind their passes. Raises SceneError."""
    arithmetic = Arithmetic(scene.dimension, scene.numerics.precision)
    bodies = _bodies(scene, sets)
    volume = np.concatenate([np.full(body.count, body.sampled.volume) for body in bodies])
    clamps = tuple(_clamps(scene, bodies))
    rigid = _rigid(scene, bodies, clamps, len(volume))
    rest = np.concatenate([body.position for body in bodies])
    composite = np.concatenate([np.full(body.count, body.composite) for body in bodies])
    problems = [*unbonded_problems(scene, {body.name: body.position for body in bodies})]
    if problems:
        raise SceneError(problems)
    bonds = bonds_of(scene, rest, composite, volume, rigid)
    ranges_of_bodies = [body.range for body in bodies]
    gradients = bond_gradients(scene, rest, composite, ranges_of_bodies, volume, rigid, bonds)
    density = np.concatenate([np.full(b.count, density_of(scene, b.sampled)) for b in bodies])
    mass = density * volume
    loads = list(_loads(scene, bodies))
    wall_motions = rigid_motions(scene) if scene.contact else {}
    options = _select_code(scene, clamps, len(loads), wall_motions, bonds, gradients)
    ranges = _law_ranges(scene, bodies)
    blocks = sum(one.blocks for one in ranges)
    moving = sum(clamp.motion is not None for clamp in clamps)
    motions = moving + len(wall_motions)
    device = launcher.device
    model = StructureModel(
        launcher,
        options,
        ranges,
        scene.gravity,
        _reference(
            scene,
            arithmetic,
            bodies,
            bonds,
            gradients,
            volume,
            rigid,
            clamps,
            [load for _, load in loads],
            device,
        ),
        allocate_state(arithmetic, len(volume), device),
        allocate_scratch(options, len(volume), blocks, motions, device),
    )
    _fill_state(scene, bodies, clamps, model)
    contact = None
    if scene.contact is not None:
        columns = {name: moving + k for k, name in enumerate(wall_motions)}
        ordered = [(body.sampled, body.composite) for body in bodies]
        contact = assemble_contact(scene, sets, ordered, mass, columns, model, bond_radius(scene), launcher)
    factors = tuple(spec.factor for spec, _ in loads)
    among = assemble_rigid(scene, [(body.first, body.sampled) for body in bodies], model, launcher)
    return StructureParts(model, bodies, clamps, factors, bonds, mass, contact, wall_motions, among)


def _select_code(
    scene: Scene,
    clamps: Sequence[HeldRegion],
    loads: int,
    wall_motions: Mapping[str, RigidMotion],
    bonds: Bonds,
    gradients: Gradients | None,
) -> StructureOptions:
    """The options that select device code."""
    return StructureOptions(
        arithmetic=Arithmetic(scene.dimension, scene.numerics.precision),
        moving_clamps=any(clamp.motion for clamp in clamps),
        loads=loads,
        damped=any(s.damping > 0.0 for s in scene.structures.values()) or is_static(scene),
        contact=scene.contact is not None,
        immersed=bool(scene.fluids),
        moving_walls=bool(wall_motions),
        thin=bool(bonds.thin.any()),
        scattered=gradients is not None,
        bonded=bool(scene.bonds),
    )


def is_static(scene: Scene) -> bool:
    """Whether the scene asks for equilibria instead of motion."""
    return scene.numerics.structure.solution.type == "static"


def _bodies(scene: Scene, sets: Sequence[SampledSet]) -> tuple[Body, ...]:
    """Structures with those of one law side by side, otherwise in the order of the scene."""
    bodies, first = [], 0
    ordered = sorted(
        (s for s in sets if s.kind == "structure"), key=lambda sampled: _code_of(scene, sampled.name)
    )
    for sampled in ordered:
        composite = composites_of(scene)[sampled.name]
        bodies.append(Body(sampled.name, sampled, first, _rest_position(scene, sampled), composite))
        first += len(sampled.position)
    return tuple(bodies)


def _rest_position(scene: Scene, sampled: SampledSet) -> np.ndarray:
    """Positions (n, dim) [m] with the particles at the surface of whole clamps on that surface."""
    position = sampled.position
    for clamp in scene.structures[sampled.name].clamps.values():
        if clamp.is_whole:
            chosen = inside(clamp.region, sampled.position, scene.spacing)
            position = onto_surface(clamp.region, position, chosen, scene.spacing)
    return position


def _code_of(scene: Scene, name: str) -> tuple[str, bool]:
    """Law and plane state; of rigid bodies that law has no effect but to show no stress in a rotation."""
    structure = scene.structures[name]
    if structure.rigid is not None:
        return "st_venant_kirchhoff", False
    return structure.material.law, structure.plane == "stress"


def _law_ranges(scene: Scene, bodies: Sequence[Body]) -> list[LawRange]:
    ranges = []
    for (law, plane_stress), group in groupby(bodies, key=lambda body: _code_of(scene, body.name)):
        members = list(group)
        ranges.append(LawRange(law, plane_stress, members[0].first, sum(body.count for body in members)))
    return ranges


def _clamps(scene: Scene, bodies: Sequence[Body]) -> Iterator[HeldRegion]:
    for body in bodies:
        for name, clamp in scene.structures[body.name].clamps.items():
            chosen = inside(clamp.region, body.sampled.position, scene.spacing)
            key = f"structures.{body.name}.clamps.{name}"
            if not chosen.any():
                message = "no particle of the structure lies there"
                allowed = "a shape that reaches into the structure"
                raise SceneError([Problem.at(f"{key}.region", message, allowed)])
            motion = rigid_motion(scene, clamp.motion, f"{key}.motion") if clamp.motion else None
            yield HeldRegion(body.name, name, body.first + np.flatnonzero(chosen), motion)


def _loads(scene: Scene, bodies: Sequence[Body]) -> Iterator[tuple[Load, tuple[Body, np.ndarray]]]:
    """Every load with its body and its force per mass on the particles of that body."""
    lattices = lattices_of(scene)
    for body in bodies:
        structure = scene.structures[body.name]
        mass = density_of(scene, body.sampled) * body.sampled.volume
        for name, load in structure.loads.items():
            key = f"structures.{body.name}.loads.{name}"
            place = (structure.shape, body.sampled.position, mass, lattices[body.name], key)
            yield load, (body, specific_load(load, *place))


def _reference(
    scene: Scene,
    arithmetic: Arithmetic,
    bodies: Sequence[Body],
    bonds: Bonds,
    gradients: Gradients | None,
    volume: np.ndarray,
    rigid: np.ndarray,
    clamps: Sequence[HeldRegion],
    loads: Sequence[tuple[Body, np.ndarray]],
    device: Any,
) -> StructureReference:
    count, dim = len(volume), scene.dimension
    free, clamp_index = _constraints(scene, bodies, clamps, count)
    table = np.zeros((max(len(loads), 1), count if loads else 1, dim))
    for row, (body, specific) in enumerate(loads):
        table[row, body.range] = specific
    materials = [_material(scene, arithmetic, body.sampled) for body in bodies]
    owner = np.repeat(np.arange(len(bodies)), [body.count for body in bodies])
    nothing = np.zeros((1, 1, dim))
    bond_records = np.concatenate([bonds.vector, bonds.weight[..., None]], axis=2)

    def array(values: np.ndarray, dtype: Any) -> wp.array:
        return wp.array(np.ascontiguousarray(values), dtype=dtype, device=device)

    return StructureReference(
        position=array(np.concatenate([body.position for body in bodies]), arithmetic.point),
        volume=array(volume, arithmetic.real),
        structure=array(owner, wp.int32),
        materials=wp.array(materials, dtype=make_material_struct(arithmetic), device=device),
        neighbours=row_array(bonds.neighbour, wp.int32, device),
        bonds=row_array(bond_records, arithmetic.record, device),
        ends=wp.array(np.ascontiguousarray(bonds.ends), dtype=wp.int32, ndim=2, device=device),
        penalty=array(_penalty(scene, bodies, rigid) if scene.bonds else np.zeros(1), arithmetic.real),
        correction=array(bonds.correction, arithmetic.matrix),
        thin_normal=array(np.column_stack([bonds.normal, bonds.seen]), arithmetic.record),
        free=array(free, arithmetic.vector),
        clamp=array(clamp_index, wp.int32),
        load=array(table, arithmetic.vector),
        own_gradient=row_array(gradients.own if gradients else nothing, arithmetic.vector, device),
        other_gradient=row_array(gradients.other if gradients else nothing, arithmetic.vector, device),
    )


def _material(scene: Scene, arithmetic: Arithmetic, sampled: SampledSet) -> Any:
    structure = scene.structures[sampled.name]
    material, numbers = structure.material, make_material_struct(arithmetic)()
    numbers.lame, numbers.shear_modulus = material.lame, material.shear_modulus
    numbers.bulk_modulus = material.lame + 2.0 / 3.0 * material.shear_modulus
    numbers.density = density_of(scene, sampled)
    numbers.penalty = scene.numerics.structure.hourglass * material.youngs_modulus
    numbers.damping = structure.damping
    return numbers


def _penalty(scene: Scene, bodies: Sequence[Body], rigid: np.ndarray) -> np.ndarray:
    """Stiffness of each particle's penalty (n,) [Pa], which is zero of rigid ones."""
    moduli = [scene.structures[body.name].material.youngs_modulus for body in bodies]
    return scene.numerics.structure.hourglass * np.repeat(moduli, [body.count for body in bodies]) * ~rigid


def _rigid(scene: Scene, bodies: Sequence[Body], clamps: Sequence[HeldRegion], count: int) -> np.ndarray:
    """Whether each particle belongs to a rigid body, or a clamp prescribes all its components, shape (n,)."""
    rigid = np.zeros(count, dtype=bool)
    for body in bodies:
        rigid[body.range] = scene.structures[body.name].rigid is not None
    for clamp in clamps:
        if scene.structures[clamp.structure].clamps[clamp.name].is_whole:
            rigid[clamp.particles] = True
    return rigid


def _constraints(
    scene: Scene, bodies: Sequence[Body], clamps: Sequence[HeldRegion], count: int
) -> tuple[np.ndarray, np.ndarray]:
    """Mask of free components (n, dim), and the index (n,) of each particle's moving clamp, -1 without one.

    Where clamps overlap the later one in the scene moves the particle. A rigid body moves its particles itself.
    """
    free, index = np.ones((count, scene.dimension)), np.full(count, -1)
    for body in bodies:
        if scene.structures[body.name].rigid is not None:
            free[body.range] = 0.0
    moving = [clamp for clamp in clamps if clamp.motion is not None]
    for clamp in clamps:
        axes = scene.structures[clamp.structure].clamps[clamp.name].axes
        held = [AXES.index(axis) for axis in axes or AXES[: scene.dimension]]
        free[clamp.particles[:, None], held] = 0.0
        if clamp.motion is not None:
            index[clamp.particles] = moving.index(clamp)
    return free, index


def _fill_state(
    scene: Scene, bodies: Sequence[Body], clamps: Sequence[HeldRegion], model: StructureModel
) -> None:
    """Initial displacement and velocity; clamped components begin at rest or as their clamp moves at time zero."""
    free = model.reference.free.numpy()
    shifts = [
        initial_field(
            scene.structures[b.name].displacement, b.sampled.position, f"structures.{b.name}.displacement"
        )
        for b in bodies
    ]
    displacement = np.concatenate(shifts) * free
    velocity = np.concatenate([b.sampled.velocity for b in bodies]) * free
    rest = np.concatenate([b.position for b in bodies])
    for clamp in clamps:
        if clamp.motion is not None:
            pose, held = clamp.motion(0.0), clamp.particles
            points, prescribed = rest[held], 1.0 - free[held]
            displacement[held] += prescribed * (pose.position_of(points) - points)
            velocity[held] += prescribed * pose.velocity_of(points)
    write_array(model.state.displacement, displacement)
    write_array(model.state.velocity, velocity)
