"""Quantities sampled over time; each becomes columns `name.quantity[unit]` of probes.csv.

In two dimensions integrals are per metre of depth, and their units say so.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from warpsph.scene.probe_model import ProbeModel, force_columns
from warpsph.scene.shapes import Bounds
from warpsph.scene.structure_probes import (
    DisplacementProbe,
    ReactionProbe,
    RigidBodyProbe,
    RotationProbe,
    StructureEnergyProbe,
)
from warpsph.scene.types import AXES, Axis, Integer, Name, PositiveReal, Real, SceneModel, Vector

PointField = Literal["pressure", "velocity", "density"]


class FrontProbe(ProbeModel):
    """Largest coordinate that fluid has reached along an axis."""

    type: Literal["front"] = "front"
    axis: Axis
    """Direction of travel."""

    fluid: Name | None = None
    """One fluid only; null: all fluids. Default: null."""

    origin: Real = 0.0
    """Coordinate that counts as zero [m]. Default: 0."""

    def quantities(self, dimension: int) -> tuple[str, ...]:
        return ("position[m]",)


class ReachProbe(ProbeModel):
    """Largest distance of fluid from a point, half the diagonal of a particle's cell included."""

    type: Literal["reach"] = "reach"
    center: Vector
    """The point [m]."""

    fluid: Name | None = None
    """One fluid only; null: all fluids. Default: null."""

    def quantities(self, dimension: int) -> tuple[str, ...]:
        return ("radius[m]",)


class WaterLevelProbe(ProbeModel):
    """Height of the free surface at a vertical gauge."""

    type: Literal["water_level"] = "water_level"
    at: Annotated[tuple[Real, ...], Field(min_length=1, max_length=2)]
    """Place of the gauge: its coordinates [m] in the axes other than `axis`, in the order x, y, z."""

    axis: Literal["auto", "x", "y", "z"] = "auto"
    """Axis along which the level is measured; auto: the axis of gravity. Default: auto."""

    def quantities(self, dimension: int) -> tuple[str, ...]:
        return ("level[m]",)


class _OnSolid(ProbeModel):
    """A probe on one boundary or on one structure; the scene gives one of the two."""

    boundary: Name | None = None
    """The boundary, or null where a structure is given. Default: null."""

    structure: Name | None = None
    """The structure, or null where a boundary is given. Default: null."""

    @property
    def solid(self) -> str:
        """Name of the boundary or structure."""
        return self.boundary or self.structure or ""


class WallPressureProbe(_OnSolid):
    """Mean pressure on the surface of a wall or a structure near a point.

    It is taken from the first layer of wall particles, and moved to the surface half a spacing before it by the
    hydrostatic gradient.
    """

    type: Literal["wall_pressure"] = "wall_pressure"
    at: Vector
    """Centre of the gauge [m], on the surface at the start."""

    radius: PositiveReal
    """Particles of the first layer within this distance count [m]."""

    def quantities(self, dimension: int) -> tuple[str, ...]:
        return ("pressure[Pa]",)


class PointProbe(ProbeModel):
    """Fluid fields at a fixed point, by consistent interpolation."""

    type: Literal["point"] = "point"
    at: Vector
    """The point [m]."""

    fields: Annotated[tuple[PointField, ...], Field(min_length=1)] = ("pressure", "velocity")
    """What to interpolate: pressure [Pa], velocity [m/s], density [kg/m3]. Default: pressure and velocity."""

    def quantities(self, dimension: int) -> tuple[str, ...]:
        columns = {
            "pressure": ("pressure[Pa]",),
            "velocity": tuple(f"velocity_{axis}[m/s]" for axis in AXES[:dimension]),
            "density": ("density[kg/m3]",),
        }
        return tuple(column for field in self.fields for column in columns[field])


