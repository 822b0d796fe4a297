"""Viscosities that programs have added, by the name that a scene uses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class ViscosityLaw:
    """What the host needs of a viscosity.

    step_viscosity(nu, h, c0, *parameters): the kinematic viscosity [m^2/s] that limits the step, from that of
    the fluid, the smoothing length [m] and the sound speed [m/s].
    """

    parameters: tuple[str, ...]
    step_viscosity: Callable[..., float]


VISCOSITY_LAWS: dict[str, ViscosityLaw] = {}
"""By name; `warpsph.register_viscosity` adds to it."""
