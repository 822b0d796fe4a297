"""From a scene and its particles to the arrays, lists and models of a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import count

import numpy as np
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.clock import CLOCK_SIZE

from warpsph.laws.states import STATE_LAWS
from warpsph.particles.launch import Launcher, lanes_on
from warpsph.particles.neighbours import NeighbourSearch, Reordered, SearchSpace
from warpsph.particles.state import Layout, allocate_scratch, allocate_state, arrays_of, write_array
from warpsph.physics.assembly import Assembly, WallRange, WallSurface
from warpsph.physics.boundary import WallModel, make_wall_surface, no_slip_flags
from warpsph.physics.exchange import ExchangeModel
from warpsph.physics.fluid import (
    FluidModel,
    fluid_constants,
    material,
    select_code,
)
from warpsph.physics.mirrored_walls import MirroredWalls
from warpsph.physics.open_boundary import OpenBoundaryModel, spare_places
from warpsph.physics.sound_speed import choose_sound_speed
from warpsph.physics.symmetry import SymmetryModel, images_of
from warpsph.physics.wall_motion import PrescribedMotion
from warpsph.sampling import SampledSet
from warpsph.sampling.kinematics import largest_speed, rigid_motions
from warpsph.sampling.mirror import mirror_ways
from warpsph.sampling.patch_laws import expected_inflow
from warpsph.sampling.patches import EDGE_MARGIN
from warpsph.sampling.walls import period_of
from warpsph.scene.schema import Scene
from warpsph.scene.types import AXES
from warpsph.solver.face_assembly import FaceParts, SampledFaces, make_faces, sample_faces
from warpsph.solver.structure_assembly import StructureParts

FLUID = 0
"""Table of the fluid in the neighbour search."""


@dataclass(frozen=True)
class Tables:
    """Places of the other tables in the neighbour search, None where the scene needs no such table."""

    wall: int | None
    face: int | None
    image: int | None

    @classmethod
    def of(cls, layout: Layout) -> Tables:
        """The tables that a run has, numbered in the order of their declaration."""
        free = count(FLUID + 1)
        return cls(*(next(free) if size else None for size in (layout.walls, layout.faces, layout.images)))


@dataclass(frozen=True)
class WallParts:
    """Walls: what the fluid sees of them, and what moves them."""

    model: WallModel
    motion: PrescribedMotion


@dataclass(frozen=True)
class OpenParts:
    """Open boundaries: what they impose within a step, and their exchange of particles between steps."""

    model: OpenBoundaryModel
    exchange: ExchangeModel


@dataclass(frozen=True)
class Parts:
    """A run, assembled. `followers` are the arrays that each table takes along when it is sorted."""

    assembly: Assembly
    search: NeighbourSearch
    tables: Tables
    fluid: FluidModel
    walls: WallParts | None
    faces: FaceParts | None
    symmetry: SymmetryModel | None
    open_boundaries: OpenParts | None
    followers: Mapping[int, tuple[Reordered, ...]]

    @property
    def solids(self) -> tuple[WallModel, ...]:
        """What acts on the fluid as walls."""
        return tuple(parts.model for parts in (self.walls, self.faces) if parts)


def search_space(scene: Scene, sets: Sequence[SampledSet]) -> SearchSpace:
    """Return where particles are searched for: the period, else the box of all particles at the start."""
    dim = scene.dimension
    points = np.concatenate([s.position for s in sets])
    low, high = points.min(axis=0) - scene.spacing, points.max(axis=0) + scene.spacing
    periodic = [axis in scene.domain.periodic for axis in AXES[:dim]]
    for k, axis in enumerate(AXES[:dim]):
        if periodic[k]:
            low[k], high[k] = scene.domain.periodic[axis]
    box = scene.domain.kill_box
    far = np.full(dim, np.inf)
    return SearchSpace(
        low=low,
        high=high,
        periodic=tuple(periodic),
        kill_low=np.asarray(box.min) if box else -far,
        kill_high=np.asarray(box.max) if box else far,
    )


def assemble(
    scene: Scene,
    sets: Sequence[SampledSet],
    launcher: Launcher,
    structures: StructureParts | None = None,
    places: int | None = None,
) -> Parts:
    """Allocate everything that fluids and walls need and bind their passes; structures show the fluid their faces.

    `places` for fluid particles are as many as the start needs, with a margin where fluid may enter, if not given.
    Raises SceneError if structures are too thin for the fluid.
    """
    sampled = sample_faces(scene, structures) if structures else None
    assembly = _shared(scene, sets, sampled, launcher, places)
    layout, arithmetic = assembly.layout, assembly.options.arithmetic
    _fill_state(scene, sets, sampled, assembly)
    lanes = lanes_on(launcher.device, arithmetic.dimension)
    sides = wp.zeros(layout.faces + lanes, dtype=arithmetic.vector, device=launcher.device)
    tables = Tables.of(layout)
    search = _make_search(scene, assembly, tables, sides)
    surface = make_wall_surface(arithmetic, _no_slip(scene, sets, sampled), launcher.device)
    fluid = FluidModel(assembly, search.rows[FLUID], surface, scene)
    walls = _make_walls(scene, sets, assembly, search, tables, surface, fluid) if layout.walls else None
    faces = None
    if structures and sampled and tables.face is not None:
        part = surface.part(layout.walls, layout.faces)
        place = WallRange(layout.first_face, layout.faces, search.rows[tables.face], part)
        shared = (scene, sets, assembly, search, place)
        faces = make_faces(*shared, structures, sampled, sides, fluid.react)
    symmetry = SymmetryModel(scene, assembly, search, search.tables[-1]) if layout.images else None
    model = OpenBoundaryModel(scene, assembly, search, fluid) if scene.open_boundaries else None
    followers = _followers(assembly, search, tables, fluid, walls, faces, model)
    opened = _open_parts(scene, sets, assembly, search, model, followers[FLUID]) if model else None
    search.tables[FLUID].count = layout.fluids_at_start
    return Parts(assembly, search, tables, fluid, walls, faces, symmetry, opened, followers)


def _open_parts(
    scene: Scene,
    sets: Sequence[SampledSet],
    assembly: Assembly,
    search: NeighbourSearch,
    model: OpenBoundaryModel,
    followers: Sequence[Reordered],
) -> OpenParts:
    fluids = np.concatenate([s.position for s in sets if s.kind == "fluid"])
    model.tag_start(fluids, EDGE_MARGIN * scene.spacing)
    return OpenParts(model, ExchangeModel(assembly, search, model, followers, scene.spacing))


def _shared(
    scene: Scene,
    sets: Sequence[SampledSet],
    faces: SampledFaces | None,
    launcher: Launcher,
    places: int | None,
) -> Assembly:
    """What all models share."""
    arithmetic = Arithmetic(scene.dimension, scene.numerics.precision)
    layout = _layout(scene, sets, len(faces.owner) if faces else 0, places)
    space = search_space(scene, sets)
    driven = largest_speed(scene, sets) + (expected_inflow(scene) if scene.open_boundaries else 0.0)
    sound_speed = choose_sound_speed(scene, sets, driven)
    options = select_code(scene, arithmetic, space, layout.solids > 0, launcher.device)
    return Assembly(
        launcher=launcher,
        options=options,
        constants=fluid_constants(scene, options, space, sound_speed),
        space=space,
        layout=layout,
        state=allocate_state(arithmetic, layout, launcher.device),
        scratch=allocate_scratch(arithmetic, layout, launcher.device),
        clock=wp.zeros(CLOCK_SIZE, dtype=wp.float64, device=launcher.device),
        state_law=STATE_LAWS[options.state],
    )


def _layout(scene: Scene, sets: Sequence[SampledSet], faces: int, places: int | None) -> Layout:
    fluids = sum(len(s.position) for s in sets if s.kind == "fluid")
    walls = sum(len(s.position) for s in sets if s.kind == "boundary")
    spare = spare_places(scene, fluids) if places is None else places - fluids
    images = images_of(scene, fluids + spare)
    return Layout(fluids=fluids + spare + images, walls=walls, images=images, faces=faces, spare=spare)


def _make_walls(
    scene: Scene,
    sets: Sequence[SampledSet],
    assembly: Assembly,
    search: NeighbourSearch,
    tables: Tables,
    surface: WallSurface,
    fluid: FluidModel,
) -> WallParts:
    layout = assembly.layout
    assert tables.wall is not None
    part = surface.part(0, layout.walls)
    place = WallRange(layout.fluids, layout.walls, search.rows[tables.wall], part)
    motions = rigid_motions(scene)
    by_index = {k: motions[s.name] for k, s in enumerate(sets) if s.name in motions}
    motion = PrescribedMotion(assembly, place, by_index, len(sets))
    mirror = _mirrored_walls(scene, sets, assembly, search, motion)
    return WallParts(WallModel(assembly, place, "wall", fluid.react, mirror), motion)


def _mirrored_walls(
    scene: Scene,
    sets: Sequence[SampledSet],
    assembly: Assembly,
    search: NeighbourSearch,
    motion: PrescribedMotion,
) -> MirroredWalls | None:
    """The mirror points of the walls, where their method wants them."""
    if assembly.options.wall != "modified_dynamic":
        return None
    period, boundaries = period_of(scene), [s for s in sets if s.kind == "boundary"]
    ways = [mirror_ways(scene.boundaries[s.name], s.position, scene.spacing, period) for s in boundaries]
    return MirroredWalls(assembly, search, assembly.vectors(np.concatenate(ways)), motion.poses)


def _no_slip(scene: Scene, sets: Sequence[SampledSet], faces: SampledFaces | None) -> np.ndarray:
    boundaries = [s for s in sets if s.kind == "boundary"]
    flags = no_slip_flags(
        [scene.boundaries[s.name].slip == "no_slip" for s in boundaries],
        [len(s.position) for s in boundaries],
    )
    return np.concatenate([flags, faces.no_slip]) if faces else flags


def _make_search(scene: Scene, assembly: Assembly, tables: Tables, sides: wp.array) -> NeighbourSearch:
    layout, radius = assembly.layout, scene.support_radius
    ranges = [(0, layout.first_image)]
    solids = [table for table in (tables.wall, tables.face) if table is not None]
    if layout.walls:
        ranges.append((layout.fluids, layout.walls))
    if layout.faces:
        ranges.append((layout.first_face, layout.faces))
    if layout.images:
        ranges.append((layout.first_image, layout.images))
    fluid = [FLUID] if tables.image is None else [FLUID, tables.image]
    of_fluid = [fluid, solids] if solids else [fluid]
    return NeighbourSearch(
        assembly.launcher,
        assembly.options.arithmetic,
        assembly.space,
        ranges,
        [first == 0 for first, _ in ranges],
        [(FLUID, of_fluid), *((solid, [fluid]) for solid in solids)],
        radius=radius,
        skin=scene.numerics.list_skin * radius,
        spacing=scene.spacing,
        position=assembly.state.position,
        sides={} if tables.face is None else {tables.face: sides},
    )


def _fill_state(
    scene: Scene, sets: Sequence[SampledSet], faces: SampledFaces | None, assembly: Assembly
) -> None:
    """The initial state of fluids and walls; faces get their places and velocities from their owners later."""
    fluid = material(scene)
    state, c = assembly.state, assembly.constants
    shown = [s for s in sets if s.kind != "structure"]
    position = np.concatenate([s.position for s in shown])
    velocity = np.concatenate([s.velocity for s in shown])
    pressure = np.concatenate([s.pressure for s in shown])
    deviation = assembly.density_deviation(pressure)
    volume = float(c.mass) / (fluid.density + deviation)
    fields = {
        "position": position,
        "velocity_volume": np.column_stack([velocity, volume]),
        "density_deviation": deviation,
        "id": np.arange(len(position)),
        "set_index": np.repeat(np.arange(len(shown)), [len(s.position) for s in shown]),
    }
    layout = assembly.layout
    for name, values in fields.items():
        array = getattr(state, name)
        write_array(array, values[: layout.fluids_at_start])
        if layout.walls:
            write_array(array[layout.fluids :], values[layout.fluids_at_start :])
    if faces:
        write_array(state.set_index[layout.first_face :], faces.set_index)
        write_array(state.id[layout.first_face :], len(position) + faces.owner)


def _followers(
    assembly: Assembly,
    search: NeighbourSearch,
    tables: Tables,
    fluid: FluidModel,
    walls: WallParts | None,
    faces: FaceParts | None,
    opened: OpenBoundaryModel | None,
) -> dict[int, tuple[Reordered, ...]]:
    def follow(array: wp.array, table: int, first: int) -> Reordered:
        return Reordered(assembly.launcher, array, search.tables[table], first)

    state = [array for _, array in arrays_of(assembly.state)]
    records = [array for _, array in arrays_of(assembly.scratch)]
    of_fluid = {**fluid.own_arrays, **(opened.own_arrays if opened else {})}
    followers = {FLUID: [follow(array, FLUID, 0) for array in (*state, *of_fluid.values())]}
    if walls and tables.wall is not None:
        own = (*walls.model.own_arrays.values(), *walls.motion.own_arrays.values())
        shared = [follow(array, tables.wall, assembly.layout.fluids) for array in (*state, *records)]
        followers[tables.wall] = [*shared, *(follow(array, tables.wall, 0) for array in own)]
    if faces and tables.face is not None:
        own = (*faces.model.own_arrays.values(), *faces.faces.own_arrays.values())
        shared = [follow(array, tables.face, assembly.layout.first_face) for array in (*state, *records)]
        followers[tables.face] = [*shared, *(follow(array, tables.face, 0) for array in own)]
    return {table: tuple(arrays) for table, arrays in followers.items()}
