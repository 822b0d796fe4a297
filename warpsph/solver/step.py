"""One step of the scheme, as a page of verbs.

Position Verlet with the density staggered against the velocity (Zhang, Rezavand & Hu 2020): of second
order, reversible for sound waves, and with one force sum and one continuity sum a step.
"""

from __future__ import annotations

import math

import numpy as np
import warp as wp
from warpsph_kernels import clock as clock_kernels
from warpsph_kernels.clock import BLOCK, LIMITS, StepLimits, make_clock_kernels

from warpsph.particles.launch import Pass
from warpsph.particles.state import host_view, write_array
from warpsph.physics.faces import NOW
from warpsph.physics.fluid import material, padded, smoothing_length, step_viscosity
from warpsph.scene.schema import Scene
from warpsph.solver.assemble import FLUID, Parts, WallParts
from warpsph.solver.system import StepReport

NO_LIMIT = 1.0e30


class Stepper:
    """Advances the parts of a run."""

    def __init__(self, scene: Scene, parts: Parts) -> None:
        self._fluid, self._walls, self._faces = parts.fluid, parts.walls, parts.faces
        self._solids, self._search = parts.solids, parts.search
        self._symmetry, self._open = parts.symmetry, parts.open_boundaries
        self._parts = parts
        self._clock = parts.assembly.clock
        self._spacing = scene.spacing
        self.removed = 0
        self._bind_clock(scene)

    def start(self, time: float = 0.0) -> None:
        """Place walls, make the first lists, and find the density rate of the initial velocity."""
        self.set_clock(TIME=time, STEP=0.0, TARGET=math.inf)
        self.place_solids(time)
        self.take_positions(all_tables=True)
        self.make_lists(all_tables=True)
        self._fluid.synchronise()
        self.impose_open_boundaries(0.0)
        self.mirror_pressure()
        if self._walls:
            self.find_wall_surface(self._walls)
        self.place_solids(time)
        for solid in self._solids:
            solid.start()
        self.synchronise()
        self.find_densities()

    def place_solids(self, time: float) -> None:
        """Place walls for a time [s], and faces where their structures are."""
        if self._walls:
            self._walls.motion.place(time)
        if self._faces:
            self._faces.faces.place(NOW)

    def find_wall_surface(self, walls: WallParts) -> None:
        """Find the normals that keep fluid out of the walls, and along which it shears them."""
        table, options = self._parts.tables.wall, self._parts.assembly.options
        if (options.has_barrier or options.wall_friction) and table is not None:
            rows = self._search.list_once(table, table)
            walls.motion.find_surface(rows, self._search.listed_position, self._spacing)

    def resume(self, clock: np.ndarray) -> None:
        """Go on from a restored state with the lists, the order and the survey that it had."""
        write_array(self._clock, clock)
        self._host_clock = host_view(self._clock)
        self.place_solids(self.time)
        self.forget_removed()
        self.make_lists(all_tables=True)
        self.synchronise()
        self.survey()

    def step(self) -> StepReport:
        """Advance by one variable step."""
        report = self.choose_step()
        self.keep_lists(report.dt)
        self.move_walls(self.time - 0.5 * report.dt)
        self.find_forces()
        self.advance()
        self.move_walls(self.time)
        self.find_densities()
        return report

    def find_forces(self) -> None:
        """Drift over half a step, and sum the forces there."""
        self._fluid.begin_step()
        self.impose_open_boundaries(self._read(clock_kernels.STEP))
        self.mirror_pressure()
        self.impose_walls()
        self._fluid.accelerate()
        if self._open:
            self._open.model.hold_motion()

    def advance(self) -> None:
        """Kick over the whole step, and drift over its second half."""
        self._fluid.kick_and_drift()
        self.mirror_density()

    def find_densities(self) -> None:
        """Find density rates at the end of the step, densities with them, and the extremes of the state."""
        self._fluid.update_density()
        if self._open:
            self._open.model.hold_density()
            self._open.model.grow_older()
        self.update_wall_density()
        self.survey()

    def choose_step(self) -> StepReport:
        """Let the device choose the step from the survey of the state, and read it."""
        self._choose.run(1)
        self._host_clock = host_view(self._clock)
        ruling = LIMITS[int(self._host_clock[clock_kernels.RULING])]
        return StepReport(dt=self._read(clock_kernels.STEP), limit=ruling)

    def survey(self) -> None:
        """Find the extremes of the state."""
        self._survey_fluid.run(self._fluid_blocks)
        if self._walls and self._walls.motion.moving:
            self._survey_walls.run(self._wall_blocks)
        if self._faces:
            self._survey_faces.run(self._face_blocks)

    def mirror_pressure(self) -> None:
        """Show the fluid its images with their pressures."""
        if self._symmetry:
            self._symmetry.mirror_pressure()

    def mirror_density(self) -> None:
        """Show the fluid its images with their densities."""
        if self._symmetry:
            self._symmetry.mirror_density()

    def impose_open_boundaries(self, dt: float) -> None:
        """Give fluid behind open boundaries its velocity at the end of a step [s] and its pressure in the middle."""
        if self._open:
            self._open.model.impose(self.time, self.time - 0.5 * dt)

    def move_walls(self, time: float) -> None:
        """Place walls that move as prescribed for a time [s]."""
        if self._walls:
            self._walls.motion.move(time)

    def impose_walls(self) -> None:
        """Set what the fluid sees at walls and structures."""
        for solid in self._solids:
            solid.impose()

    def update_wall_density(self) -> None:
        """Advance the density of walls and structures that have one."""
        for solid in self._solids:
            solid.update_density()

    def keep_lists(self, dt: float) -> None:
        """Make new neighbour lists if the present ones do not last for the step [s]."""
        if self.lists_expire(dt):
            self.renew_lists()

    def lists_expire(self, dt: float) -> bool:
        """Tell whether a particle may outrun the neighbour lists within the step."""
        reach = self._read(clock_kernels.SPEED) + self._read(clock_kernels.ACCELERATION) * dt
        displacement = self._read(clock_kernels.DISPLACEMENT) + self._fluid.largest_shift
        return self._search.must_rebuild(displacement, reach, dt)

    def renew_lists(self) -> None:
        """Sort the particles and list their neighbours anew."""
        if self._symmetry:
            self._symmetry.reflect()
        self.take_positions()
        if self._open:
            self._open.exchange.run()
        self.make_lists(exchanged=self._open is not None)

    def take_positions(self, all_tables: bool = False) -> None:
        """Note the positions, and the sides of structures, from which the next lists are made."""
        self._search.take_positions(self._moving_tables(all_tables))
        if self._faces:
            self._faces.faces.turn_sides()

    def make_lists(self, all_tables: bool = False, exchanged: bool = False) -> None:
        """Sort and list from the positions last taken; fluid may have been `exchanged` at open boundaries."""
        moving = self._moving_tables(all_tables)
        capacities = [rows.capacity for rows in self._search.rows]
        before = self._fluid.count
        remove = self._open.exchange.mark_removed if self._open and exchanged else None
        self.removed += self._search.sort(FLUID, self._parts.followers[FLUID], remove)
        if self._open:
            self._open.model.list_tagged()
        if exchanged or self._fluid.count < before:
            self.forget_removed()
        for table in (self._parts.tables.wall, self._parts.tables.face):
            if table is not None and moving[table]:
                self._search.sort(table, self._parts.followers[table])
        if self._faces:
            self._faces.faces.find_places()
        if self._symmetry:
            self._symmetry.make_images()
        self._search.list_neighbours()
        if self._faces:
            self._faces.faces.look_for_fluid()
        if capacities != [rows.capacity for rows in self._search.rows]:
            self._fluid.bind_lists()
            for solid in self._solids:
                solid.bind_lists()

    def forget_removed(self) -> None:
        """Survey only the particles that are alive: those that left must not limit the step."""
        self._survey_fluid = self._bind_survey(0, self._fluid.count, 0)

    def synchronise(self) -> None:
        """Bring pressures to the time of the positions, for output."""
        self._fluid.synchronise()
        self.mirror_pressure()
        self.mirror_density()
        for solid in self._solids:
            solid.synchronise()

    @property
    def target(self) -> float:
        """Time on which a coming step lands [s]."""
        return self._read(clock_kernels.TARGET)

    @property
    def time(self) -> float:
        """Time at the end of the present step [s]."""
        return self._read(clock_kernels.TIME)

    @property
    def speed(self) -> float:
        """Largest speed when the step was chosen [m/s]."""
        return self._read(clock_kernels.SPEED)

    @property
    def compression(self) -> float:
        """Largest |rho/rho0 - 1| when the step was chosen."""
        return self._read(clock_kernels.COMPRESSION)

    @property
    def faults(self) -> int:
        """Particles whose state was not finite when the step was chosen."""
        return int(self._read(clock_kernels.FAULTS))

    def set_clock(self, **entries: float) -> None:
        """Set entries of the clock by name."""
        values = np.array(host_view(self._clock))
        for name, value in entries.items():
            values[getattr(clock_kernels, name)] = value
        write_array(self._clock, values)
        self._host_clock = host_view(self._clock)

    def _read(self, entry: int) -> float:
        return float(self._host_clock[entry])

    def _moving_tables(self, all_tables: bool = False) -> list[bool]:
        """Which tables have positions of their own that may have changed; images have none."""
        walls = [all_tables or self._walls.motion.moving] if self._walls else []
        faces = [True] if self._faces else []
        return [True, *walls, *faces, *([False] if self._symmetry else [])]

    def _bind_clock(self, scene: Scene) -> None:
        a = self._parts.assembly
        arithmetic, state, scratch = a.options.arithmetic, a.state, a.scratch
        kernels = make_clock_kernels(arithmetic, a.options.state)
        self._fluid_blocks = -(-a.layout.fluids // BLOCK)
        self._wall_blocks = -(-a.layout.walls // BLOCK)
        self._face_blocks = -(-a.layout.faces // BLOCK)
        rows = max(self._fluid_blocks + self._wall_blocks + self._face_blocks, 1)
        extremes = wp.zeros((rows, 5), dtype=arithmetic.real, device=a.launcher.device)

        def bind_survey(first: int, count: int, first_row: int) -> Pass:
            return a.launcher.bind(
                "survey",
                kernels.survey,
                first,
                count,
                first_row,
                a.constants.rest_density,
                state.density_deviation,
                scratch.position_density,
                self._search.listed_position,
                state.velocity_volume,
                state.acceleration,
                extremes,
            )

        self._bind_survey = bind_survey
        self._survey_fluid = bind_survey(0, self._fluid.count, 0)
        self._survey_walls = bind_survey(a.layout.fluids, a.layout.walls, self._fluid_blocks)
        first_row = self._fluid_blocks + self._wall_blocks
        self._survey_faces = bind_survey(a.layout.first_face, a.layout.faces, first_row)
        limits = step_limits(scene, float(a.constants.sound_speed))
        self._choose = a.launcher.bind(
            "choose step", kernels.choose_step, rows, extremes, limits, self._clock
        )


def step_limits(scene: Scene, sound_speed: float) -> StepLimits:
    """Return the numbers behind the step limits of a scene."""
    limits = StepLimits()
    limits.cfl = scene.time.cfl
    limits.smoothing_length = smoothing_length(scene)
    limits.sound_speed = sound_speed
    limits.rest_density = material(scene).density
    limits.state_parameters = clock_kernels.STATE_PARAMETERS(*padded(scene.numerics.state.numbers))
    limits.viscosity = step_viscosity(scene, sound_speed)
    limits.max_step = scene.time.max_step or NO_LIMIT
    return limits
