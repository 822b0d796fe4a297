"""Contact of structures: the arrays of a run, the lists of what may touch, and the passes over them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import warp as wp
from scipy.spatial import cKDTree
from warpsph_kernels.contact import ContactOptions, make_contact_kernels, make_contact_struct
from warpsph_kernels.smoothing import SMOOTHING_KERNELS

from warpsph.laws.smoothing import SMOOTHING_LAWS
from warpsph.particles.launch import Launcher
from warpsph.particles.rows import row_array
from warpsph.particles.state import host_view, write_array
from warpsph.physics.structure import StructureModel

WENDLAND_C2 = SMOOTHING_KERNELS["wendland_c2"]
H_OVER_DP = 1.5
"""Smoothing length of contact over the spacing [1]. A lattice that slides on another feels a force along the surface
of at most 0.3 % of that across it for penetrations up to a third of the spacing; at 1.0 it is 3 %, and 58 % for a
repulsion of pairs that ends at the spacing. The stiffness varies by 4 % over the same penetrations."""
SKIN = 1.0
"""Reach of the lists beyond the range of contact, in spacings."""
LEEWAY = 8.0
"""Distance beyond the reach of the lists, in spacings, up to which particles of walls are looked at."""
FIRST_CAPACITY = 16
GROWTH = 1.3
GRID_CELLS = {2: (128, 128, 1), 3: (64, 64, 64)}
MEMORY = ("slip", "normal")
"""Arrays of contact that evolve."""

UNITS = {
    "contact_near": "1",
    "contact_owner": "1",
    "contact_body": "1",
    "contact_rest": "m",
    "contact_position": "m",
    "contact_velocity": "m/s",
    "contact_nearness": "1",
    "contact_pressure": "J",
    "contact_drag": "N",
    "contact_slip": "m",
    "contact_normal": "1",
    "contact_heat": "J",
    "contact_energy": "J",
    "contact_rows": "1",
    "contact_counts": "1",
    "contact_places": "m",
    "contact_wall_force": "N",
}


@dataclass(frozen=True)
class ContactSurface:
    """The contact particles (m), those of structures before those of walls.

    owner: (m,) particle of the structures, of a wall the column of its motion among the prescriptions or -1;
    body: (m,) number of the body, -1 for a wall; rest: (m, dim) where they are at rest [m];
    bodies: how many belong to structures.
    """

    owner: np.ndarray
    body: np.ndarray
    rest: np.ndarray
    bodies: int


@dataclass(frozen=True)
class PenaltyLaw:
    """Numbers of the penalty (see the kernels).

    spacing [m]; threshold: c_0 [1]; steepness: -dp dc/dx before a flat surface at the threshold [1];
    stiffness: K [J]; friction: Coulomb's coefficient [1]; stick: k of each particle [N/m];
    exclusion: distance at rest up to which a structure does not touch itself [m].
    """

    spacing: float
    threshold: float
    steepness: float
    stiffness: float
    friction: float
    stick: float
    exclusion: float

    def depth(self, nearness: float) -> float:
        """Penetration [m] of a flat surface at which a particle has this c_a."""
        return max(nearness - self.threshold, 0.0) / self.steepness * self.spacing


def penalty_law(
    dimension: int, spacing: float, spring: float, friction: float, bond_radius: float
) -> PenaltyLaw:
    """The penalty whose two flat surfaces repel each other by `spring` [N/m] a pair of opposite particles."""
    nearness = _flat_nearness(dimension)
    step = 1e-4
    steepness = (nearness(1.0 - step) - nearness(1.0 + step)) / (2.0 * step)
    support = WENDLAND_C2.support * H_OVER_DP
    return PenaltyLaw(
        spacing=spacing,
        threshold=nearness(1.0),
        steepness=steepness,
        stiffness=0.5 * spring * spacing**2 / steepness**2,
        friction=friction,
        stick=0.5 * spring,
        exclusion=1.001 * max(bond_radius, support * spacing),
    )


def _flat_nearness(dimension: int) -> Callable[[float], float]:
    """c as a function of the distance [spacings] of a particle from a flat lattice row (2D) or layer (3D)."""
    smoothing = SMOOTHING_LAWS["wendland_c2"]
    reach = math.ceil(smoothing.support * H_OVER_DP)
    ticks = np.arange(-reach, reach + 1, dtype=float)
    along = np.stack(np.meshgrid(*[ticks] * (dimension - 1)), axis=-1).reshape(-1, dimension - 1)

    def nearness(distance: float) -> float:
        q = np.sqrt(distance**2 + (along**2).sum(axis=1)) / H_OVER_DP
        return float(np.sum(smoothing.value(q, dimension))) / H_OVER_DP**dimension

    return nearness


@dataclass(frozen=True)
class ContactArrays:
    """Arrays of contact particles; the lists stand apart, since they may grow."""

    near: wp.array
    owner: wp.array
    body: wp.array
    rest: wp.array
    position: wp.array
    velocity: wp.array
    nearness: wp.array
    pressure: wp.array
    drag: wp.array
    slip: wp.array
    normal: wp.array
    heat: wp.array
    energy: wp.array
    counts: wp.array
    places: wp.array
    wall_force: wp.array


class ContactModel:
    """The passes of contact beside those of the structures.

    Args:
        surface: what may touch.
        law: how it repels.
    """

    def __init__(
        self,
        launcher: Launcher,
        options: ContactOptions,
        structures: StructureModel,
        surface: ContactSurface,
        law: PenaltyLaw,
    ) -> None:
        self.options, self.law, self.surface = options, law, surface
        self.count, self.bodies = len(surface.owner), surface.bodies
        self.builds = 0
        self.touches = False
        """Whether any pair is listed."""
        self._launcher, self._structures = launcher, structures
        self._kernels = make_contact_kernels(options)
        self._numbers = self._describe()
        self.arrays = self._allocate(surface)
        self.near = np.arange(self.count)
        """Contact particles of structures, and of walls those that the lists have to look at."""
        self.moving_walls_near = True
        """Whether particles of a wall that moves are among them."""
        self.listed = surface.rest
        """Where the near ones were when the lists were made last (near, dim) [m]."""
        dim = options.arithmetic.dimension
        self._grid = wp.HashGrid(*GRID_CELLS[dim], device=launcher.device)
        self._origin = options.arithmetic.point(*surface.rest.mean(axis=0))
        self._place = self._bind_place()
        self._make_rows(FIRST_CAPACITY)

    @property
    def skin(self) -> float:
        """Reach of the lists beyond the range of contact [m]."""
        return SKIN * self.law.spacing

    @property
    def leeway(self) -> float:
        """How far a wall that is not near is from what the lists reach, when near ones are chosen [m]."""
        return LEEWAY * self.law.spacing

    def choose_near(self) -> None:
        """Leave out of the lists the particles of walls that no structure can touch before it has moved a while."""
        self._look_at(np.arange(self.count))
        self.place()
        far = float(self._numbers.reach) + self.leeway
        position = host_view(self.arrays.position)
        structures, walls = position[: self.bodies], position[self.bodies :]
        finite = np.isfinite(structures).all(axis=1)  # a run that diverges is stopped elsewhere
        distance, _ = cKDTree(structures[finite]).query(walls, distance_upper_bound=far)
        near_walls = self.bodies + np.flatnonzero(np.isfinite(distance))
        self._look_at(np.concatenate([np.arange(self.bodies), near_walls]))
        self.arrays.counts.zero_()

    def list_pairs(self) -> None:
        """List what may touch among the near ones, from where they were placed last."""
        near = len(self.near)
        self.listed = host_view(self.arrays.position)[self.near]
        self._spread.run(near)
        self._grid.build(self.arrays.places[:near], float(self._numbers.reach))
        self._list.run(near)
        longest = int(host_view(self.arrays.counts).max(initial=0))
        if longest > self.rows.shape[1]:
            self._make_rows(math.ceil(GROWTH * longest))
            self._list.run(near)
        self.touches = longest > 0
        self.builds += 1
        if not self.touches:
            self._part()

    def list_again(self, near: np.ndarray, listed: np.ndarray) -> None:
        """Make the lists that were made when these were `near`, and where `listed` says."""
        self._look_at(near)
        places = np.array(host_view(self.arrays.position))
        places[near] = listed
        write_array(self.arrays.position, places)
        self.list_pairs()

    def place(self) -> None:
        """Bring near contact particles to where their owners are."""
        self._place.run(len(self.near))

    def push(self) -> None:
        """Find the forces of contact on structures, if anything is near enough."""
        if self.touches:
            self.place()
            self._sense.run(len(self.near))
            self._push.run(self.bodies)

    def sense(self) -> None:
        """Find how near foreign surfaces are, and no forces."""
        if self.touches:
            self.place()
            self._sense.run(len(self.near))

    def energy(self) -> np.ndarray:
        """Energy of contact (n,) [J] of all particles of structures, at the last forces.

        It is that of the penalty and of the springs of friction; that of walls counts with what touches them.
        """
        self._observe.run(self.bodies)
        energy = np.zeros(self._structures.count)
        energy[self.surface.owner[: self.bodies]] = host_view(self.arrays.energy)
        return energy

    def memory(self) -> dict[str, np.ndarray]:
        """What friction remembers: slip (m, dim) [m] and normal (m, dim); single rows without friction."""
        return {name: np.array(host_view(getattr(self.arrays, name))) for name in MEMORY}

    def remember(self, memory: Mapping[str, np.ndarray]) -> None:
        """Go back to what `memory` returned."""
        for name in MEMORY:
            write_array(getattr(self.arrays, name), memory[name])

    def depth(self) -> float:
        """Deepest penetration [m] at the last forces."""
        return self.law.depth(float(host_view(self.arrays.nearness).max(initial=0.0)))

    def wall_force(self) -> np.ndarray:
        """Forces (walls, dim) [N] on the contact particles of walls."""
        walls = self.count - self.bodies
        self._react.run(walls)
        return host_view(self.arrays.wall_force).astype(np.float64)[:walls]

    def named_arrays(self) -> dict[str, wp.array]:
        """Name and array of everything that contact stores."""
        arrays = {f"contact_{m.name}": getattr(self.arrays, m.name) for m in fields(self.arrays)}
        return arrays | {"contact_rows": self.rows}

    def _look_at(self, near: np.ndarray) -> None:
        self.near = near
        self.moving_walls_near = bool((self.surface.owner[near[self.bodies :]] >= 0).any())
        write_array(self.arrays.near, near)

    def _part(self) -> None:
        """Nothing touches: leave no force and no energy behind."""
        self._sense.run(len(self.near))
        self._push.run(self.bodies)

    def _describe(self) -> Any:
        law, dim = self.law, self.options.arithmetic.dimension
        h = H_OVER_DP * law.spacing
        numbers = make_contact_struct(self.options.arithmetic)()
        numbers.inverse_h = 1.0 / h
        numbers.norm = WENDLAND_C2.norm(dim, H_OVER_DP)
        numbers.slope_norm = WENDLAND_C2.norm(dim, H_OVER_DP) / h**2
        numbers.threshold, numbers.stiffness, numbers.friction = law.threshold, law.stiffness, law.friction
        numbers.reach = WENDLAND_C2.support * h + self.skin
        numbers.stick = law.stick
        numbers.exclusion, numbers.bodies = law.exclusion, self.bodies
        return numbers

    def _allocate(self, surface: ContactSurface) -> ContactArrays:
        arithmetic, device, count = self.options.arithmetic, self._launcher.device, self.count
        vector, point, real = arithmetic.vector, arithmetic.point, arithmetic.real

        def array(values: np.ndarray, dtype: Any) -> wp.array:
            return wp.array(np.ascontiguousarray(values), dtype=dtype, device=device)

        def zeros(length: int, dtype: Any) -> wp.array:
            return wp.zeros(max(length, 1), dtype=dtype, device=device)

        rubbing = count if self.options.friction else 1
        return ContactArrays(
            near=array(np.arange(count), wp.int32),
            owner=array(surface.owner, wp.int32),
            body=array(surface.body, wp.int32),
            rest=array(surface.rest, point),
            position=array(surface.rest, point),
            velocity=zeros(count, point),
            nearness=zeros(count, real),
            pressure=zeros(count, real),
            drag=zeros(rubbing, vector),
            slip=zeros(rubbing, vector),
            normal=zeros(rubbing, vector),
            heat=zeros(rubbing, real),
            energy=zeros(self.bodies, wp.float64),
            counts=zeros(count, wp.int32),
            places=zeros(count, wp.vec3),
            wall_force=zeros(count - self.bodies, vector),
        )

    def _make_rows(self, capacity: int) -> None:
        """Allocate rows of the lists, and bind the passes that read them."""
        table = np.zeros((self.count, capacity), dtype=np.int32)
        self.rows = row_array(table, wp.int32, self._launcher.device)
        self._bind_lists()
        self._bind_forces()

    def _bind_place(self) -> Any:
        a, structures = self.arrays, self._structures
        return self._launcher.bind(
            "contact places",
            self._kernels.place,
            self._numbers,
            structures.clock,
            a.near,
            a.owner,
            a.rest,
            structures.scratch.prescriptions,
            structures.state.displacement,
            structures.state.velocity,
            a.position,
            a.velocity,
        )

    def _bind_lists(self) -> None:
        a = self.arrays
        self._spread = self._launcher.bind(
            "contact lists", self._kernels.spread, self._origin, a.near, a.position, a.places
        )
        self._list = self._launcher.bind(
            "contact lists",
            self._kernels.list_pairs,
            wp.uint64(self._grid.id),
            self._numbers,
            a.near,
            a.places,
            a.position,
            a.rest,
            a.body,
            self.rows,
            a.counts,
        )

    def _bind_forces(self) -> None:
        a, structures = self.arrays, self._structures
        state, force = structures.state, structures.scratch.contact_force
        bind, kernels, p, clock = self._launcher.bind, self._kernels, self._numbers, structures.clock
        pairs, felt = (self.rows, a.counts), (a.pressure, a.drag)
        moving = (a.position, a.velocity, *pairs, a.nearness, *felt)
        self._sense = bind(
            "contact sensing", kernels.sense, p, clock, a.near, *moving, a.slip, a.normal, a.heat
        )
        told = (a.heat, force, state.work, state.dissipated)
        self._push = bind("contact forces", kernels.push, p, clock, a.owner, a.body, *moving, *told)
        self._react = bind("contact forces", kernels.react, p, a.position, *pairs, *felt, a.wall_force)
        shown = (a.body, a.position, *pairs, a.nearness, a.slip, a.energy)
        self._observe = bind("contact forces", kernels.observe, p, *shown)
