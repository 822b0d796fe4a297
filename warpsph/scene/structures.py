"""Structures: their material, where they are held, and what acts on them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Field

from warpsph.scene.expressions import Expression, VectorField
from warpsph.scene.motion import Motion
from warpsph.scene.rigid import Rigid
from warpsph.scene.shapes import Shape
from warpsph.scene.types import (
    Axis,
    Flag,
    Name,
    NonNegativeReal,
    Placement,
    PositiveInteger,
    PositiveReal,
    Real,
    SceneModel,
    Vector,
)

SeenVelocity = Literal["centred", "end", "mean"]
"""What the fluid takes for the velocity of structures at the end of its step, see `Coupling`."""


class Material(SceneModel):
    """An elastic material."""

    law: Name = "st_venant_kirchhoff"
    """Constitutive law: st_venant_kirchhoff, neo_hookean, split_neo_hookean, linear_elastic, or one registered from
    Python. Default: st_venant_kirchhoff."""

    density: PositiveReal
    """Density at rest [kg/m3]."""

    youngs_modulus: PositiveReal
    """Young's modulus E [Pa]."""

    poisson_ratio: Annotated[Real, Field(gt=-1.0, le=0.49)]
    """Poisson's ratio [1], up to 0.49."""

    @property
    def shear_modulus(self) -> float:
        """mu = E / (2 (1 + nu)) [Pa]."""
        return self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))

    @property
    def lame(self) -> float:
        """lambda = E nu / ((1 + nu)(1 - 2 nu)) [Pa]."""
        nu = self.poisson_ratio
        return self.youngs_modulus * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))

    @property
    def sound_speed(self) -> float:
        """Speed of pressure waves at rest, sqrt((lambda + 2 mu) / rho) [m/s]."""
        return float(((self.lame + 2.0 * self.shear_modulus) / self.density) ** 0.5)


class Clamp(SceneModel):
    """Particles that are held, or moved by a prescribed law.

    Where all components are prescribed, the particles next to free ones stand on the surface of the region."""

    region: Shape
    """The particles whose centres lie in this shape at rest."""

    axes: tuple[Axis, ...] | None = None
    """Components of the displacement that are prescribed; null: all. Default: null."""

    motion: tuple[Motion, ...] = ()
    """Prescribed motions, applied in the order of the list; empty: held at rest. Default: empty."""

    @property
    def is_whole(self) -> bool:
        """Whether all components are prescribed, so that the region is rigid."""
        return self.axes is None


class ForceLoad(SceneModel):
    """A force, shared by the particles of a region by their mass."""

    type: Literal["force"] = "force"
    region: Shape
    """The particles whose centres lie in this shape at rest."""
    value: Vector
    """The whole force [N]; in two dimensions per metre of depth [N/m]."""
    factor: Expression = "1"
    """Time law: the force is multiplied by this expression in t [s]. Default: 1."""


class TractionLoad(SceneModel):
    """A force per area of the surface at rest, of fixed direction."""

    type: Literal["traction"] = "traction"
    region: Shape
    """The part of the surface that lies in this shape at rest."""
    value: Vector
    """Force per area [Pa]."""
    factor: Expression = "1"
    """Time law: the traction is multiplied by this expression in t [s]. Default: 1."""


class BodyLoad(SceneModel):
    """An acceleration of all particles of a region, beside gravity."""

    type: Literal["body"] = "body"
    region: Shape | None = None
    """The particles whose centres lie in this shape at rest; null: all. Default: null."""
    value: Vector
    """Acceleration [m/s2]."""
    factor: Expression = "1"
    """Time law: the acceleration is multiplied by this expression in t [s]. Default: 1."""


Load = Annotated[ForceLoad | TractionLoad | BodyLoad, Field(discriminator="type")]


