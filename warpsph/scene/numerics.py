"""Which discretisation computes the scene: one small object a model, chosen by its `type`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Field

from warpsph.scene.structures import StructureNumerics
from warpsph.scene.types import Flag, NonNegativeReal, PositiveReal, Real, SceneModel

SUPPORT_OVER_H: Mapping[str, float] = {"wendland_c2": 2.0}
"""Support radius of each kernel in units of its smoothing length."""


class Tait(SceneModel):
    """p = rho0 c0^2 / gamma ((rho / rho0)^gamma - 1)."""

    type: Literal["tait"] = "tait"
    gamma: Annotated[Real, Field(ge=1.0, le=20.0)] = 7.0
    """Exponent [1]. Default: 7."""


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


DensityDiffusion = Annotated[
    NoDensityDiffusion | MolteniColagrossiDiffusion | FourtakasDiffusion, Field(discriminator="type")
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


Viscosity = Annotated[NoViscosity | ArtificialViscosity | LaminarViscosity, Field(discriminator="type")]


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

    kernel: Literal["wendland_c2"] = "wendland_c2"
    """Smoothing kernel. Default: wendland_c2."""

    h_over_dp: Annotated[Real, Field(ge=1.0, le=4.0)] = 1.5
    """Smoothing length over particle spacing [1]. Default: 1.5."""

    sound_speed: Literal["auto"] | PositiveReal = "auto"
    """Artificial speed of sound [m/s]; auto: ten times the largest expected speed. Default: auto."""

    expected_speed: PositiveReal | None = None
    """Largest expected speed [m/s], in place of the estimate behind sound_speed: auto. Default: null."""

    state: Tait = Tait()
    """Equation of state. Default: {type: tait, gamma: 7}."""

    pressure_form: Literal["symmetric"] = "symmetric"
    """Form of the pressure force. Default: symmetric."""

    density_diffusion: DensityDiffusion = FourtakasDiffusion()
    """Diffusion in the continuity equation. Default: {type: fourtakas, delta: 0.1}."""

    viscosity: Viscosity = ArtificialViscosity()
    """Viscous force. Default: {type: artificial, alpha: 0.02}."""

    wall: WallMethod = ExtrapolatedWall()
    """How walls act on the fluid. Default: {type: extrapolated}."""

    structure: StructureNumerics = StructureNumerics()
    """The scheme of structures. Default: every default of its keys."""

    skin: NonNegativeReal = 0.15
    """Margin of the neighbour lists, in support radii [1]. Default: 0.15."""

    @property
    def support_over_h(self) -> float:
        """Support radius of the kernel in units of the smoothing length."""
        return SUPPORT_OVER_H[self.kernel]
