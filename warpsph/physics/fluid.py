"""The weakly compressible fluid: options and constants from the scene, and its passes."""

from __future__ import annotations

from typing import Any

import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.fluid import make_fluid_kernels
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pair_terms import make_constants_struct
from warpsph_kernels.smoothing import SMOOTHING_KERNELS

from warpsph.laws.viscosities import VISCOSITY_LAWS
from warpsph.particles.launch import lanes_on
from warpsph.particles.neighbours import NeighbourRows, SearchSpace
from warpsph.physics.assembly import Assembly, WallRange, WallSurface
from warpsph.physics.density_gradient import DensityGradient
from warpsph.physics.gradient_correction import GradientCorrection
from warpsph.physics.material import largest_kinematic_viscosity, material, padded, smoothing_length
from warpsph.physics.particle_order import ParticleOrderModel
from warpsph.physics.stress import StressModel
from warpsph.physics.summation import DensitySum
from warpsph.scene.schema import Scene

BARRIER_REACH = 0.6
"""Distance from the surface particles of a wall, in spacings, below which the wall pushes fluid back. Particles at rest
keep a whole spacing."""
BARRIER_STRENGTH = 0.4
"""Largest acceleration by the barrier in units of c0^2 / dp: it stops a particle that comes in at half of c0."""


def select_code(
    scene: Scene, arithmetic: Arithmetic, space: SearchSpace, has_walls: bool, device: Any
) -> FluidOptions:
    """Return the options that select device code for the scene and the Warp device."""
    numerics = scene.numerics
    slips = [solid.slip for solid in scene.boundaries.values()] + [s.slip for s in scene.structures.values()]
    no_slip = "no_slip" in slips
    return FluidOptions(
        arithmetic=arithmetic,
        periodic=space.periodic,
        smoothing=numerics.kernel,
        state=numerics.state.law,
        pressure_form=numerics.pressure_form,
        density_diffusion=numerics.density_diffusion.type,
        viscosity=_pair_viscosity(scene),
        stress=_stress(scene),
        particle_order=numerics.particle_order.type,
        density_follows=_density_follows(scene),
        density=numerics.density,
        kernel_gradient=numerics.kernel_gradient,
        background_pressure=numerics.background_pressure > 0.0,
        tension_cutoff=numerics.tension_cutoff is not None,
        wall=numerics.wall.type if has_walls else "none",
        wall_suction=getattr(numerics.wall, "suction", True),
        wall_friction=has_walls and no_slip and numerics.viscosity.type != "none",
        lanes=lanes_on(device, arithmetic.dimension),
    )


def _density_follows(scene: Scene) -> bool:
    """Tell whether the density follows what a transport velocity brings together: unless the scene says otherwise,
    where particles may grow fewer."""
    order = scene.numerics.particle_order
    if order.type != "transport_velocity":
        return False
    return bool(scene.open_boundaries) if order.density_follows is None else order.density_follows


def _pair_viscosity(scene: Scene) -> str:
    """Return the viscosity that acts pair by pair; a stress does not."""
    viscosity = scene.numerics.viscosity
    if viscosity.type == "custom":
        return viscosity.law
    others = {"viscous_stress": "none", "sub_particle_scale": "laminar"}
    return others.get(viscosity.type, viscosity.type)


def _stress(scene: Scene) -> str:
    """Return what the stress tensor of the fluid is made of."""
    viscosity = scene.numerics.viscosity
    if viscosity.type == "viscous_stress":
        return viscosity.law.type
    return viscosity.type if viscosity.type == "sub_particle_scale" else "none"


