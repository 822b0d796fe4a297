"""Models of the fluid that a scene chooses by `type`: state, density diffusion, viscosity, particle order."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Field

from warpsph.laws.states import STATE_LAWS
from warpsph.laws.viscosities import VISCOSITY_LAWS
from warpsph.scene.expressions import Expression
from warpsph.scene.types import Flag, NonNegativeReal, PositiveReal, Real, SceneModel


class Tait(SceneModel):
    """p = rho0 c0^2 / gamma ((rho / rho0)^gamma - 1)."""

    type: Literal["tait"] = "tait"
    gamma: Annotated[Real, Field(ge=1.0, le=20.0)] = 7.0
    """Exponent [1]. Default: 7."""

    @property
    def law(self) -> str:
        """Name of the formula among those that are registered."""
        return self.type

    @property
    def numbers(self) -> tuple[float, ...]:
        """Parameters of the formula, in its order."""
        return (self.gamma,)


class LinearState(SceneModel):
    """p = c0^2 (rho - rho0)."""

    type: Literal["linear"] = "linear"

    @property
    def law(self) -> str:
        """Name of the formula among those that are registered."""
        return self.type

    @property
    def numbers(self) -> tuple[float, ...]:
        """Parameters of the formula: none."""
        return ()


class CustomState(SceneModel):
    """A state that a program has added with `warpsph.register_state`."""

    type: Literal["custom"] = "custom"
    law: str
    """Name of the state, as it was registered."""

    parameters: Mapping[str, Real] = {}
    """Its parameters by name, all of them. Default: none."""

    @property
    def numbers(self) -> tuple[float, ...]:
        """Parameters of the formula, in its order."""
        return tuple(self.parameters[name] for name in STATE_LAWS[self.law].parameters)


State = Annotated[Tait | LinearState | CustomState, Field(discriminator="type")]


class NoDensityDiffusion(SceneModel):
    """The continuity equation alone."""

    type: Literal["none"] = "none"


class MolteniColagrossiDiffusion(SceneModel):
    """Density diffusion after Molteni & Colagrossi (2009)."""

    type: Literal["molteni_colagrossi"] = "molteni_colagrossi"
    delta: Annotated[Real, Field(gt=0.0, le=1.0)] = 0.1
    """Diffusion coefficient [1]. Default: 0.1."""


class FourtakasDiffusion(SceneModel):
    """The same without the hydrostatic part, after Fourtakas et al. (2019)."""

    type: Literal["fourtakas"] = "fourtakas"
    delta: Annotated[Real, Field(gt=0.0, le=1.0)] = 0.1
    """Diffusion coefficient [1]. Default: 0.1."""


class DeltaSPHDiffusion(SceneModel):
    """The same without the renormalised density gradient (delta-SPH), after Antuono et al. (2010)."""

    type: Literal["delta_sph"] = "delta_sph"
    delta: Annotated[Real, Field(gt=0.0, le=1.0)] = 0.1
    """Diffusion coefficient [1]. Default: 0.1."""


DensityDiffusion = Annotated[
    NoDensityDiffusion | MolteniColagrossiDiffusion | FourtakasDiffusion | DeltaSPHDiffusion,
    Field(discriminator="type"),
]


class NoViscosity(SceneModel):
    """Inviscid."""

    type: Literal["none"] = "none"


class ArtificialViscosity(SceneModel):
    """Artificial viscosity after Monaghan (1992)."""

    type: Literal["artificial"] = "artificial"
    alpha: Annotated[Real, Field(gt=0.0, le=1.0)] = 0.02
    """Coefficient [1]. Default: 0.02."""


class LaminarViscosity(SceneModel):
    """Laminar viscosity after Morris, Fox & Zhu (1997), with each fluid's kinematic_viscosity."""

    type: Literal["laminar"] = "laminar"


class SubParticleScale(SceneModel):
    """Laminar viscosity and a Smagorinsky stress for eddies below the spacing (Dalrymple & Rogers 2006)."""

    type: Literal["sub_particle_scale"] = "sub_particle_scale"
    smagorinsky: Annotated[Real, Field(gt=0.0, le=1.0)] = 0.12
    """Smagorinsky constant [1]. Default: 0.12."""

    isotropic: Annotated[Real, Field(ge=0.0, le=1.0)] = 0.0066
    """Constant of the isotropic part [1]. Default: 0.0066."""


class NewtonianLaw(SceneModel):
    """The viscosity does not depend on the shear rate."""

    type: Literal["newtonian"] = "newtonian"
    viscosity: Expression | None = None
    """Dynamic viscosity at the start in x, y, z [Pa s], which particles then carry along; null: density times the
    fluid's kinematic_viscosity. Default: null."""

    largest: PositiveReal | None = None
    """Cap of the dynamic viscosity [Pa s], which limits the step; needed beside viscosity. Default: null."""