class LineProbe(ProbeModel):
    """Fluid fields at evenly spaced points of a line, numbered from 0: velocity_x_0, velocity_x_1 and so on."""

    type: Literal["line"] = "line"
    start: Vector
    """The first point [m]."""

    end: Vector
    """The last point [m]."""

    points: Annotated[Integer, Field(ge=2, le=1000)] = 2
    """How many points, the two ends included. Default: 2."""

    fields: Annotated[tuple[PointField, ...], Field(min_length=1)] = ("pressure", "velocity")
    """What to interpolate: pressure [Pa], velocity [m/s], density [kg/m3]. Default: pressure and velocity."""

    @property
    def at(self) -> tuple[tuple[float, ...], ...]:
        """Where the points are [m]."""
        parts = [k / (self.points - 1) for k in range(self.points)]
        ends = tuple(zip(self.start, self.end, strict=True))
        return tuple(tuple((1.0 - part) * a + part * b for a, b in ends) for part in parts)

    def quantities(self, dimension: int) -> tuple[str, ...]:
        of_point = PointProbe(at=(0.0,) * dimension, fields=self.fields).quantities(dimension)
        parts = [column.partition("[") for column in of_point]
        return tuple(f"{name}_{k}[{unit}" for k in range(self.points) for name, _, unit in parts)


class ForceProbe(_OnSolid):
    """Force and torque of the fluid on a boundary or a structure."""

    type: Literal["force"] = "force"
    about: Vector | None = None
    """Point about which the torque is taken [m]; null: the centre of mass at the start. Default: null."""

    def quantities(self, dimension: int) -> tuple[str, ...]:
        return force_columns(dimension)


class ForceCoefficientsProbe(ProbeModel):
    """Drag, lift and moment of the fluid on walls and structures together.

    A force has the coefficient c = 2 F / (rho U^2 L), in space over the span as well: 2 F / (rho U^2 L b); a moment has
    another L below. The moment is about the direction of drag x lift, which is z in the plane.
    """

    type: Literal["force_coefficients"] = "force_coefficients"
    boundaries: tuple[Name, ...] = ()
    """Walls that count. Default: none."""

    structures: tuple[Name, ...] = ()
    """Structures that count. Default: none."""

    speed: PositiveReal
    """Reference speed U, such as that of the inflow [m/s]."""

    length: PositiveReal
    """Reference length L, such as a diameter or a chord [m]."""

    span: PositiveReal | None = None
    """Reference length b across the plane of the flow [m]; in three dimensions only. Default: null."""

    density: PositiveReal | None = None
    """Reference density rho [kg/m3]; null: that of the fluid. Default: null."""

    drag: Vector | None = None
    """Direction of drag, of any length; null: along x. Default: null."""

    lift: Vector | None = None
    """Direction of lift, across that of drag; null: along y. Default: null."""

    about: Vector | None = None
    """Point about which the moment is taken [m]; null: the centre of mass at the start. Default: null."""

    def direction(self, force: Literal["drag", "lift"], dimension: int) -> tuple[float, ...]:
        """Direction of drag or of lift, of any length."""
        usual = tuple(float(k == ("drag", "lift").index(force)) for k in range(dimension))
        return tuple(getattr(self, force) or usual)

    def quantities(self, dimension: int) -> tuple[str, ...]:
        unit = "N/m" if dimension == 2 else "N"
        coefficients = ("drag", "lift", "moment", "viscous_drag", "viscous_lift")
        return (*(f"{name}[1]" for name in coefficients), f"drag_force[{unit}]", f"lift_force[{unit}]")


class EnergyProbe(ProbeModel):
    """Energies of all fluids together."""

    type: Literal["energy"] = "energy"

    def quantities(self, dimension: int) -> tuple[str, ...]:
        unit = "J/m" if dimension == 2 else "J"
        return tuple(f"{energy}[{unit}]" for energy in ("kinetic", "potential", "compression"))


class VolumeProbe(ProbeModel):
    """Volume (sum of m/rho) and number of particles of all fluids, and how many are gone since the start: through the
    kill box or, where a region is given, out of it."""

    type: Literal["volume"] = "volume"
    region: Bounds | None = None
    """Only particles in this box count; null: all. Default: null."""

    def quantities(self, dimension: int) -> tuple[str, ...]:
        return (f"volume[m{dimension}]", "particles[1]", "removed[1]")


