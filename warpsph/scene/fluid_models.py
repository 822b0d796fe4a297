"""Models of the fluid that a scene chooses by `type`: state, density diffusion, viscosity."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from warpsph.scene.types import Real, SceneModel


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


State = Annotated[Tait | LinearState, Field(discriminator="type")]


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
