"""Convergence studies: the relative error of one quantity over resolutions, and what each error cost."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

from warpsph.validation.convergence import is_change
from warpsph.validation.options import options_in_words
from warpsph.validation.order import ObservedOrder, observed_order

Row = Mapping[str, Any]
Cost = Literal["wall_seconds", "particle_steps"]


@dataclass(frozen=True)
class Point:
    """An error [1] and what it cost at one particle spacing [m]; what a run does not know is None.

    `particle_steps` counts particles times steps, walls included.
    """

    resolution: float
    error: float | None
    uncertainty: float
    wall_seconds: float | None
    particle_steps: float | None

    @property
    def at_uncertainty(self) -> bool:
        """Whether the run agrees with the reference as well as the reference itself is known."""
        return self.error is not None and self.error <= self.uncertainty and self.uncertainty > 0.0

    @property
    def quoted(self) -> float | None:
        """The error that may be claimed [1]: never less than the uncertainty of the reference."""
        return None if self.error is None else max(self.error, self.uncertainty)


@dataclass(frozen=True)
class Study:
    """One quantity of a scene with one choice of the compared options, coarse resolutions first."""

    scene: str
    quantity: str
    options: Mapping[str, str]
    points: tuple[Point, ...]

    @property
    def finest(self) -> Point:
        """The point of the smallest spacing."""
        return self.points[-1]

    @property
    def label(self) -> str:
        """The options as `key=value`, empty without any."""
        return options_in_words(self.options)

    @cached_property
    def order(self) -> ObservedOrder | None:
        """Exponent of the error over the spacing, from the errors above the uncertainty of the reference.

        Below it an error tells about the reference as much as about the run.
        """
        return _exponent([(p, math.nan if p.at_uncertainty else p.error) for p in self.points])

    @cached_property
    def cost_order(self) -> ObservedOrder | None:
        """Exponent of the particle-steps over the spacing; negative, since fine runs cost more.

        Wall times of small runs are those of what does not grow with them, and vary with the load of the machine.
        """
        return _exponent([(p, p.particle_steps) for p in self.points])


def studies_of(rows: Iterable[Row]) -> tuple[Study, ...]:
    """The studies in rows of a validation, in the order of their first rows.

    Violated limits, which have a unit, and changes with the resolution are no errors against a reference: they make no
    study, nor do figures that are only reported.
    """
    points: dict[tuple[Any, ...], list[Point]] = {}
    for row in rows:
        if not row.get("error_unit") and not is_change(row):
            points.setdefault(_identity(row), []).append(_point(row))
    return tuple(
        Study(scene, quantity, dict(options), tuple(sorted(own, key=lambda p: -p.resolution)))
        for (scene, options, quantity), own in points.items()
        if any(point.error is not None for point in own)
    )


def efficient(costs: Sequence[float | None], errors: Sequence[float | None]) -> list[bool]:
    """Whether each pair of cost and error is on the efficient front: none is better in one and as good in the other."""
    pairs = list(zip(costs, errors, strict=True))
    known = [(c, e) for c, e in pairs if c is not None and e is not None]

    def beaten(cost: float, error: float) -> bool:
        return any(c <= cost and e <= error and (c, e) != (cost, error) for c, e in known)

    return [c is not None and e is not None and not beaten(c, e) for c, e in pairs]


def on_front(studies: Sequence[Study], cost: Cost) -> list[list[bool]]:
    """For each point of studies of the same quantity whether it is on their common efficient front."""
    points = [point for study in studies for point in study.points]
    flags = iter(efficient([getattr(point, cost) for point in points], [point.quoted for point in points]))
    return [[next(flags) for _ in study.points] for study in studies]


def _identity(row: Row) -> tuple[str, tuple[tuple[str, str], ...], str]:
    return row["scene"], tuple((row.get("options") or {}).items()), row["quantity"]


def _point(row: Row) -> Point:
    steps, particles = row["steps"], row["particles"]
    return Point(
        resolution=row["resolution"],
        error=row["error"],
        uncertainty=row.get("uncertainty") or 0.0,
        wall_seconds=row["wall_seconds"],
        particle_steps=None if steps is None or particles is None else float(steps * particles),
    )


def _exponent(values: Sequence[tuple[Point, float | None]]) -> ObservedOrder | None:
    known = [math.nan if value is None else value for _, value in values]
    return observed_order([point.resolution for point, _ in values], known)
