"""Consistency of probes and references with the rest of the scene."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from warpsph.scene.checks.common import (
    DeclaredNames,
    expression_problems,
    no_such_axis,
    repeated_problems,
    unknown_name,
)
from warpsph.scene.errors import Problem
from warpsph.scene.probes import (
    DisplacementProbe,
    EnergyProbe,
    FluxProbe,
    ForceCoefficientsProbe,
    ForceProbe,
    FrontProbe,
    LineProbe,
    MomentumProbe,
    PointProbe,
    Probe,
    ReachProbe,
    ReactionProbe,
    RigidBodyProbe,
    RotationProbe,
    StructureEnergyProbe,
    VolumeBalanceProbe,
    VolumeProbe,
    WallPressureProbe,
    WaterLevelProbe,
)
from warpsph.scene.references import (
    FeatureReference,
    FieldReference,
    Figure,
    InlineProfile,
    InlineTable,
    LimitReference,
    ProfileReference,
    SeriesReference,
)
from warpsph.scene.types import AXES

if TYPE_CHECKING:
    from warpsph.scene.schema import Scene


def probe_problems(scene: Scene, names: DeclaredNames) -> Iterator[Problem]:
    """Probes of sets or axes that the scene does not have."""
    for name, probe in scene.probes.items():
        key = f"probes.{name}"
        yield from _kind_problems(probe, names, key)
        yield from _set_problems(probe, names, key)
        yield from _clamp_problems(probe, scene, key)
        if isinstance(probe, RigidBodyProbe) and probe.structure in scene.structures:
            yield from _rigid_problems(probe, scene, key)
        axis = getattr(probe, "axis", None)
        if isinstance(probe, RotationProbe):
            yield from _rotation_problems(probe, scene, key)
        elif axis == "z" and scene.dimension == 2:
            yield no_such_axis(f"{key}.axis", axis, scene.dimension)
        if isinstance(probe, WaterLevelProbe):
            yield from _gauge_problems(probe, scene, key)
        if isinstance(probe, FluxProbe | VolumeBalanceProbe):
            yield from _flux_problems(probe, names, key)
        if isinstance(probe, VolumeBalanceProbe):
            yield from _wall_line_problems(probe, scene, names, key)
        if isinstance(probe, PointProbe | LineProbe):
            yield from repeated_problems(f"{key}.fields", probe.fields)


def _flux_problems(
    probe: FluxProbe | VolumeBalanceProbe, names: DeclaredNames, key: str
) -> Iterator[Problem]:
    if not names.open_boundaries:
        message = "nothing passes where the scene has no open boundary"
        yield Problem.at(f"{key}.type", message, "a scene with open_boundaries, or another probe", probe.type)
    elif isinstance(probe, VolumeBalanceProbe):
        return
    elif probe.patch is not None and probe.patch not in names.open_boundaries:
        yield unknown_name(f"{key}.patch", "open boundary", probe.patch, names.open_boundaries)


def _wall_line_problems(
    probe: VolumeBalanceProbe, scene: Scene, names: DeclaredNames, key: str
) -> Iterator[Problem]:
    if probe.walls and scene.dimension != 2:
        message = "lines enclose an area in the plane only"
        yield Problem.at(f"{key}.walls", message, "a scene in two dimensions, or no walls")
    for index, line in enumerate(probe.walls):
        if line.structure not in names.structures:
            at = f"{key}.walls.{index}.structure"
            yield unknown_name(at, "structure", line.structure, names.structures)


def _clamp_problems(probe: Probe, scene: Scene, key: str) -> Iterator[Problem]:
    match probe:
        case ReactionProbe():
            name, clamp = "clamp", probe.clamp
        case DisplacementProbe(frame=str(frame)):
            name, clamp = "frame", frame
        case _:
            return
    if probe.structure in scene.structures:
        clamps = scene.structures[probe.structure].clamps
        if clamp not in clamps:
            yield unknown_name(f"{key}.{name}", "clamp", clamp, clamps)


def _rigid_problems(probe: RigidBodyProbe, scene: Scene, key: str) -> Iterator[Problem]:
    if scene.structures[probe.structure].rigid is None:
        message = f"the structure {probe.structure!r} is flexible"
        rigid = ", ".join(name for name, structure in scene.structures.items() if structure.rigid is not None)
        allowed = rigid or "nothing: no structure of the scene is rigid"
        yield Problem.at(f"{key}.structure", message, allowed, probe.structure)


def _rotation_problems(probe: RotationProbe, scene: Scene, key: str) -> Iterator[Problem]:
    if scene.dimension == 2 and probe.axis != "z":
        yield Problem.at(f"{key}.axis", "all turns in the plane are about z", "z", probe.axis)
    across = [AXES.index(axis) for axis in AXES[: scene.dimension] if axis != probe.axis]
    if all(probe.at[k] == probe.about[k] for k in across):
        yield Problem.at(f"{key}.at", "the point lies on the axis", "a point beside it", list(probe.at))


def _kind_problems(probe: Probe, names: DeclaredNames, key: str) -> Iterator[Problem]:
    """Probes that look at everything of a kind of which the scene has nothing."""
    match probe:
        case (
            FrontProbe()
            | ReachProbe()
            | WaterLevelProbe()
            | PointProbe()
            | LineProbe()
            | EnergyProbe()
            | VolumeProbe()
        ):
            kind, there = "fluid", names.fluids
        case StructureEnergyProbe():
            kind, there = "structure", names.structures
        case _:
            return
    if not there:
        message = f"it looks at {kind}s, of which the scene has none"
        yield Problem.at(f"{key}.type", message, f"a scene with a {kind}, or another probe", probe.type)


def _set_problems(probe: Probe, names: DeclaredNames, key: str) -> Iterator[Problem]:
    fluid = getattr(probe, "fluid", None)
    if fluid is not None and fluid not in names.fluids:
        yield unknown_name(f"{key}.fluid", "fluid", fluid, names.fluids)
    match probe:
        case (
            DisplacementProbe(structure=str(structure))
            | RotationProbe(structure=str(structure))
            | ReactionProbe(structure=str(structure))
            | RigidBodyProbe(structure=str(structure))
            | StructureEnergyProbe(structure=str(structure))
            | MomentumProbe(structure=str(structure))
        ) if structure not in names.structures:
            yield unknown_name(f"{key}.structure", "structure", structure, names.structures)
        case WallPressureProbe() | ForceProbe():
            yield from _solid_problems(probe, names, key)


def _solid_problems(
    probe: WallPressureProbe | ForceProbe, names: DeclaredNames, key: str
) -> Iterator[Problem]:
    if (probe.boundary is None) == (probe.structure is None):
        message = "it looks at one boundary or at one structure"
        yield Problem.at(key, message, "either boundary or structure")
    if probe.boundary is not None and probe.boundary not in names.boundaries:
        yield unknown_name(f"{key}.boundary", "boundary", probe.boundary, names.boundaries)
    if probe.structure is not None:
        if probe.structure not in names.structures:
            yield unknown_name(f"{key}.structure", "structure", probe.structure, names.structures)
        elif not names.fluids:
            message = "no fluid acts on structures of this scene"
            yield Problem.at(f"{key}.structure", message, "a scene with a fluid", probe.structure)


def _gauge_problems(probe: WaterLevelProbe, scene: Scene, key: str) -> Iterator[Problem]:
    if len(probe.at) != scene.dimension - 1:
        message = f"{len(probe.at)} coordinates where dimension is {scene.dimension}"
        allowed = f"{scene.dimension - 1}, for the axes other than that of the level"
        yield Problem.at(f"{key}.at", message, allowed, list(probe.at))
    if probe.axis == "auto" and sum(component != 0.0 for component in scene.gravity) != 1:
        message = f"gravity {list(scene.gravity)} does not point along an axis"
        yield Problem.at(f"{key}.axis", message, ", ".join(AXES[: scene.dimension]), probe.axis)


def reference_problems(scene: Scene, names: DeclaredNames) -> Iterator[Problem]:
    """References to columns, sets and variables that the scene does not have, and tables that are none."""
    for name, reference in scene.references.items():
        key = f"references.{name}"
        match reference:
            case SeriesReference():
                yield from _column_problems(reference.column, scene, names, key)
                yield from _table_problems(reference, f"{key}.table")
            case LimitReference():
                yield from _column_problems(reference.column, scene, names, key)
                yield from _limit_problems(reference, key)
            case FieldReference():
                yield from _field_problems(reference, scene, names, key)
            case ProfileReference():
                yield from _profile_problems(reference, scene, key)
            case FeatureReference():
                yield from figure_problems(reference, scene, names, key)
                yield from _feature_problems(reference, key)


def _column_problems(column: str, scene: Scene, names: DeclaredNames, key: str) -> Iterator[Problem]:
    probe = column.partition(".")[0]
    if probe in names.probes and probe not in scene.probes:
        return  # the probe itself is refused; its columns are not known
    columns = [
        column for name, probe in scene.probes.items() for column in probe.columns(name, scene.dimension)
    ]
    if column not in columns:
        yield unknown_name(f"{key}.column", "probe column", column, columns)


def _table_problems(reference: SeriesReference, key: str) -> Iterator[Problem]:
    table = reference.table
    if not isinstance(table, InlineTable):
        return
    if len(table.time) != len(table.value):
        message = f"{len(table.value)} values for {len(table.time)} times"
        yield Problem.at(f"{key}.value", message, f"{len(table.time)} values")
    if any(later <= earlier for earlier, later in zip(table.time, table.time[1:], strict=False)):
        yield Problem.at(f"{key}.time", "the times do not increase", "increasing times [s]", list(table.time))
    if reference.relative_to == "value" and reference.at is None and 0.0 in table.value:
        message = "an error relative to the value 0 has no meaning"
        yield Problem.at(
            f"{key}.value", message, "relative_to: a number greater than 0, or times `at` elsewhere"
        )


def _limit_problems(reference: LimitReference, key: str) -> Iterator[Problem]:
    low, high = reference.low, reference.high
    if low is None and high is None:
        yield Problem.at(key, "neither low nor high is given, so everything passes", "low, high or both")
    if low is not None and high is not None and low > high:
        yield Problem.at(f"{key}.low", f"low is above high {high:g}", f"at most {high:g}", low)
    yield from _window_problems(reference.window, key)


def _window_problems(window: tuple[float, float] | None, key: str) -> Iterator[Problem]:
    if window is not None and window[0] >= window[1]:
        message = "the window ends before it begins"
        yield Problem.at(f"{key}.window", message, "[first, last] with first < last", list(window))


def figure_problems(figure: Figure, scene: Scene, names: DeclaredNames, key: str) -> Iterator[Problem]:
    """Figures of columns that the scene does not have, and windows and thresholds that make no sense."""
    yield from _column_problems(figure.column, scene, names, key)
    yield from _window_problems(figure.window, key)
    needs_threshold = figure.feature in ("arrival", "first_peak", "first_peak_time")
    if needs_threshold and figure.threshold is None:
        yield Problem.at(f"{key}.threshold", f"{figure.feature} needs it", "a number, in the column's unit")
    if figure.feature == "strouhal":
        yield from _strouhal_problems(figure, scene, key)
    if not needs_threshold and figure.threshold is not None:
        message = f"{figure.feature} has no threshold"
        yield Problem.at(f"{key}.threshold", message, "null", figure.threshold)


def _strouhal_problems(figure: Figure, scene: Scene, key: str) -> Iterator[Problem]:
    probe = scene.probes.get(figure.column.partition(".")[0])
    if probe is not None and not isinstance(probe, ForceCoefficientsProbe):
        message = "a Strouhal number needs the length and the speed of a probe of force coefficients"
        yield Problem.at(f"{key}.column", message, "a column of such a probe", figure.column)


def _feature_problems(reference: FeatureReference, key: str) -> Iterator[Problem]:
    if reference.bound is not None and reference.value is None:
        yield Problem.at(f"{key}.bound", "there is no value that it bounds", "a value, or convergence")
    if reference.convergence is not None and reference.value is not None:
        message = "the value itself is what the figure is compared with"
        yield Problem.at(f"{key}.convergence", message, "null, or no value", reference.convergence)
    if reference.value == 0.0 and reference.relative_to == "value":
        message = "an error relative to the value 0 has no meaning"
        yield Problem.at(f"{key}.value", message, "relative_to: a number greater than 0", reference.value)


def _profile_problems(reference: ProfileReference, scene: Scene, key: str) -> Iterator[Problem]:
    for name, value in (("field", reference.field), ("axis", reference.axis)):
        if value[-1] == "z" and scene.dimension == 2:
            yield no_such_axis(f"{key}.{name}", value, scene.dimension)
    table = reference.table
    if not isinstance(table, InlineProfile):
        return
    if len(table.position) != len(table.value):
        message = f"{len(table.value)} values for {len(table.position)} positions"
        yield Problem.at(f"{key}.table.value", message, f"{len(table.position)} values")
    if reference.relative_to == "value" and 0.0 in table.value:
        message = "an error relative to the value 0 has no meaning"
        yield Problem.at(f"{key}.table.value", message, "relative_to: peak, or a number greater than 0")


def _field_problems(
    reference: FieldReference, scene: Scene, names: DeclaredNames, key: str
) -> Iterator[Problem]:
    if reference.set not in names.fluids:
        yield unknown_name(f"{key}.set", "fluid", reference.set, names.fluids)
    if reference.field == "velocity_z" and scene.dimension == 2:
        yield no_such_axis(f"{key}.field", reference.field, scene.dimension)
    variables = (*AXES[: scene.dimension], "t")
    yield from expression_problems(f"{key}.expression", reference.expression, variables)
