"""What a result is compared with, in which norm, within which bound, and where the figures come from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from warpsph.scene.expressions import Expression
from warpsph.scene.types import (
    Axis,
    FileName,
    Name,
    NonNegativeReal,
    PositiveInteger,
    PositiveReal,
    Real,
    SceneModel,
    Vector,
)

Norm = Literal["max", "rms"]
ReferenceField = Literal["pressure", "density", "velocity_x", "velocity_y", "velocity_z"]
Feature = Literal[
    "maximum",
    "minimum",
    "maximum_time",
    "minimum_time",
    "mean",
    "deviation",
    "change",
    "integral",
    "arrival",
    "first_peak",
    "first_peak_time",
    "period",
    "frequency",
    "strouhal",
    "amplitude",
    "centre",
    "decay_rate",
]
Bound = PositiveReal | Annotated[tuple[tuple[PositiveReal, PositiveReal], ...], Field(min_length=1)]
Times = Annotated[tuple[NonNegativeReal, ...], Field(min_length=1)]

_SAME_SPACING = 1e-6


def bound_at(bound: Bound | None, spacing: float) -> float | None:
    """The bound of a run of that spacing [m]; None where it is coarser than all that have one."""
    if not isinstance(bound, tuple):
        return bound
    coarser = [pair for pair in bound if pair[0] >= spacing * (1.0 - _SAME_SPACING)]
    return min(coarser)[1] if coarser else None


class InlineTable(SceneModel):
    """A series given in the scene itself."""

    time: Annotated[tuple[Real, ...], Field(min_length=1)]
    """Times [s], increasing."""

    value: Annotated[tuple[Real, ...], Field(min_length=1)]
    """Value at each time, in the unit of the column it is compared with."""


class FileTable(SceneModel):
    """A series in two columns of a CSV file with a header line; lines that begin with # are skipped."""

    file: FileName
    """CSV file, relative to the scene file."""

    time: str
    """Header of the column of times."""

    value: str
    """Header of the column of values."""

    time_scale: PositiveReal = 1.0
    """Factor that turns the file's times into seconds. Default: 1."""

    value_scale: Real = 1.0
    """Factor that turns the file's values into the unit of the compared column. Default: 1."""


class InlineProfile(SceneModel):
    """A profile given in the scene itself."""

    position: Annotated[tuple[Real, ...], Field(min_length=1)]
    """Coordinates along the line [m]."""

    value: Annotated[tuple[Real, ...], Field(min_length=1)]
    """Value at each of them, in the unit of the field."""


class FileProfile(SceneModel):
    """A profile in two columns of a CSV file with a header line; lines that begin with # are skipped."""

    file: FileName
    """CSV file, relative to the scene file."""

    position: str
    """Header of the column of coordinates along the line."""

    value: str
    """Header of the column of values."""

    position_scale: PositiveReal = 1.0
    """Factor that turns the file's coordinates into metres. Default: 1."""

    value_scale: Real = 1.0
    """Factor that turns the file's values into the unit of the field. Default: 1."""


def _table_tag(table: Any) -> str:
    has_file = "file" in table if isinstance(table, Mapping) else hasattr(table, "file")
    return "(table in a file)" if has_file else "(inline table)"


Table = Annotated[
    Annotated[FileTable, Tag("(table in a file)")] | Annotated[InlineTable, Tag("(inline table)")],
    Discriminator(_table_tag),
]
Profile = Annotated[
    Annotated[FileProfile, Tag("(table in a file)")] | Annotated[InlineProfile, Tag("(inline table)")],
    Discriminator(_table_tag),
]
RelativeTo = Literal["value", "peak"] | PositiveReal


class _Reference(SceneModel):
    source: Annotated[str, Field(min_length=1)]
    """Where the figures come from: authors, year, figure or table."""


class _Compared(_Reference):
    norm: Norm = "max"
    """How errors at several times or particles become one: max or rms. Default: max."""

    relative_to: RelativeTo = "value"
    """Errors are divided by this: the reference value itself (value), the largest magnitude that it has over the
    particles or points at that time, or over the times of a series (peak), or a number in its unit.
    Default: value."""

    bound: Bound | None = None
    """Largest relative error that passes [1]; a list of [particle spacing [m], bound] where it falls with the
    resolution, each bound for its spacing and finer ones; null: reported without verdict. Default: null."""

    uncertainty: NonNegativeReal = 0.0
    """Of the reference itself, relative like the error [1]. Default: 0."""


