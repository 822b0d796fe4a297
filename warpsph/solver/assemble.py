"""From a scene and its particles to the arrays, lists and models of a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.clock import CLOCK_SIZE

from warpsph.laws.states import STATE_LAWS
from warpsph.particles.launch import Launcher
from warpsph.particles.neighbours import NeighbourSearch, Reordered, SearchSpace
from warpsph.particles.state import Layout, allocate_scratch, allocate_state, arrays_of, write_array
from warpsph.physics.assembly import Assembly, Lists
from warpsph.physics.boundary import WallModel, make_wall_surface, no_slip_flags
from warpsph.physics.fluid import (
    FluidModel,
    fluid_constants,
    material,
    select_code,
)
from warpsph.physics.mirrored_walls import MirroredWalls
from warpsph.physics.sound_speed import choose_sound_speed
from warpsph.physics.symmetry import SymmetryModel, images_of
from warpsph.sampling import SampledSet
from warpsph.sampling.kinematics import largest_speed, rigid_motions
from warpsph.sampling.mirror import mirror_ways
from warpsph.sampling.walls import period_of
from warpsph.scene.schema import Scene
from warpsph.scene.types import AXES

FLUID, WALL = 0, 1
"""Tables of the neighbour search."""


@dataclass(frozen=True)
class Parts:
    """A run, assembled."""

    assembly: Assembly
    search: NeighbourSearch
    fluid: FluidModel
    walls: WallModel | None
    symmetry: SymmetryModel | None
    fluid_arrays: tuple[Reordered, ...]
    wall_arrays: tuple[Reordered, ...]


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


def assemble(scene: Scene, sets: Sequence[SampledSet], launcher: Launcher) -> Parts:
    """Allocate everything that the scene needs and bind its passes."""
    arithmetic = Arithmetic(scene.dimension, scene.numerics.precision)
    layout = _layout(scene, sets)
    space = search_space(scene, sets)
    motions = rigid_motions(scene)
    sound_speed = choose_sound_speed(scene, sets, largest_speed(scene, sets))
    options = select_code(scene, arithmetic, space, has_walls=layout.walls > 0)
    assembly = Assembly(
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
    _fill_state(scene, sets, assembly)
    search = _make_search(scene, assembly)
    lists = Lists(fluid=search.rows[FLUID], wall=search.rows[WALL] if layout.walls else None)
    boundaries = [s for s in sets if s.kind == "boundary"]
    flags = no_slip_flags(
        [scene.boundaries[s.name].slip == "no_slip" for s in boundaries],
        [len(s.position) for s in boundaries],
    )
    surface = make_wall_surface(arithmetic, flags, launcher.device)
    fluid = FluidModel(assembly, lists, surface, scene)
    walls = None
    if layout.walls:
        mirror = _mirrored_walls(scene, boundaries, assembly, search)
        walls = WallModel(assembly, lists, _by_index(motions, sets), len(sets), surface, fluid.react, mirror)
    symmetry = SymmetryModel(scene, assembly, search, search.tables[-1]) if layout.images else None
    return Parts(assembly, search, fluid, walls, symmetry, *_reordered(assembly, search, fluid, walls))


def _layout(scene: Scene, sets: Sequence[SampledSet]) -> Layout:
    fluids = sum(len(s.position) for s in sets if s.kind == "fluid")
    walls = sum(len(s.position) for s in sets if s.kind == "boundary")
    images = images_of(scene, fluids)
    return Layout(fluids=fluids + images, walls=walls, images=images)


def _mirrored_walls(
    scene: Scene, boundaries: Sequence[SampledSet], assembly: Assembly, search: NeighbourSearch
) -> MirroredWalls | None:
    """The mirror points of the walls, where their method wants them."""
    if assembly.options.wall != "modified_dynamic":
        return None
    period = period_of(scene)
    ways = [mirror_ways(scene.boundaries[s.name], s.position, scene.spacing, period) for s in boundaries]
    return MirroredWalls(assembly, search, np.concatenate(ways))


def _by_index(motions: dict, sets: Sequence[SampledSet]) -> dict:
    return {k: motions[s.name] for k, s in enumerate(sets) if s.name in motions}


def _make_search(scene: Scene, assembly: Assembly) -> NeighbourSearch:
    layout, radius = assembly.layout, scene.support_radius
    ranges = [(0, layout.first_image)]
    walls: list[list[int]] = []
    if layout.walls:
        ranges.append((layout.fluids, layout.walls))
        walls = [[WALL]]
    fluid = [FLUID]
    if layout.images:
        fluid = [FLUID, len(ranges)]
        ranges.append((layout.first_image, layout.images))
    pairs = [(FLUID, [fluid, *walls]), *((WALL, [fluid]) for _ in walls)]
    return NeighbourSearch(
        assembly.launcher,
        assembly.options.arithmetic,
        assembly.space,
        ranges,
        [first == 0 for first, _ in ranges],
        pairs,
        radius=radius,
        skin=scene.numerics.skin * radius,
        spacing=scene.spacing,
        position=assembly.state.position,
    )


def _fill_state(scene: Scene, sets: Sequence[SampledSet], assembly: Assembly) -> None:
    fluid = material(scene)
    state, c = assembly.state, assembly.constants
    position = np.concatenate([s.position for s in sets])
    velocity = np.concatenate([s.velocity for s in sets])
    pressure = np.concatenate([s.pressure for s in sets])
    deviation = assembly.density_deviation(pressure)
    volume = float(c.mass) / (fluid.density + deviation)
    fields = {
        "position": position,
        "velocity_volume": np.column_stack([velocity, volume]),
        "density_deviation": deviation,
        "id": np.arange(len(position)),
        "set_index": np.repeat(np.arange(len(sets)), [len(s.position) for s in sets]),
    }
    layout = assembly.layout
    for name, values in fields.items():
        array = getattr(state, name)
        write_array(array, values[: layout.first_image])
        if layout.walls:
            write_array(array[layout.fluids :], values[layout.first_image :])


def _reordered(
    assembly: Assembly, search: NeighbourSearch, fluid: FluidModel, walls: WallModel | None
) -> tuple[tuple[Reordered, ...], tuple[Reordered, ...]]:
    def follow(array: wp.array, table: int, first: int) -> Reordered:
        return Reordered(assembly.launcher, array, search.tables[table], first)

    state = [array for _, array in arrays_of(assembly.state)]
    fluid_arrays = tuple(follow(array, FLUID, 0) for array in (*state, *fluid.own_arrays.values()))
    if walls is None:
        return fluid_arrays, ()
    records = [array for _, array in arrays_of(assembly.scratch)]
    shared = [follow(array, WALL, assembly.layout.fluids) for array in (*state, *records)]
    own = [follow(array, WALL, 0) for array in walls.own_arrays.values()]
    return fluid_arrays, (*shared, *own)
