"""All hard cases, in the order in which they run."""

from __future__ import annotations

from warpsph.validation.hard import (
    coupled,
    few_particles,
    fluids,
    invariance,
    open_boundaries,
    steps,
    structures,
)
from warpsph.validation.hard.case import HardCase

HARD_CASES: tuple[HardCase, ...] = tuple(
    HardCase(measure)
    for module in (fluids, open_boundaries, structures, coupled, few_particles, invariance, steps)
    for measure in module.CASES
)
"""Every case once; its name is that of its function."""