class SeriesReference(_Compared):
    """A probe column over time against a table."""

    type: Literal["series"] = "series"
    column: str
    """The probe column, such as front.position[m]."""

    table: Table
    """The reference series: {time, value} inline, or {file, time, value} for columns of a CSV file."""

    at: Times | None = None
    """Times of comparison [s]; null: those of the table. Default: null."""

    unroll: PositiveReal | None = None
    """The column begins anew at this period, as an angle does at 2 pi; it is continued from its first value on, in the
    unit of the column; null: it does not. Default: null."""

    lag: Literal["none", "fit"] = "none"
    """fit: shift the reference by the start-up lag that fits best, and state it. Default: none."""


class FieldReference(_Compared):
    """A field of all particles of a fluid against an expression."""

    type: Literal["field"] = "field"
    set: Name
    """The fluid."""

    field: ReferenceField
    """The field: pressure [Pa], density [kg/m3], velocity_x, velocity_y or velocity_z [m/s]."""

    expression: Expression
    """Its exact value as a formula in x, y, z [m] and t [s]."""

    at: Times | None = None
    """Times of comparison [s], each at the nearest frame; null: the end. Default: null."""


class ProfileReference(_Compared):
    """A fluid field along a straight line, interpolated to first order, against a table."""

    type: Literal["profile"] = "profile"
    field: ReferenceField
    """The field: pressure [Pa], density [kg/m3], velocity_x, velocity_y or velocity_z [m/s]."""

    through: Vector
    """A point of the line [m]; its coordinate along `axis` does not matter."""

    axis: Axis
    """Direction of the line. Positions of the table are coordinates along it."""

    table: Profile
    """The reference profile: {position, value} inline, or {file, position, value} for columns of a CSV file."""

    at: Times | None = None
    """Times of comparison [s], each at the nearest frame; null: the end. Default: null."""


class Figure(SceneModel):
    """One figure that is taken from a probe column."""

    column: str
    """The probe column, such as energy.kinetic[J]."""

    feature: Feature
    """maximum, minimum, mean or deviation, the standard one [unit of the column]; maximum_time and minimum_time, when
    they are [s], between samples by a parabola; change: last value less the first [unit of the column]; integral over
    time [unit s]; arrival: first time at which the column
    reaches `threshold` [s]; first_peak: largest value from the arrival until the column has fallen below half of it,
    and first_peak_time, when that is [s]; period: mean time between upward passages of the mean value [s], frequency:
    one over it [1/s], and strouhal: frequency times length over speed, both of the probe of force coefficients that the
    column belongs to [1]; amplitude: half of the largest less the smallest value, and centre: half of their sum [unit
    of the column]; decay_rate: k of the exponential exp(-k t) that fits best [1/s]."""

    window: tuple[NonNegativeReal, NonNegativeReal] | None = None
    """First and last time [s]; null: the whole run. Default: null."""

    periods: PositiveInteger | None = None
    """Only the last so many whole periods in the window count, from one upward passage of the mean value to another;
    null: the whole window. Default: null."""

    average: PositiveReal | None = None
    """The column is averaged over this time about each sample first [s]; null: it is taken as it is. Default: null."""

    unroll: PositiveReal | None = None
    """The column begins anew at this period, as an angle does at 2 pi; it is continued from its first value on, in the
    unit of the column; null: it does not. Default: null."""

    threshold: Real | None = None
    """Value of the column that counts as arrival; for arrival and first peaks. Default: null."""


class FeatureReference(Figure, _Reference):
    """One figure that is taken from a probe column, against a value or against the next coarser resolution."""

    type: Literal["feature"] = "feature"
    value: Real | None = None
    """What the figure should be, in its unit; null: reported only. Default: null."""

    relative_to: Literal["value"] | PositiveReal = "value"
    """The error is divided by this: the reference value itself, or a number in its unit. Default: value."""

    bound: Bound | None = None
    """Largest relative error that passes [1]; a list of [particle spacing [m], bound] where it falls with the
    resolution, each bound for its spacing and finer ones; null: reported without verdict. Default: null."""

    uncertainty: NonNegativeReal = 0.0
    """Of the reference itself, relative like the error [1]. Default: 0."""

    convergence: PositiveReal | None = None
    """In place of `value`: largest relative change [1] from the second finest to the finest resolution of a
    validation. Default: null."""


class LimitReference(_Reference):
    """A probe column stays between limits over a window of time."""

    type: Literal["limit"] = "limit"
    column: str
    """The probe column, such as energy.kinetic[J]."""

    window: tuple[NonNegativeReal, NonNegativeReal] | None = None
    """First and last time [s]; null: the whole run. Default: null."""

    low: Real | None = None
    """Smallest value that passes; null: no limit. Default: null."""

    high: Real | None = None
    """Largest value that passes; null: no limit. Default: null."""


Reference = Annotated[
    SeriesReference | FieldReference | ProfileReference | FeatureReference | LimitReference,
    Field(discriminator="type"),
]
