"""What a result is compared with, in which norm, within which bound, and where the figures come from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from warpsph.scene.expressions import Expression
from warpsph.scene.types import FileName, Name, NonNegativeReal, PositiveReal, Real, SceneModel

Norm = Literal["max", "rms"]
ReferenceField = Literal["pressure", "density", "velocity_x", "velocity_y", "velocity_z"]
Times = Annotated[tuple[NonNegativeReal, ...], Field(min_length=1)]


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


def _table_tag(table: Any) -> str:
    has_file = "file" in table if isinstance(table, Mapping) else isinstance(table, FileTable)
    return "(table in a file)" if has_file else "(inline table)"


Table = Annotated[
    Annotated[FileTable, Tag("(table in a file)")] | Annotated[InlineTable, Tag("(inline table)")],
    Discriminator(_table_tag),
]


class _Reference(SceneModel):
    source: Annotated[str, Field(min_length=1)]
    """Where the figures come from: authors, year, figure or table."""


class _Compared(_Reference):
    norm: Norm = "max"
    """How errors at several times or particles become one: max or rms. Default: max."""

    relative_to: Literal["value"] | PositiveReal = "value"
    """Errors are divided by this: the reference value itself, or a number in its unit. Default: value."""

    bound: PositiveReal | None = None
    """Largest relative error that passes [1]; null: reported without verdict. Default: null."""

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


Reference = Annotated[SeriesReference | FieldReference | LimitReference, Field(discriminator="type")]
