"""Which discretisation computes the scene: one small object a model, chosen by its `type`."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from warpsph.laws.smoothing import SMOOTHING_LAWS
from warpsph.scene.fluid_models import (
    ArtificialViscosity,
    DensityDiffusion,
    FourtakasDiffusion,
    NoParticleOrder,
    ParticleOrder,
    State,
    Tait,
    Viscosity,
)
from warpsph.scene.structures import StructureNumerics
from warpsph.scene.types import (
    Flag,
    KernelName,
    NonNegativeReal,
    NonPositiveReal,
    PositiveReal,
    Real,
    SceneModel,
)

SKIN, SHIFTED_SKIN = 0.15, 0.2
"""Margins of the neighbour lists, in support radii, without and with a particle order."""


class DynamicWall(SceneModel):
    """Wall particles obey the continuity equation as the fluid does."""

    type: Literal["dynamic"] = "dynamic"


class ExtrapolatedWall(SceneModel):
    """Wall particles take pressure and velocity from the fluid, after Adami, Hu & Adams (2012)."""

    type: Literal["extrapolated"] = "extrapolated"
    suction: Flag = False
    """Whether the pressure of a wall may be negative: true for vessels filled to the lid, where pressures lie around
    zero; false for free surfaces, where water that hangs from a wall should fall. Default: false."""


class ModifiedDynamicWall(SceneModel):
    """Wall particles take pressure and velocity from their mirror points in the fluid, to first order, after English
    et al. (2022)."""

    type: Literal["modified_dynamic"] = "modified_dynamic"
    suction: Flag = False
    """Whether the pressure of a wall may be negative, as for extrapolated walls. Default: false."""


class RepulsiveWall(SceneModel):
    """Wall particles take the mean pressure and velocity of the fluid, and the first layer repels it, after Liu, Shao &
    Chang (2012)."""

    type: Literal["repulsive"] = "repulsive"
    suction: Flag = False
    """Whether the pressure of a wall may be negative, as for extrapolated walls. Default: false."""


WallMethod = Annotated[
    DynamicWall | ExtrapolatedWall | ModifiedDynamicWall | RepulsiveWall, Field(discriminator="type")
]


class Numerics(SceneModel):
    """The scheme; every choice has a default."""

    precision: Literal["single", "double"] = "single"
    """Of pair interactions; positions are integrated in double either way. Default: single."""

    kernel: KernelName = "wendland_c2"
    """Smoothing kernel. Its support radius is 2 h; that of quintic_spline and gaussian is 3 h, so that they see as
    many neighbours at two thirds of h_over_dp. Default: wendland_c2."""

    h_over_dp: Annotated[Real, Field(ge=1.0, le=4.0)] = 1.5
    """Smoothing length over particle spacing [1]. Default: 1.5."""

    sound_speed: Literal["auto"] | PositiveReal = "auto"
    """Artificial speed of sound [m/s]; auto: ten times the largest expected speed. Default: auto."""

    expected_speed: PositiveReal | None = None
    """Largest expected speed [m/s], in place of the estimate behind sound_speed: auto. Default: null."""

    state: State = Tait()
    """Equation of state. Default: {type: tait, gamma: 7}."""

    pressure_form: Literal["symmetric", "riemann"] = "symmetric"
    """Form of the pressure force; riemann: with the dissipation of a Riemann solver and its limiter, after Zhang, Hu &
    Adams (2017), in place of an artificial viscosity. Default: symmetric."""

    background_pressure: NonNegativeReal = 0.0
    """Pressure by which all pairs, those with walls included, repel beside that of the state [Pa]. It exerts no force
    on evenly spread particles, and spreads them; it is for fluid that fills its space. Default: 0."""

    tension_cutoff: NonPositiveReal | None = None
    """Lowest pressure of the fluid, and of walls with suction [Pa]: fluid that is pulled harder parts, and voids open,
    as in cavitation; null: it holds any tension. Default: null."""

    density: Literal["continuity", "summation", "mixed"] = "continuity"
    """Where the density comes from: the continuity equation; a sum over the neighbours, for fluid that fills its space
    and begins at rest density; or the sum inside and the continuity equation near a free surface.
    Default: continuity."""

    kernel_gradient: Literal["plain", "renormalised", "finite_particle"] = "plain"
    """First derivatives of pressure and velocity: plain sums; renormalised, exact for linear velocities; or of the
    finite-particle form, exact for linear pressures too, which conserves no momentum and does not hold a free surface.
    Default: plain."""

    density_diffusion: DensityDiffusion = FourtakasDiffusion()
    """Diffusion in the continuity equation. Default: {type: fourtakas, delta: 0.1}."""

    viscosity: Viscosity = ArtificialViscosity()
    """Viscous force. Default: {type: artificial, alpha: 0.02}."""

    particle_order: ParticleOrder = NoParticleOrder()
    """What keeps the particles evenly spread. Default: {type: none}."""

    wall: WallMethod = ExtrapolatedWall()
    """How walls act on the fluid. Default: {type: extrapolated}."""

    structure: StructureNumerics = StructureNumerics()
    """The scheme of structures. Default: every default of its keys."""

    skin: NonNegativeReal | None = None
    """Margin of the neighbour lists, in support radii [1]. Default: 0.2 with a particle order, whose shifts take some
    of it, otherwise 0.15."""

    @property
    def list_skin(self) -> float:
        """Margin of the neighbour lists in support radii, chosen where the scene does not say."""
        if self.skin is not None:
            return self.skin
        return SKIN if self.particle_order.type == "none" else SHIFTED_SKIN

    @property
    def support_over_h(self) -> float:
        """Support radius of the kernel in units of the smoothing length."""
        return SMOOTHING_LAWS[self.kernel].support