def fluid_constants(scene: Scene, options: FluidOptions, space: SearchSpace, sound_speed: float) -> Any:
    """Return the constants struct of the scene's fluid."""
    arithmetic = options.arithmetic
    fluid, numerics = material(scene), scene.numerics
    h, dim = smoothing_length(scene), scene.dimension
    volume = scene.spacing**dim
    norm = SMOOTHING_KERNELS[numerics.kernel].norm(dim, h)
    c = make_constants_struct(arithmetic)()
    c.smoothing_length, c.inverse_h = h, 1.0 / h
    c.norm, c.slope_norm = norm, norm / h**2
    c.mass, c.wall_volume = fluid.density * volume, volume
    c.rest_density, c.sound_speed = fluid.density, sound_speed
    c.state_parameters = arithmetic.parameters(*padded(numerics.state.numbers))
    if numerics.viscosity.type == "custom":
        c.viscosity_parameters = arithmetic.parameters(*padded(numerics.viscosity.numbers))
    c.artificial_viscosity = getattr(numerics.viscosity, "alpha", 0.0) * h * sound_speed * fluid.density
    c.dynamic_viscosity = fluid.density * fluid.kinematic_viscosity
    c.diffusion = getattr(numerics.density_diffusion, "delta", 0.0) * h * sound_speed
    c.inverse_spacing = 1.0 / scene.spacing
    c.barrier = BARRIER_STRENGTH * fluid.density * sound_speed**2 / (scene.spacing * volume)
    c.inverse_barrier_reach = 1.0 / (BARRIER_REACH * scene.spacing)
    c.background_pressure = numerics.background_pressure
    c.tension_cutoff = numerics.tension_cutoff or 0.0
    c.gravity = arithmetic.vector(*scene.gravity)
    c.period = arithmetic.vector(*space.period)
    return c


def step_viscosity(scene: Scene, sound_speed: float) -> float:
    """Return the kinematic viscosity [m^2/s] that limits the step.

    An artificial viscosity counts as alpha h c0 / 8 in 2D and / 10 in 3D (Monaghan 2005).
    """
    viscosity = scene.numerics.viscosity
    if viscosity.type == "none":
        return 0.0
    if viscosity.type == "artificial":
        return (
            viscosity.alpha * smoothing_length(scene) * sound_speed / (8.0 if scene.dimension == 2 else 10.0)
        )
    largest = largest_kinematic_viscosity(scene)
    if viscosity.type == "custom":
        law = VISCOSITY_LAWS[viscosity.law]
        return law.step_viscosity(largest, smoothing_length(scene), sound_speed, *viscosity.numbers)
    return largest


