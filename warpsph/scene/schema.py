"""The scene: everything that defines a run, as plain data with units.

The attribute names are the keys of the scene file. Objects are immutable; a scene that cannot be run is
refused when it is built, from a file as from Python.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, PrivateAttr, ValidationInfo, model_validator

from warpsph.scene.accuracy import Accuracy
from warpsph.scene.checks import scene_problems
from warpsph.scene.document import Document, placed
from warpsph.scene.dump import to_yaml
from warpsph.scene.errors import SceneError
from warpsph.scene.expressions import Expression, VectorField
from warpsph.scene.file_shapes import LoadContext
from warpsph.scene.motion import Motion
from warpsph.scene.numerics import Numerics
from warpsph.scene.open_boundaries import OpenBoundary
from warpsph.scene.probes import Probe
from warpsph.scene.recordings import FlowStatistics, Paths
from warpsph.scene.references import Reference
from warpsph.scene.shapes import Bounds, Shape
from warpsph.scene.structures import Contact, Coupling, Structure
from warpsph.scene.types import (
    Axis,
    FileName,
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

Face = Literal["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"]
OutputField = Literal[
    "velocity",
    "density",
    "pressure",
    "mass",
    "vorticity",
    "free_surface",
    "age",
    "wall_shear_stress",
    "displacement",
    "cauchy_stress",
    "von_mises",
    "green_lagrange_strain",
    "volume_ratio",
]
_NAMED = Field(json_schema_extra={"additionalProperties": False})


class Domain(SceneModel):
    """Where particles may be; without it, everywhere."""

    periodic: Mapping[Axis, tuple[Real, Real]] = {}
    """Axes that wrap round, each with its [low, high] coordinates [m]. Default: none."""

    symmetry: Mapping[Face, Real] = {}
    """Planes of symmetry: the face of the domain, x_min, x_max, y_min, y_max, z_min or z_max, with its coordinate [m].
    The flow beyond is the mirror image. Fluid lies inside; walls go on beyond the plane by the support radius.
    Default: none."""

    kill_box: Bounds | None = None
    """Particles that leave this box are removed and counted. Default: null."""


class Time(SceneModel):
    """How long, how often written, in which steps."""

    end: PositiveReal
    """Simulated time [s]."""

    frame_rate: PositiveReal
    """Frames a simulated second [1/s]."""

    cfl: Annotated[Real, Field(gt=0.0, le=1.0)] = 0.5
    """Fraction of the stability limits that a step may take [1]. Default: 0.5."""

    max_step: PositiveReal | None = None
    """Upper limit of the step [s]; null: only the stability limits. Default: null."""


class HydrostaticPressure(SceneModel):
    """Initial pressure density * |gravity| * depth below the free surface."""

    type: Literal["hydrostatic"] = "hydrostatic"
    surface: Literal["auto"] | Real = "auto"
    """Free surface as a coordinate along -gravity [m]; auto: the top of this fluid. Default: auto."""


class UniformPressure(SceneModel):
    """The same initial pressure everywhere."""

    type: Literal["uniform"] = "uniform"
    value: Real
    """Pressure [Pa]."""


class ExpressionPressure(SceneModel):
    """Initial pressure as a formula."""

    type: Literal["expression"] = "expression"
    value: Expression
    """Pressure [Pa] as an expression in x, y, z [m]."""


InitialPressure = Annotated[
    HydrostaticPressure | UniformPressure | ExpressionPressure, Field(discriminator="type")
]


class Fluid(SceneModel):
    """A body of liquid."""

    shape: Shape
    """Where it is at the start."""

    placement: Placement = "lattice"
    """lattice: particles in the middles of cells. relaxed: those near the surface evened out along it, half a spacing
    off it, for curved and oblique surfaces. Default: lattice."""

    density: PositiveReal
    """Reference density [kg/m3]."""

    kinematic_viscosity: NonNegativeReal = 0.0
    """Used by laminar viscosity [m2/s]. Default: 0."""

    velocity: VectorField | None = None
    """Initial velocity [m/s]; each component is a number or an expression in x, y, z [m]; null: at rest.
    Default: null."""

    pressure: InitialPressure = HydrostaticPressure()
    """Initial pressure. Default: {type: hydrostatic, surface: auto}."""


class Boundary(SceneModel):
    """A wall, fixed or moved by a prescribed law."""

    shape: Shape
    """The body whose surface is the wall."""

    side: Literal["outside", "inside", "solid"]
    """outside: wall particles lie outside the surface, fluid inside (a tank); inside: layers just inside the
    surface (an obstacle); solid: the whole inside is filled."""

    placement: Literal["auto"] | Placement = "auto"
    """lattice: particles in the middles of cells. relaxed: those near the surface evened out along it, half a spacing
    off it. auto: in layers that follow the surface where that is curved or oblique, on the lattice elsewhere and
    for meshes. Default: auto."""

    layers: Literal["auto"] | PositiveInteger = "auto"
    """Layers of wall particles [1]; auto: as many as the support radius needs. Default: auto."""

    open: tuple[Face, ...] = ()
    """Faces of a box, or of the box around a mesh or a polygon, that carry no wall: x_min, x_max, y_min, y_max, z_min,
    z_max. Default: none."""

    slip: Literal["free_slip", "no_slip"] = "free_slip"
    """Tangential condition on the fluid. Default: free_slip."""

    motion: tuple[Motion, ...] = ()
    """Prescribed motions, applied in the order of the list; empty: fixed. Default: empty."""


class Output(SceneModel):
    """What a run leaves behind."""

    directory: FileName | None = None
    """Run directory; null: out/ and the scene's name. Default: null."""

    probe_rate: PositiveReal | None = None
    """Probe samples a simulated second [1/s]; null: the frame rate. Default: null."""

    usd: Flag = True
    """Write particles.usdc. Default: true."""

    hdf5: Flag = False
    """Write frames.h5. Default: false."""

    fields: tuple[OutputField, ...] = ("velocity", "density", "pressure", "displacement", "von_mises")
    """Fields in the frames beside position and id, each where a set has it: velocity [m/s], mass [kg]; of fluids
    density [kg/m3], pressure [Pa], vorticity [1/s], free_surface (1 there, else 0) and, between open boundaries, age
    [s], the time since a particle came in or since the start; of structures displacement [m], cauchy_stress and
    von_mises [Pa], green_lagrange_strain [1], volume_ratio J [1]; of walls and structures, where they are no_slip and
    the viscosity is laminar, wall_shear_stress [Pa].
    Default: velocity, density, pressure, displacement, von_mises."""

    statistics: FlowStatistics | None = None
    """Averages over time of velocity and pressure on a grid, in statistics.h5; null: none. Default: null."""

    paths: Annotated[Mapping[Name, Paths], _NAMED] = {}
    """Paths of chosen particles, by name, in paths.h5 and paths.usdc. Default: none."""

    checkpoint_every: PositiveInteger | None = None
    """Frames between checkpoints [1]; null: about every tenth of the run, and at the end. Default: null."""