class VoidsProbe(ProbeModel):
    """Voids in fluid that fills its space: the radius of the largest ball beside fluid in which there is no particle
    of any kind, over the spacing, and the volume of all voids.

    On a lattice the radius is half the diagonal of a cell, 0.71 in the plane and 0.87 in space. What is empty before a
    free surface counts as well: a region leaves it out.
    """

    type: Literal["voids"] = "voids"
    size: PositiveReal = 1.5
    """Radius over the spacing from which on an empty ball belongs to a void [1]. Default: 1.5."""

    region: Bounds | None = None
    """Only balls with their centres in this box count; null: all between the outermost particles. Default: null."""

    def quantities(self, dimension: int) -> tuple[str, ...]:
        return ("radius[1]", f"volume[m{dimension}]")


class MomentumProbe(ProbeModel):
    """Momentum and angular momentum about the origin: of everything that flows or moves, or of what is named."""

    type: Literal["momentum"] = "momentum"
    fluid: Name | None = None
    """A fluid that counts. Default: null."""

    structure: Name | None = None
    """A structure that counts. Where neither is named, all fluids and structures count. Default: null."""

    def quantities(self, dimension: int) -> tuple[str, ...]:
        if dimension == 2:
            return ("momentum_x[kg/s]", "momentum_y[kg/s]", "angular_momentum_z[kg m/s]")
        linear = tuple(f"momentum_{axis}[kg m/s]" for axis in AXES)
        return linear + tuple(f"angular_momentum_{axis}[kg m2/s]" for axis in AXES)


class FluxProbe(ProbeModel):
    """What passes an open boundary into the domain, or all of them together: mass a second and its integral, from
    the particles on both sides of the patch and their velocity, and the mass of the particles that have entered less
    that of those that have left."""

    type: Literal["flux"] = "flux"
    patch: Name | None = None
    """Name of the open boundary; null: all. Default: null."""

    def quantities(self, dimension: int) -> tuple[str, ...]:
        unit = "kg/m" if dimension == 2 else "kg"
        rate = "kg/(m s)" if dimension == 2 else "kg/s"
        return (f"flux[{rate}]", f"mass[{unit}]", f"counted_mass[{unit}]")


class WallLine(SceneModel):
    """A straight line at rest on the surface of a structure, in two dimensions."""

    structure: Name
    """The structure."""

    start: Vector
    """Its first point [m]."""

    end: Vector
    """Its last point [m]; from the first one to this the fluid lies on the left."""


class VolumeBalanceProbe(ProbeModel):
    """Balance of the fluid between all open boundaries: mass that has entered, by the flux on the patches and counted
    in particles, mass that the fluid has gained since the start, where particles beside a patch count in part, and what
    it has gained less what has entered: by the flux, and in whole particles. What leaves through a hole of a wall is
    missing: it is lost in the kill box, or lies outside of the region.

    With flexible walls also the volume that the fluid has gained since the start (sum of m/rho), the volume that the
    walls have given to it, and the first less the second. Fluid in buffers does not count."""

    type: Literal["volume_balance"] = "volume_balance"
    region: Bounds | None = None
    """Only fluid in this box counts; null: all. Default: null."""

    walls: tuple[WallLine, ...] = ()
    """The flexible part of the walls around the fluid: lines on the surfaces of structures, in two dimensions,
    with the fluid on the left from start to end. Default: none."""

    def quantities(self, dimension: int) -> tuple[str, ...]:
        mass, volume = ("kg/m", "m2") if dimension == 2 else ("kg", "m3")
        names = ("flux", "counted", "gained", "flux_error", "counted_error")
        figures = tuple(f"{name}[{mass}]" for name in names)
        of_walls = tuple(f"{name}[{volume}]" for name in ("volume", "enclosed", "walls_error"))
        return figures + (of_walls if self.walls else ())


Probe = Annotated[
    FrontProbe
    | ReachProbe
    | WaterLevelProbe
    | WallPressureProbe
    | PointProbe
    | LineProbe
    | ForceProbe
    | ForceCoefficientsProbe
    | EnergyProbe
    | VolumeProbe
    | VoidsProbe
    | DisplacementProbe
    | RotationProbe
    | ReactionProbe
    | RigidBodyProbe
    | StructureEnergyProbe
    | MomentumProbe
    | FluxProbe
    | VolumeBalanceProbe,
    Field(discriminator="type"),
]