class Structure(SceneModel):
    """A flexible or rigid body."""

    shape: Shape
    """Where it is at rest."""

    placement: Placement = "lattice"
    """lattice: particles in the middles of cells. relaxed: those near the surface evened out along it, half a spacing
    off it; such a body is softer in bending. Default: lattice."""

    material: Material
    """What it is made of."""

    slip: Literal["free_slip", "no_slip"] = "free_slip"
    """Tangential condition on the fluid. Default: free_slip."""

    rigid: Rigid | None = None
    """What makes it a rigid body; null: it is flexible. Default: null."""

    plane: Literal["strain", "stress"] = "strain"
    """State across the plane in two dimensions: no strain, or no stress. Default: strain."""

    velocity: VectorField | None = None
    """Initial velocity [m/s]; each component is a number or an expression in x, y, z [m]; null: at rest. That of a
    rigid body has to be one of a rigid motion. Default: null."""

    displacement: VectorField | None = None
    """Initial displacement [m], in the same way. Default: null."""

    clamps: Annotated[Mapping[Name, Clamp], Field(json_schema_extra={"additionalProperties": False})] = {}
    """Where the structure is held, by name. Default: none."""

    loads: Annotated[Mapping[Name, Load], Field(json_schema_extra={"additionalProperties": False})] = {}
    """What acts on it beside gravity, fluids and contact, by name. Default: none."""

    damping: NonNegativeReal = 0.0
    """Viscous damping of the momentum: the force is -damping times mass times velocity [1/s]. Default: 0."""


class DynamicSolution(SceneModel):
    """Motion in time."""

    type: Literal["dynamic"] = "dynamic"


class StaticSolution(SceneModel):
    """Equilibrium at every frame and probe sample under the loads of that time, by dynamic relaxation."""

    type: Literal["static"] = "static"
    tolerance: PositiveReal = 1e-3
    """Converged when the root mean square of the unbalanced force is below this part of that of the external forces
    and reactions, and so is the motion that is left: what the slowest mode could still move, over what has been
    moved [1]. Default: 0.001."""
    max_steps: PositiveInteger = 2_000_000
    """Steps for one equilibrium after which the run gives up [1]. Default: 2000000."""


Solution = Annotated[DynamicSolution | StaticSolution, Field(discriminator="type")]


class StructureNumerics(SceneModel):
    """The scheme of structures."""

    h_over_dp: Annotated[Real, Field(ge=0.6, le=3.0)] = 0.8
    """Smoothing length over particle spacing [1]. Default: 0.8."""

    hourglass: Annotated[Real, Field(ge=0.0, le=10.0)] = 0.4
    """Stiffness against displacements that the deformation gradient does not see, in Young's moduli [1].
    Default: 0.4."""

    cfl: Annotated[Real, Field(gt=0.0, le=1.0)] = 0.8
    """Fraction of the measured stability limit that a step may take [1]. Default: 0.8."""

    solution: Solution = DynamicSolution()
    """Motion or equilibrium. Default: {type: dynamic}."""


class Coupling(SceneModel):
    """How fluids and structures go on together in time."""

    sub_steps: Literal["auto"] | PositiveInteger = "auto"
    """Steps of the structures within one step of the fluid [1]. auto: the fluid steps as far as it can alone, and the
    structures make as many steps within that as they need. A number: at most so many, the step of the fluid is
    shortened to what they allow; 1 is one shared step. Default: auto."""

    velocity: SeenVelocity = "centred"
    """Velocity of structures that the fluid sees at the end of its step. centred: the mean from the middle of this step
    to the middle of the next, for which structures look half a step ahead; end: that of the moment; mean: over the step
    that has been made, after Zhang, Rezavand & Hu (2021), which is half a step old. Default: centred."""


class Contact(SceneModel):
    """Contact of structures with each other, with themselves and with the walls under `boundaries`, by a penalty.

    Surfaces touch where their cells do: at one spacing between particle centres. Not there with periodic
    axes and planes of symmetry.
    """

    stiffness: PositiveReal = 0.5
    """Stiffness of the penalty [1], in units of a particle's cell of the stiffest material of the scene: under a
    pressure p surfaces go p / (stiffness E) spacings into each other. Up to about 1 it does not shorten the step.
    Default: 0.5."""

    friction: NonNegativeReal = 0.0
    """Coefficient of Coulomb friction, of rest and motion [1]. Default: 0."""

    own_surface: Flag = True
    """Whether a structure touches itself. Default: true."""
