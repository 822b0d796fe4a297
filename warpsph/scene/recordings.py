"""What a run records over time beside probes: averages of the flow on a grid, and the paths of particles."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from warpsph.scene.types import NonNegativeReal, PositiveReal, SceneModel, Vector


class FlowStatistics(SceneModel):
    """Averages over time of velocity and pressure at the points of a grid, from every probe sample on."""

    min: Vector
    """Lower corner of the grid, its first point [m]."""

    max: Vector
    """Upper corner of the grid [m]; points stand up to it."""

    spacing: PositiveReal | None = None
    """Distance of the points [m]; null: the particle spacing. Default: null."""

    start: NonNegativeReal = 0.0
    """Time from which samples count [s]. Default: 0."""


class Paths(SceneModel):
    """Paths of the fluid particles that are nearest to given points at a given time."""

    seeds: Annotated[tuple[Vector, ...], Field(min_length=1)]
    """The points [m]."""

    at: NonNegativeReal = 0.0
    """Time at which the particles are chosen [s], at the next probe sample. Default: 0."""

    every: PositiveReal | None = None
    """Time after which the particles that are then nearest are followed, too, again and again [s]: beside an inlet, all
    together are streaklines; null: only once. Default: null."""