class FluidModel:
    """The passes of the fluid, and of what only some scenes have beside them. `count` particles are alive."""

    def __init__(self, assembly: Assembly, rows: NeighbourRows, surface: WallSurface, scene: Scene) -> None:
        options, numerics = assembly.options, scene.numerics
        self._assembly, self._rows, self._surface = assembly, rows, surface
        self._stress: StressModel | None = None
        self._order: ParticleOrderModel | None = None
        self._density_gradient: DensityGradient | None = None
        self._density_sum: DensitySum | None = None
        if options.stress != "none":
            self._stress = StressModel(assembly, rows, surface, scene)
        if options.particle_order != "none":
            self._order = ParticleOrderModel(assembly, rows, numerics.particle_order, scene.spacing)
        if options.density_diffusion == "delta_sph":
            self._density_gradient = DensityGradient(assembly, rows)
        if options.density != "continuity":
            self._density_sum = DensitySum(assembly, rows, scene)
        self._correction: GradientCorrection | None = None
        if options.kernel_gradient != "plain":
            self._correction = GradientCorrection(assembly, rows)
        self._kernels = make_fluid_kernels(options)
        self._none = wp.zeros(1, dtype=options.arithmetic.vector, device=assembly.launcher.device)
        self._no_rate = wp.zeros(1, dtype=options.arithmetic.real, device=assembly.launcher.device)
        self._bind_points()
        self._bind_sums()

    @property
    def own_arrays(self) -> dict[str, wp.array]:
        """Arrays of shape (fluids,) that follow the order of the fluid and belong into a checkpoint."""
        parts = [part.own_arrays for part in (self._stress, self._order) if part]
        return {name: array for arrays in parts for name, array in arrays.items()}

    @property
    def arrays(self) -> dict[str, wp.array]:
        """Arrays that only some scenes have, by name."""
        parts = (self._stress, self._order, self._density_gradient, self._correction)
        return {name: array for part in parts if part for name, array in part.arrays.items()}

    @property
    def passes(self) -> list[str]:
        """Names of the passes from the forces to the density, in the order of a step."""
        summed = ["sum density"] if self._density_sum else []
        stress = ["stress"] if self._stress else []
        order = self._order.passes if self._order else []
        gradient = ["density gradient"] if self._density_gradient else []
        rate = ["update density"] if self._has_rate else []
        corrected = ["gradient correction"] if self._correction else []
        return [*summed, *stress, "accelerate", *corrected, *order, "kick and drift", *gradient, *rate]

    @property
    def order(self) -> ParticleOrderModel | None:
        """What keeps the particles evenly spread, if anything does."""
        return self._order

    @property
    def count(self) -> int:
        return self._rows.targets.count

    @property
    def largest_shift(self) -> float:
        """Largest distance [m] that a particle may leave the flow by in a step."""
        return self._order.largest_shift if self._order else 0.0

    def bind_lists(self) -> None:
        """Build the passes that read neighbour lists; needed again when the rows have grown."""
        parts = (self._stress, self._order, self._density_gradient, self._density_sum, self._correction)
        for part in parts:
            if part:
                part.bind_lists()
        self._bind_sums()

    def begin_step(self) -> None:
        """Drift and update the density over half a step."""
        self._begin.run(self.count)
        if self._density_sum:
            self._density_sum.find()
            self._synchronise.run(self.count)

    def accelerate(self) -> None:
        """Sum the forces."""
        if self._stress:
            self._stress.find()
        self._accelerate.run(self.count)
        if self._correction:
            self._correction.correct_pressure()
        if self._stress:
            self._stress.add()
        if self._order:
            self._order.find()

    def kick_and_drift(self) -> None:
        """Advance the velocity over the step and the position over its second half."""
        self._kick.run(self.count)

    def update_density(self) -> None:
        """Sum the density rate and advance the density over the second half of the step."""
        if self._density_gradient:
            self._density_gradient.find()
        if self._has_rate:
            self._update_density.run(self.count)
            if self._correction:
                self._correction.correct_divergence()

    def react(self, walls: WallRange, force: wp.array) -> None:
        """Add what beside pair forces acts on each wall particle of a range [N], shape (its count,)."""
        if self._stress:
            self._stress.react(walls, force)

    def synchronise(self) -> None:
        """Bring pressure and volume to the time of position and density."""
        self._synchronise.run(self.count)

    @property
    def _has_rate(self) -> bool:
        return self._assembly.options.density != "summation"

    def _bind_points(self) -> None:
        a, bind = self._assembly, self._assembly.launcher.bind
        state, scratch = a.state, a.scratch
        shift = self._order.shift if self._order else self._none
        next_shift = self._order.next_shift if self._order else self._none
        self._begin = bind(
            "begin step",
            self._kernels.begin_step,
            a.constants,
            a.clock,
            a.origin,
            state.density_rate,
            shift,
            state.position,
            state.density_deviation,
            state.velocity_volume,
            scratch.position_pressure,
        )
        self._synchronise = bind(
            "synchronise",
            self._kernels.synchronise,
            a.constants,
            a.origin,
            state.position,
            state.density_deviation,
            state.velocity_volume,
            scratch.position_pressure,
            scratch.position_density,
        )
        self._kick = bind(
            "kick and drift",
            self._kernels.kick_and_drift,
            a.clock,
            a.origin,
            state.acceleration,
            state.density_deviation,
            next_shift,
            shift,
            state.position,
            state.velocity_volume,
            scratch.position_density,
        )

    def _bind_sums(self) -> None:
        a, rows = self._assembly, self._rows
        gradient = self._density_gradient.gradient if self._density_gradient else self._none
        self._accelerate = a.launcher.bind(
            "accelerate",
            self._kernels.accelerate,
            a.constants,
            rows.index,
            rows.ends,
            a.scratch.position_pressure,
            a.state.velocity_volume,
            self._surface.friction,
            self._surface.normal,
            a.layout.fluids,
            a.state.acceleration,
        )
        self._update_density = a.launcher.bind(
            "update density",
            self._kernels.update_density,
            a.constants,
            a.clock,
            rows.index,
            rows.ends,
            a.scratch.position_density,
            a.state.velocity_volume,
            gradient,
            self._order.closing if self._order else self._no_rate,
            a.state.density_rate,
            a.state.density_deviation,
        )
