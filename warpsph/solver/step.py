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
from warpsph.particles.state import host_view
from warpsph.physics.boundary import WallModel
from warpsph.physics.fluid import material, padded, smoothing_length, step_viscosity
from warpsph.scene.schema import Scene
from warpsph.solver.assemble import FLUID, WALL, Parts
from warpsph.solver.system import StepReport

NO_LIMIT = 1.0e30


class Stepper:
    """Advances the parts of a run."""

    def __init__(self, scene: Scene, parts: Parts) -> None:
        self._fluid, self._walls, self._search = parts.fluid, parts.walls, parts.search
        self._symmetry = parts.symmetry
        self._parts = parts
        self._clock = parts.assembly.clock
        self._spacing = scene.spacing
        self.removed = 0
        self._bind_clock(scene)

    def start(self, time: float = 0.0) -> None:
        """Place walls, make the first lists, and find the density rate of the initial velocity."""
        self.set_clock(TIME=time, STEP=0.0, TARGET=math.inf)
        if self._walls:
            self._walls.place(time)
        self._search.take_positions(self._moving_tables(all_tables=True))
        self.make_lists(all_tables=True)
        self._fluid.synchronise()
        self.mirror_pressure()
        if self._walls:
            self.find_wall_surface(self._walls)
            self._walls.place(time)
            self._walls.start()
        self.synchronise()
        self._fluid.update_density()
        self.update_wall_density()
        self.survey()

    def find_wall_surface(self, walls: WallModel) -> None:
        """Find the normals that keep fluid out of the walls, where the wall method needs them."""
        if self._parts.assembly.options.has_barrier:
            rows = self._search.list_once(WALL, WALL)
            walls.find_surface(rows, self._search.listed_position, self._spacing)

    def resume(self, clock: np.ndarray) -> None:
        """Go on from a restored state with the lists, the order and the survey that it had."""
        self._clock.assign(clock)
        self._host_clock = host_view(self._clock)
        if self._walls:
            self._walls.place(self.time)
        self.forget_removed()
        self.make_lists(all_tables=True)
        self.synchronise()
        self.survey()

    def step(self) -> StepReport:
        """Advance by one variable step."""
        report = self.choose_step()
        if self.lists_expire(report.dt):
            self.renew_lists()
        self.move_walls(self.time - 0.5 * report.dt)
        self._fluid.begin_step()
        self.mirror_pressure()
        self.impose_walls()
        self._fluid.accelerate()
        self._fluid.kick_and_drift()
        self.mirror_density()
        self.move_walls(self.time)
        self._fluid.update_density()
        self.update_wall_density()
        self.survey()
        return report

    def choose_step(self) -> StepReport:
        """Let the device choose the step from the survey of the state, and read it."""
        self._choose.run(1)
        self._host_clock = host_view(self._clock)
        ruling = LIMITS[int(self._host_clock[clock_kernels.RULING])]
        return StepReport(dt=self._read(clock_kernels.STEP), limit=ruling)

    def survey(self) -> None:
        """Find the extremes of the state."""
        self._survey_fluid.run(self._fluid_blocks)
        if self._walls and self._walls.moving:
            self._survey_walls.run(self._wall_blocks)

    def mirror_pressure(self) -> None:
        """Show the fluid its images with their pressures."""
        if self._symmetry:
            self._symmetry.mirror_pressure()

    def mirror_density(self) -> None:
        """Show the fluid its images with their densities."""
        if self._symmetry:
            self._symmetry.mirror_density()

    def move_walls(self, time: float) -> None:
        """Place walls that move as prescribed for a time [s]."""
        if self._walls:
            self._walls.move(time)

    def impose_walls(self) -> None:
        """Set what the fluid sees at the walls."""
        if self._walls:
            self._walls.impose()

    def update_wall_density(self) -> None:
        """Advance the density of walls that have one."""
        if self._walls:
            self._walls.update_density()

    def lists_expire(self, dt: float) -> bool:
        """Tell whether a particle may outrun the neighbour lists within the step."""
        reach = self._read(clock_kernels.SPEED) + self._read(clock_kernels.ACCELERATION) * dt
        displacement = self._read(clock_kernels.DISPLACEMENT) + self._fluid.largest_shift
        return self._search.must_rebuild(displacement, reach, dt)

    def renew_lists(self) -> None:
        """Sort the particles and list their neighbours anew."""
        if self._symmetry:
            self._symmetry.reflect()
        self._search.take_positions(self._moving_tables())
        self.make_lists()

    def make_lists(self, all_tables: bool = False) -> None:
        """Sort and list from the positions last taken."""
        moving = self._moving_tables(all_tables)
        capacities = [rows.capacity for rows in self._search.rows]
        before = self._fluid.count
        self.removed += self._search.sort(FLUID, self._parts.fluid_arrays)
        if self._fluid.count < before:
            self.forget_removed()
        if self._walls and moving[WALL]:
            self._search.sort(WALL, self._parts.wall_arrays)
        if self._symmetry:
            self._symmetry.make_images()
        self._search.list_neighbours()
        if capacities != [rows.capacity for rows in self._search.rows]:
            self._fluid.bind_lists()
            if self._walls:
                self._walls.bind_lists()

    def forget_removed(self) -> None:
        """Survey only the particles that are alive: those that left must not limit the step."""
        self._survey_fluid = self._bind_survey(0, self._fluid.count, 0)

    def synchronise(self) -> None:
        """Bring pressures to the time of the positions, for output."""
        self._fluid.synchronise()
        self.mirror_pressure()
        self.mirror_density()
        if self._walls:
            self._walls.synchronise()

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
        self._clock.assign(values)
        self._host_clock = host_view(self._clock)

    def _read(self, entry: int) -> float:
        return float(self._host_clock[entry])

    def _moving_tables(self, all_tables: bool = False) -> list[bool]:
        """Which tables have positions of their own that may have changed; images have none."""
        walls = [all_tables or self._walls.moving] if self._walls else []
        return [True, *walls, *([False] if self._symmetry else [])]

    def _bind_clock(self, scene: Scene) -> None:
        a = self._parts.assembly
        arithmetic, state, scratch = a.options.arithmetic, a.state, a.scratch
        kernels = make_clock_kernels(arithmetic, a.options.state)
        self._fluid_blocks = -(-a.layout.fluids // BLOCK)
        self._wall_blocks = -(-a.layout.walls // BLOCK)
        rows = max(self._fluid_blocks + self._wall_blocks, 1)
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
        self._survey_fluid = bind_survey(0, a.layout.first_image, 0)
        self._survey_walls = bind_survey(a.layout.fluids, a.layout.walls, self._fluid_blocks)
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
