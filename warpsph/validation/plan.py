"""From pilots to a spacing: what accuracy a figure is expected to have at which spacing, and what that costs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from warpsph.validation.order import observed_order
from warpsph.validation.richardson import Extrapolation, extrapolate

PILOT_CELLS = (1.0, 1.5, 2.0)
"""Particles along a length over those of the coarsest pilot: what holds an even number of them holds whole ones."""

FAR = 4.0
"""A spacing this many times finer than the finest pilot is a guess rather than a forecast."""


@dataclass(frozen=True)
class Pilot:
    """A run at one spacing [m]: its figure, shape (values,), and its cost.

    `bytes_per_particle` is what a particle takes on the device; `machine` says in words where it ran, maybe earlier.
    """

    spacing: float
    figure: np.ndarray
    wall_seconds: float
    particles: int
    steps: int
    bytes_per_particle: float
    machine: str

    @property
    def memory_bytes(self) -> float:
        """Memory on the device [bytes]."""
        return self.particles * self.bytes_per_particle


@dataclass(frozen=True)
class Proposal:
    """A spacing [m] with the relative error to expect, its convergence index, and what the run would take.

    `wall_seconds` grows from that of the finest pilot with the particle-steps, on its `machine`.
    """

    spacing: float
    error: float
    uncertainty: float
    particles: float
    steps: float
    wall_seconds: float
    memory_bytes: float
    machine: str


@dataclass(frozen=True)
class Plan:
    """Pilots, coarse first, what they say, and what follows; `advice` says what to do or to mind.

    Errors are relative to `scale`, in the unit of the figure. Without a proposal the pilots do not allow one.
    """

    within: float
    scale: float
    pilots: tuple[Pilot, ...]
    extrapolation: Extrapolation
    proposal: Proposal | None
    advice: str | None

    def error_of(self, pilot: Pilot) -> float | None:
        """Relative error of a pilot against the extrapolated figure."""
        error = self.extrapolation.error_of(pilot.figure)
        return None if error is None or not self.scale else error / self.scale

    def as_record(self) -> dict[str, Any]:
        """The plan for JSON."""
        found = self.extrapolation
        limit = None if found.limit is None else plain_figure(found.limit)
        return {
            "within": self.within,
            "behaviour": found.behaviour,
            "observed_order": found.observed,
            "observed_order_uncertainty": found.order_uncertainty,
            "order": found.order,
            "extrapolated_value": limit,
            "scale": self.scale,
            "pilots": [_pilot_record(pilot, self.error_of(pilot)) for pilot in self.pilots],
            "proposal": None if self.proposal is None else vars(self.proposal),
            "advice": self.advice,
        }


def pilot_spacings(coarsest: float) -> tuple[float, ...]:
    """Spacings [m] of the pilots where a scene names none: ratios 1.5 and 1.33."""
    return tuple(coarsest / cells for cells in PILOT_CELLS)


def plan_from(pilots: Sequence[Pilot], within: float, scale: float | None = None) -> Plan:
    """The coarsest spacing at which the figure is expected within that relative error, uncertainty included.

    Spacings are those of the coarsest pilot over 1, 1.5, 2, 2.5 and so on. `scale` is what errors are divided by, in
    the unit of the figure; None: the figure of the finest pilot. Raises ValueError as `extrapolate` does.
    """
    found = extrapolate([pilot.spacing for pilot in pilots], [pilot.figure for pilot in pilots])
    scale = found.scale if scale is None else scale
    spacing = _sufficient_spacing(pilots, found, within * scale)
    if spacing is None:
        return Plan(within, scale, tuple(pilots), found, None, _way_out(pilots, found, scale))
    proposal = _proposal(pilots, found, spacing, scale)
    return Plan(within, scale, tuple(pilots), found, proposal, _caution(pilots, found, spacing))


def _sufficient_spacing(pilots: Sequence[Pilot], found: Extrapolation, allowed: float) -> float | None:
    """The spacing [m] at which the uncertainty, in the unit of the figure, is as allowed; None if there is none."""
    coarsest, finest = pilots[0].spacing, pilots[-1].spacing
    if found.order is None:
        return finest if found.uncertainty <= allowed else None
    for halves in range(2, math.floor(2.0 * coarsest / finest * (1.0 + 1e-9)) + 1):
        spacing = 2.0 * coarsest / halves
        if _expected_error(pilots, found, spacing) * found.safety <= allowed:
            return spacing
    if allowed == 0.0:
        return None
    needed = finest * (allowed / found.uncertainty) ** (1.0 / found.order)
    return 2.0 * coarsest / math.ceil(2.0 * coarsest / needed * (1.0 - 1e-9))


def _expected_error(pilots: Sequence[Pilot], found: Extrapolation, spacing: float) -> float:
    """Error at a spacing [m], in the unit of the figure: by the power law, but not less than what finer pilots have."""
    if found.order is None:
        return found.error
    finer = (found.error_of(pilot.figure) for pilot in pilots if pilot.spacing <= spacing * (1.0 + 1e-9))
    return max(found.error * found.growth(spacing), *(error or 0.0 for error in finer), 0.0)


def _proposal(pilots: Sequence[Pilot], found: Extrapolation, spacing: float, scale: float) -> Proposal:
    error = _expected_error(pilots, found, spacing) / scale
    finest = pilots[-1]
    particles = _continued(pilots, [pilot.particles for pilot in pilots], spacing)
    steps = _continued(pilots, [pilot.steps for pilot in pilots], spacing)
    return Proposal(
        spacing=spacing,
        error=error,
        uncertainty=error * found.safety,
        particles=particles,
        steps=steps,
        wall_seconds=finest.wall_seconds * particles * steps / (finest.particles * finest.steps),
        memory_bytes=particles * finest.bytes_per_particle,
        machine=finest.machine,
    )


def _continued(pilots: Sequence[Pilot], counts: Sequence[int], spacing: float) -> float:
    """A count at another spacing, by the power law through all pilots, from the finest of them."""
    law = observed_order([pilot.spacing for pilot in pilots], [float(count) for count in counts])
    return counts[-1] * (spacing / pilots[-1].spacing) ** (law.order if law else 0.0)


def _way_out(pilots: Sequence[Pilot], found: Extrapolation, scale: float) -> str:
    """What to do where no spacing can be proposed."""
    if scale == 0.0:
        return "the figure is zero, so that no error is relative to it: give accuracy.relative_to in its unit"
    finer = ", ".join(f"{pilot.spacing / 2.0:.4g}" for pilot in pilots)
    reasons = {
        "oscillating": "the figure goes up and down with the spacing",
        "diverging": "the figure changes more with each finer spacing",
    }
    reason = reasons.get(
        found.behaviour, f"the figure changes with the order {found.observed or 0.0:.2f} only"
    )
    return (
        f"{reason}: the pilots are too coarse for it, or it follows single particles. Try finer pilots, "
        f"accuracy.pilots: [{finer}], or a steadier figure: an average, a mean or an integral in place of a peak"
    )


def _caution(pilots: Sequence[Pilot], found: Extrapolation, spacing: float) -> str | None:
    """What to mind about a proposal."""
    finest = pilots[-1].spacing
    if found.order is None:
        return (
            f"the pilots do not converge ({found.behaviour}), but lie within the target of each other: the finest "
            "of them is proposed"
        )
    if finest / spacing > FAR * (1.0 + 1e-9):
        finer = ", ".join(f"{pilot.spacing / 2.0:.4g}" for pilot in pilots)
        return (
            f"the spacing is {finest / spacing:.3g} times finer than the finest pilot: a guess; pilots nearer to it, "
            f"accuracy.pilots: [{finer}], make it a forecast"
        )
    if found.observed is None:
        return f"the order {found.order:g} is assumed; a third pilot would show it"
    return None


def _pilot_record(pilot: Pilot, error: float | None) -> dict[str, Any]:
    return {
        "spacing": pilot.spacing,
        "value": plain_figure(pilot.figure),
        "error": error,
        "wall_seconds": pilot.wall_seconds,
        "machine": pilot.machine,
        "particles": pilot.particles,
        "steps": pilot.steps,
        "memory_bytes": pilot.memory_bytes,
    }


def plain_figure(figure: np.ndarray) -> float | list[float]:
    """A figure for JSON: one number, or a list of several."""
    return float(figure[0]) if len(figure) == 1 else [float(value) for value in figure]
