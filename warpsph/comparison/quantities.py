"""What of a run can be followed to finer spacings: the values of its figures and of its references."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from warpsph.comparison.features import feature_unit, figure_of
from warpsph.comparison.fields import field_unit
from warpsph.comparison.limits import unit_of
from warpsph.comparison.row import History
from warpsph.scene.accuracy import Quantity
from warpsph.scene.references import (
    FeatureReference,
    FieldReference,
    LimitReference,
    ProfileReference,
    Reference,
    SeriesReference,
)
from warpsph.scene.schema import Scene

Row = Mapping[str, Any]


def converging_references(scene: Scene) -> dict[str, Reference]:
    """References whose computed values have a limit at fine spacings.

    A limit is kept or not; the largest error of a field is at one particle here and at another one there.
    """
    return {
        name: reference
        for name, reference in scene.references.items()
        if not isinstance(reference, LimitReference)
        and not (isinstance(reference, FieldReference) and reference.norm == "max")
    }


def values_of(quantity: Quantity, scene: Scene, history: History, rows: Mapping[str, Row]) -> np.ndarray:
    """Computed values of a quantity, shape (values,), not numbers where the run has none.

    Of a series the values at all times of comparison, of a profile those at all its points, of a field its root mean
    squares over the particles. `rows` are the records of the comparison by their quantities. Raises KeyError where a
    column or a row is missing.
    """
    if not isinstance(quantity, str):
        return np.array([figure_of(quantity, scene, history)[0]])
    row, reference = rows[quantity], scene.references[quantity]
    match reference:
        case FeatureReference() | LimitReference():
            values = [row["value"]]
        case ProfileReference():
            values = [value for sample in row["samples"] for _, value, _ in sample.get("points", ())]
        case _:
            values = [sample["value"] for sample in row["samples"]]
    return np.array([math.nan if value is None else value for value in values or [None]])


def unit_of_quantity(quantity: Quantity, scene: Scene) -> str:
    """The unit of its values."""
    if not isinstance(quantity, str):
        return feature_unit(quantity)
    match scene.references[quantity]:
        case FeatureReference() as reference:
            return feature_unit(reference)
        case FieldReference() | ProfileReference() as reference:
            return field_unit(reference.field)
        case SeriesReference() | LimitReference() as reference:
            return unit_of(reference.column)


def name_of(quantity: Quantity) -> str:
    """The quantity in words."""
    return quantity if isinstance(quantity, str) else f"{quantity.feature} of {quantity.column}"