class Validation(SceneModel):
    """How `warpsph validate` runs this scene."""

    resolutions: Annotated[tuple[PositiveReal, ...], Field(min_length=1)]
    """Particle spacings [m]."""

    quick: tuple[PositiveReal, ...] = ()
    """Particle spacings [m] of the quick tier; empty: the coarsest of resolutions. Default: empty."""

    set: Mapping[str, Any] = {}
    """Overrides of the scene for these runs, such as {time.end: 2.0}. Default: none."""

    quick_set: Mapping[str, Any] = {}
    """Further overrides for those of the quick tier, which beat `set`. References whose times lie beyond an earlier
    time.end are left out of it. Default: none."""


class Scene(SceneModel):
    """Everything that defines a run."""

    name: Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*$")]
    """Lower-case letters, digits and underscores; names the run directory."""

    description: str = ""
    """What the scene shows. Default: empty."""

    dimension: Literal[2, 3]
    """2 (unit depth) or 3; every vector of the scene has as many components."""

    spacing: PositiveReal
    """Particle spacing dp [m]."""

    gravity: Vector = Field(default_factory=lambda data: (0.0,) * data["dimension"])
    """Acceleration of gravity [m/s2]. Default: zero."""

    domain: Domain = Domain()
    """Where particles may be. Default: everywhere."""

    time: Time
    """Duration, frames and steps."""

    numerics: Numerics = Numerics()
    """The scheme. Default: every default of its keys."""

    fluids: Annotated[Mapping[Name, Fluid], _NAMED] = {}
    """Bodies of fluid by name. Default: none."""

    boundaries: Annotated[Mapping[Name, Boundary], _NAMED] = {}
    """Walls by name. Default: none."""

    open_boundaries: Annotated[Mapping[Name, OpenBoundary], _NAMED] = {}
    """Patches through which fluid enters and leaves, by name. Default: none."""

    structures: Annotated[Mapping[Name, Structure], _NAMED] = {}
    """Flexible structures by name. Default: none."""

    bonds: tuple[Annotated[tuple[Name, ...], Field(min_length=2)], ...] = ()
    """Groups of structures, each a list of names, that hold together where they touch, as one body of several
    materials. Structures that do not stand in the same group are separate, however near they are. Default: none."""

    contact: Contact | None = None
    """Contact of structures; null: they pass through each other and through walls. Default: null."""

    coupling: Coupling = Coupling()
    """How fluids and structures go on together. Default: {sub_steps: auto}."""

    probes: Annotated[Mapping[Name, Probe], _NAMED] = {}
    """Quantities sampled over time, by name. Default: none."""

    output: Output = Output()
    """What a run leaves behind. Default: every default of its keys."""

    references: Annotated[Mapping[Name, Reference], _NAMED] = {}
    """What the result is compared with, by name. Default: none."""

    accuracy: Accuracy | None = None
    """The accuracy that is asked for, from which `warpsph plan` finds the spacing; null: none. Default: null."""

    validation: Validation | None = None
    """How `warpsph validate` runs this scene; null: as it stands. Default: null."""

    _base_directory: Path = PrivateAttr(default_factory=Path.cwd)
    _document: Document | None = PrivateAttr(default=None)

    @model_validator(mode="after")
    def _refuse_nonsense(self, info: ValidationInfo) -> Scene:
        context = info.context
        declared = context.declared if isinstance(context, LoadContext) else None
        problems = list(scene_problems(self, declared))
        if problems:
            raise SceneError(problems)
        return self

    @property
    def base_directory(self) -> Path:
        """Directory from which relative file names of the scene are resolved."""
        return self._base_directory

    @property
    def support_radius(self) -> float:
        """Radius of the kernel's support [m]."""
        return self.numerics.support_over_h * self.numerics.h_over_dp * self.spacing

    @property
    def search_radius(self) -> float:
        """Radius of the neighbour lists: the support with its skin [m]."""
        return (1.0 + self.numerics.list_skin) * self.support_radius

    def read_from(self, directory: Path, document: Document | None = None) -> Scene:
        """The same scene with relative file names counted from a directory, and the text it came from."""
        scene = self.model_copy()
        scene._base_directory, scene._document = directory, document
        return scene

    def located(self, error: SceneError) -> SceneError:
        """The error of a later stage with the lines of the scene file, if the scene was read from one."""
        document = self._document
        if document is None:
            return error
        return SceneError(placed(problem, document) for problem in error.problems)

    def to_yaml(self, directory: Path | None = None) -> str:
        """Text of a scene file that gives this scene again, with every default written out.

        Where a `directory` is given, relative file names are rewritten so that the text can stand there.
        """
        return to_yaml(self, self.base_directory, directory)

    def __eq__(self, other: object) -> bool:
        """Whether the data are equal, wherever the scenes come from."""
        return isinstance(other, Scene) and self.model_dump() == other.model_dump()
