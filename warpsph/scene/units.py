"""Units of length of files."""

from __future__ import annotations

from typing import Literal

from warpsph.scene.types import PositiveReal

NamedUnit = Literal["km", "m", "dm", "cm", "mm", "um", "ft", "in"]
LengthUnit = NamedUnit | PositiveReal
"""A unit of length by its name, or its length [m]."""

_METRES: dict[str, float] = {
    "km": 1e3,
    "m": 1.0,
    "dm": 0.1,
    "cm": 1e-2,
    "mm": 1e-3,
    "um": 1e-6,
    "ft": 0.3048,
    "in": 0.0254,
}


def in_metres(unit: LengthUnit) -> float:
    """The length [m] of a unit."""
    return _METRES[unit] if isinstance(unit, str) else unit