class HerschelBulkleyLaw(SceneModel):
    """K s^(n-1) + tau_y (1 - exp(-m s)) / s at the shear rate s (Herschel & Bulkley 1926; Papanastasiou 1987):
    a Bingham fluid with n = 1, a power law without yield stress."""

    type: Literal["herschel_bulkley"] = "herschel_bulkley"
    consistency: PositiveReal
    """K [Pa s^n]."""

    exponent: Annotated[Real, Field(gt=0.0, le=4.0)] = 1.0
    """n [1]. Default: 1."""

    yield_stress: NonNegativeReal = 0.0
    """tau_y [Pa]. Default: 0."""

    regularisation: PositiveReal = 1000.0
    """m [s]. Default: 1000."""

    largest: PositiveReal
    """Cap of the dynamic viscosity [Pa s], which limits the step."""


class CarreauLaw(SceneModel):
    """mu_inf + (mu_0 - mu_inf) (1 + (lambda s)^2)^((n-1)/2) at the shear rate s (Carreau 1972)."""

    type: Literal["carreau"] = "carreau"
    zero_viscosity: PositiveReal
    """mu_0 [Pa s]."""

    infinite_viscosity: NonNegativeReal = 0.0
    """mu_inf [Pa s]. Default: 0."""

    time: PositiveReal
    """lambda [s]."""

    exponent: Annotated[Real, Field(gt=0.0, le=1.0)] = 0.5
    """n [1]. Default: 0.5."""

    @property
    def largest(self) -> float:
        """Largest dynamic viscosity [Pa s]."""
        return max(self.zero_viscosity, self.infinite_viscosity)


class ViscousStress(SceneModel):
    """The full viscous stress from the strain rate, with a viscosity that may vary in space or with the shear rate."""

    type: Literal["viscous_stress"] = "viscous_stress"
    law: Annotated[NewtonianLaw | HerschelBulkleyLaw | CarreauLaw, Field(discriminator="type")] = (
        NewtonianLaw()
    )
    """What the viscosity depends on. Default: {type: newtonian}."""


class CustomViscosity(SceneModel):
    """A viscosity that a program has added with `warpsph.register_viscosity`."""

    type: Literal["custom"] = "custom"
    law: str
    """Name of the viscosity, as it was registered."""

    parameters: Mapping[str, Real] = {}
    """Its parameters by name, all of them. Default: none."""

    @property
    def numbers(self) -> tuple[float, ...]:
        """Parameters of the formula, in its order."""
        return tuple(self.parameters[name] for name in VISCOSITY_LAWS[self.law].parameters)


Viscosity = Annotated[
    NoViscosity | ArtificialViscosity | LaminarViscosity | ViscousStress | SubParticleScale | CustomViscosity,
    Field(discriminator="type"),
]


class NoParticleOrder(SceneModel):
    """Particles move with the flow."""

    type: Literal["none"] = "none"

    @property
    def strength(self) -> float:
        """No shift [1]."""
        return 0.0


class TransportVelocity(SceneModel):
    """Particles move with a transport velocity that a background pressure keeps even, after Adami, Hu & Adams (2013):
    for flows that fill their space, without a free surface."""

    type: Literal["transport_velocity"] = "transport_velocity"
    background: Annotated[Real, Field(gt=0.0, le=10.0)] = 1.0
    """Background pressure in units of density * sound_speed^2 [1]. Default: 1."""
    density_follows: Flag | None = None
    """Whether the density follows, within about a hundred steps, where particles are moved together or apart; without
    it, the particles between open boundaries grow fewer at the same density. Default: true in a scene with open
    boundaries, else false."""

    @property
    def strength(self) -> float:
        """Background pressure in units of rho0 c0^2 [1]."""
        return self.background


class Shifting(SceneModel):
    """Particles are shifted towards even distances (Lind et al. 2012; Sun et al. 2017), along a free surface but
    not across it (Marrone et al. 2010; Sun et al. 2017)."""

    type: Literal["shifting"] = "shifting"
    coefficient: Annotated[Real, Field(gt=0.0, le=20.0)] = 4.0
    """Shift velocity over h v |grad C| with the largest speed v of the flow [1]. Default: 4."""

    @property
    def strength(self) -> float:
        """Shift velocity over h v |grad C| [1]."""
        return self.coefficient


ParticleOrder = Annotated[NoParticleOrder | TransportVelocity | Shifting, Field(discriminator="type")]
