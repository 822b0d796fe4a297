"""How accurate a figure of the result should be, in place of a choice of the spacing."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, Discriminator, Field, Tag

from warpsph.scene.references import Figure
from warpsph.scene.types import Name, PositiveReal, Real, SceneModel

_PERCENT = re.compile(r"\s*([0-9.]+(?:e[+-]?[0-9]+)?)\s*%\s*", re.IGNORECASE)


def _from_percent(value: object) -> object:
    """3% as 0.03; everything else as it is."""
    match = _PERCENT.fullmatch(value) if isinstance(value, str) else None
    try:
        return value if match is None else float(match[1]) / 100.0
    except ValueError:
        return value


def _quantity_tag(quantity: Any) -> str:
    return "(figure)" if isinstance(quantity, Mapping | BaseModel) else "(name of a reference)"


_Part = Annotated[Real, Field(gt=0.0, lt=1.0)]
Part = Annotated[
    _Part,
    BeforeValidator(_from_percent, json_schema_input_type=_Part | Annotated[str, Field(pattern="%")]),
]
"""A part of a whole, as a number or with a percent sign."""

Quantity = Annotated[
    Annotated[Figure, Tag("(figure)")] | Annotated[Name, Tag("(name of a reference)")],
    Discriminator(_quantity_tag),
]


class Accuracy(SceneModel):
    """The accuracy that is asked for: `warpsph plan` finds the spacing for it, `warpsph run --plan` takes that."""

    quantity: Quantity
    """What should be accurate: the name of a reference, or a figure of a probe column, {column, feature} with the other
    keys that feature references have for it. A series or profile counts with all its values; a field needs norm: rms;
    a limit is no such quantity."""

    within: Part
    """Largest relative discretisation error [1], its uncertainty included; 0.03 or 3%."""

    relative_to: Literal["value"] | PositiveReal = "value"
    """The error is divided by this: the quantity itself at the finest pilot (value), or a number in its unit.
    Default: value."""

    pilots: Annotated[tuple[PositiveReal, ...], Field(min_length=2, max_length=3)] | None = None
    """Particle spacings [m] of the pilots, coarse ones first; null: `spacing` over 1, 1.5 and 2. Default: null."""
