"""A compared quantity: what a run computed, what it should be, and by how much they differ."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from warpsph.scene.references import Norm, RelativeTo

History = Mapping[str, np.ndarray]
"""Probe columns by name, each of shape (samples,), with the times [s] under `time[s]`."""


Points = tuple[tuple[float, float, float], ...]
"""Coordinate along a line [m], value there, and reference value there, of each point of a profile."""


@dataclass(frozen=True)
class Sample:
    """A value against its reference at one time [s]; the error is in the unit of the row it belongs to.

    `points` are those of a profile, which the other numbers are the norm of.
    """

    time: float
    value: float
    reference: float
    error: float
    points: Points = ()

    def as_record(self) -> dict[str, Any]:
        """The sample for JSON; `points` appear where there are some."""
        numbers = ("time", "value", "reference", "error")
        record: dict[str, Any] = {key: finite_or_none(getattr(self, key)) for key in numbers}
        points = [[finite_or_none(number) for number in point] for point in self.points]
        return record | ({"points": points} if points else {})


@dataclass(frozen=True)
class Comparison:
    """One row of the table of errors.

    `quantity` is the reference's name in the scene and `compared` the probe column or `set.field` behind it.
    `error` is relative unless `error_unit` names a unit. `lag` [s] is the fitted start-up lag, positive
    where the run is late. `samples` are the single times behind the row; `note` says why a figure is
    missing or doubtful.
    """

    quantity: str
    compared: str
    norm: Norm
    value: float
    reference: float
    error: float
    bound: float | None
    uncertainty: float
    source: str
    error_unit: str | None = None
    lag: float | None = None
    samples: tuple[Sample, ...] = ()
    note: str | None = None

    @property
    def holds(self) -> bool | None:
        """Whether the error is within the bound; None without one. An error that is no number never holds."""
        return None if self.bound is None else bool(self.error <= self.bound)

    def as_record(self) -> dict[str, Any]:
        """The row for JSON: what is not finite becomes null; unit, lag and note appear where known."""
        record: dict[str, Any] = {
            "quantity": self.quantity,
            "compared": self.compared,
            "norm": self.norm,
            "value": finite_or_none(self.value),
            "reference": finite_or_none(self.reference),
            "error": finite_or_none(self.error),
            "bound": self.bound,
            "holds": self.holds,
            "uncertainty": self.uncertainty,
            "source": self.source,
            "samples": [sample.as_record() for sample in self.samples],
        }
        optional = {"error_unit": self.error_unit, "lag": self.lag, "note": self.note}
        return record | {key: value for key, value in optional.items() if value is not None}


def finite_or_none(number: float) -> float | None:
    """The number for JSON, which knows neither NaN nor infinity."""
    return float(number) if math.isfinite(number) else None


def column_of(history: History, column: str, unroll: float | None) -> np.ndarray:
    """Values of a probe column; those that begin anew at the period `unroll` continued from the first on."""
    values = history[column]
    return values if unroll is None else np.unwrap(values, period=unroll)


def relative_errors(values: np.ndarray, references: np.ndarray, relative_to: RelativeTo) -> np.ndarray:
    """Signed errors over the reference values themselves, their largest magnitude, or a scale in their unit."""
    match relative_to:
        case "value":
            scale = np.abs(references)
        case "peak":
            scale = np.max(np.abs(references), initial=0.0)
        case _:
            scale = np.asarray(relative_to)
    with np.errstate(divide="ignore", invalid="ignore"):
        return (values - references) / scale


def representative(
    values: np.ndarray, references: np.ndarray, errors: np.ndarray, norm: Norm
) -> tuple[float, float, float]:
    """Value, reference and error of many pairs in a norm.

    max: the pair with the largest error; rms: the root mean square of each. Any error that is no number makes
    the result none, and so do no pairs at all.
    """
    if errors.size == 0:
        return math.nan, math.nan, math.nan
    if norm == "max":
        worst = int(np.argmax(np.abs(errors)))
        return float(values[worst]), float(references[worst]), float(np.abs(errors[worst]))
    value, reference, error = (float(np.sqrt(np.mean(a**2))) for a in (values, references, errors))
    return value, reference, error
