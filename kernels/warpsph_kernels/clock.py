"""The clock of a run: what the state allows as the next step, chosen on the device.

Two passes without atomics: `survey` writes the extremes of blocks of particles, `choose_step` reduces them in one
thread, applies the limits and advances the time.
"""

from functools import cache
from typing import Any, NamedTuple

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic, make_packing
from warpsph_kernels.state import STATES

BLOCK = 256
"""Particles a thread of `survey` reads."""

STEP, TIME, TARGET, SPEED, ACCELERATION, DISPLACEMENT, COMPRESSION, RULING, FAULTS = range(9)
"""Entries of the clock, all float64: step [s], time [s], time to land on [s], largest speed [m/s], acceleration
[m/s^2] and displacement since the last list [m], largest |rho/rho0 - 1|, index of the limit that rules, number of
particles whose state is not finite."""
CLOCK_SIZE = 9

LIMITS = ("acoustic", "force", "viscous", "max_step", "frame")
ACOUSTIC, FORCE, VISCOUS, MAX_STEP, FRAME = range(5)


_DOUBLE = {dimension: Arithmetic(dimension, "double") for dimension in (2, 3)}
STATE_PARAMETERS = _DOUBLE[2].parameters
"""Type of the parameters of the state, which the step choice takes in double precision."""


class ClockKernels(NamedTuple):
    """Kernels of the step choice, in the order of their use."""

    survey: Any
    choose_step: Any
    module: str


@wp.struct
class StepLimits:
    """Numbers behind the limits: CFL number, h [m], rho0 [kg/m^dim], c0 [m/s], the parameters of the state, kinematic
    viscosity [m^2/s], cap [s]."""

    cfl: wp.float64
    smoothing_length: wp.float64
    rest_density: wp.float64
    sound_speed: wp.float64
    state_parameters: STATE_PARAMETERS
    viscosity: wp.float64
    max_step: wp.float64


@cache
def make_clock_kernels(arithmetic: Arithmetic, state: str) -> ClockKernels:
    """Return the kernels of the step choice for an equation of state by its name."""
    stiffening = STATES[state].make_stiffening(_DOUBLE[arithmetic.dimension])
    real, vector, record = arithmetic.real, arithmetic.vector, arithmetic.record
    module = f"warpsph_clock_{state}_{arithmetic.label}"
    _, unpack = make_packing(arithmetic)

    @wp.kernel(module=module, enable_backward=False)
    def survey(
        offset: int,
        first: int,
        count: int,
        first_row: int,
        rest_density: real,
        density_deviation: wp.array(dtype=real),
        position_density: wp.array(dtype=record),
        listed_position: wp.array(dtype=vector),
        velocity_volume: wp.array(dtype=record),
        acceleration: wp.array(dtype=vector),
        extremes: wp.array2d(dtype=real),
    ):
        """One block of particles: its largest v^2, a^2, squared displacement, |rho/rho0 - 1|, and its faults."""
        block = offset + wp.tid()
        speed = real(0.0)
        acc = real(0.0)
        moved = real(0.0)
        compression = real(0.0)
        faults = real(0.0)
        for k in range(wp.static(BLOCK)):
            i = block * wp.static(BLOCK) + k
            if i < count:
                a = first + i
                deviation = density_deviation[a]
                v = unpack(velocity_volume[a])
                d = unpack(position_density[a]) - listed_position[a]
                v2 = wp.dot(v, v)
                a2 = wp.dot(acceleration[a], acceleration[a])
                d2 = wp.dot(d, d)
                if wp.isfinite(v2 + a2 + d2 + deviation):
                    speed = wp.max(speed, v2)
                    acc = wp.max(acc, a2)
                    moved = wp.max(moved, d2)
                    compression = wp.max(compression, wp.abs(deviation) / rest_density)
                else:
                    faults += real(1.0)
        row = first_row + block
        extremes[row, 0] = speed
        extremes[row, 1] = acc
        extremes[row, 2] = moved
        extremes[row, 3] = compression
        extremes[row, 4] = faults

    @wp.kernel(module=module, enable_backward=False)
    def choose_step(
        offset: int,
        rows: int,
        extremes: wp.array2d(dtype=real),
        limits: StepLimits,
        clock: wp.array(dtype=wp.float64),
    ):
        """One thread: the next step from the extremes, and the time at its end.

        Acoustic: cfl h / (c + v); force: cfl sqrt(h / a); viscous: h^2 / (8 nu) (Monaghan 1992; Morris,
        Fox & Zhu 1997). The sound speed is that at the largest compression, and not below c0.
        Two steps or less before the target, the step is shortened to land on it.
        """
        peak = wp.vector(dtype=wp.float64, length=5)
        for row in range(rows):
            for k in range(4):
                peak[k] = wp.max(peak[k], wp.float64(extremes[row, k]))
            peak[4] += wp.float64(extremes[row, 4])
        speed = wp.sqrt(peak[0])
        acc = wp.sqrt(peak[1])
        h = limits.smoothing_length
        rho0 = limits.rest_density
        stiff = stiffening(peak[3] * rho0, rho0, limits.sound_speed, limits.state_parameters)
        step = limits.cfl * h / (limits.sound_speed * wp.sqrt(wp.max(stiff, wp.float64(1.0))) + speed)
        ruling = wp.static(ACOUSTIC)
        force_step = limits.cfl * wp.sqrt(h / wp.max(acc, wp.float64(1.0e-30)))
        if force_step < step:
            step = force_step
            ruling = wp.static(FORCE)
        if limits.viscosity > wp.float64(0.0):
            viscous_step = wp.float64(0.125) * h * h / limits.viscosity
            if viscous_step < step:
                step = viscous_step
                ruling = wp.static(VISCOUS)
        if limits.max_step < step:
            step = limits.max_step
            ruling = wp.static(MAX_STEP)
        time = clock[wp.static(TIME)]
        target = clock[wp.static(TARGET)]
        left = target - time
        next_time = time + step
        if left <= step:
            step = left
            next_time = target
            ruling = wp.static(FRAME)
        elif left < wp.float64(2.0) * step:
            step = wp.float64(0.5) * left
            next_time = time + step
            ruling = wp.static(FRAME)
        clock[wp.static(STEP)] = step
        clock[wp.static(TIME)] = next_time
        clock[wp.static(SPEED)] = speed
        clock[wp.static(ACCELERATION)] = acc
        clock[wp.static(DISPLACEMENT)] = wp.sqrt(peak[2])
        clock[wp.static(COMPRESSION)] = peak[3]
        clock[wp.static(RULING)] = wp.float64(ruling)
        clock[wp.static(FAULTS)] = peak[4]

    return ClockKernels(survey, choose_step, module)
