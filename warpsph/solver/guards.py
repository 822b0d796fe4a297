"""What stops a run: a state in which the scheme means nothing any more."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from warpsph.particles.state import host_view
from warpsph.sampling import SampledSet
from warpsph.solver.assemble import Parts
from warpsph.solver.errors import SimulationDiverged
from warpsph.solver.step import Stepper
from warpsph.solver.system import StepReport

LARGEST_MACH = 2.0
"""Speed over sound speed at which a weakly compressible run is stopped."""
LARGEST_COMPRESSION = 0.5
"""rho/rho0 - 1 at which it is stopped."""
LARGEST_EXPANSION = 0.95
"""1 - rho/rho0 at which it is stopped. A drop that leaves the bulk alone loses the density of its former
neighbours, which is more than half of its own, and means no harm."""


def check_state(
    stepper: Stepper, parts: Parts, sets: Sequence[SampledSet], step_count: int, report: StepReport
) -> None:
    """Raise SimulationDiverged if the state that the step began with is out of range."""
    c = parts.assembly.constants
    if stepper.faults:
        _stop(parts, sets, stepper, step_count, report, "a value is not finite", _not_finite(parts))
    if stepper.speed > LARGEST_MACH * c.sound_speed:
        speed = np.linalg.norm(_velocity(parts), axis=1)
        _stop(
            parts,
            sets,
            stepper,
            step_count,
            report,
            f"its speed exceeds {LARGEST_MACH:g} times the sound speed",
            speed,
        )
    if stepper.compression > LARGEST_COMPRESSION:
        _check_density(parts, sets, stepper, step_count, report)


def _check_density(
    parts: Parts, sets: Sequence[SampledSet], stepper: Stepper, step_count: int, report: StepReport
) -> None:
    deviation = host_view(parts.assembly.state.density_deviation) / parts.assembly.constants.rest_density
    compression, expansion = _of_the_living(parts, deviation), _of_the_living(parts, -deviation)
    if compression.max() > LARGEST_COMPRESSION:
        limit = f"its density is above that at rest by more than {LARGEST_COMPRESSION:.0%}"
        _stop(parts, sets, stepper, step_count, report, limit, compression)
    if expansion.max() > LARGEST_EXPANSION:
        limit = f"its density is below that at rest by more than {LARGEST_EXPANSION:.0%}"
        _stop(parts, sets, stepper, step_count, report, limit, expansion)


def _of_the_living(parts: Parts, measure: np.ndarray) -> np.ndarray:
    """Return a measure without particles that left the kill box, whose last state stays behind the living."""
    living = measure.copy()
    living[parts.fluid.count : parts.assembly.layout.fluids] = -np.inf
    return living


def _velocity(parts: Parts) -> np.ndarray:
    return host_view(parts.assembly.state.velocity_volume)[:, :-1]


def _not_finite(parts: Parts) -> np.ndarray:
    state = parts.assembly.state
    total = _velocity(parts).sum(axis=1) + host_view(state.acceleration).sum(axis=1)
    total = total + host_view(state.density_deviation) + host_view(state.position).sum(axis=1)
    return np.where(np.isfinite(total), 0.0, np.inf)


def _stop(
    parts: Parts,
    sets: Sequence[SampledSet],
    stepper: Stepper,
    step_count: int,
    report: StepReport,
    limit: str,
    measure: np.ndarray,
) -> None:
    state = parts.assembly.state
    worst = int(np.argmax(_of_the_living(parts, measure)))
    found = float(measure[worst])
    raise SimulationDiverged(
        set=sets[int(host_view(state.set_index)[worst])].name,
        particle=int(host_view(state.id)[worst]),
        position=tuple(float(x) for x in host_view(state.position)[worst]),
        time=stepper.time - report.dt,
        step=step_count,
        limit=limit,
        value=found if math.isfinite(found) else math.nan,
        advice="Try a smaller time.cfl or spacing, a higher numerics.sound_speed, or more viscosity.",
    )
