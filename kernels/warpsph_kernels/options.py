"""Everything that selects fluid and wall code."""

import hashlib
from dataclasses import dataclass

from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.wall_barriers import BARRIERS


@dataclass(frozen=True)
class FluidOptions:
    """Everything that selects fluid and wall code; numbers are in the constants struct instead."""

    arithmetic: Arithmetic
    periodic: tuple[bool, ...]
    smoothing: str
    state: str
    pressure_form: str
    density_diffusion: str
    viscosity: str
    wall: str
    """Wall method: none, dynamic, extrapolated, modified_dynamic or repulsive."""
    wall_suction: bool
    """Whether walls that are not dynamic may have negative pressure."""
    wall_friction: bool
    """Whether some wall is no-slip, so that viscosity acts on pairs of fluid and wall."""
    stress: str = "none"
    """What the viscous stress tensor is made of: none, a law of `warpsph_kernels.rheology`, or sub_particle_scale."""
    particle_order: str = "none"
    """What spreads the particles evenly: none, transport_velocity or shifting."""
    density_follows: bool = False
    """Whether the density follows where shifts bring particles together."""
    density: str = "continuity"
    """Where the density comes from: continuity, summation or mixed."""
    kernel_gradient: str = "plain"
    """First derivatives of pressure and velocity: plain, renormalised or finite_particle."""
    background_pressure: bool = False
    """Whether every pair repels with a pressure that is added to that of the state."""
    tension_cutoff: bool = False
    """Whether the pressure has a lowest value."""
    lanes: int = 1
    """Neighbours that a pair loop takes at a time, see `lanes`."""

    @property
    def has_barrier(self) -> bool:
        """Whether wall surfaces push back particles that come too near."""
        return self.wall in BARRIERS

    @property
    def module(self) -> str:
        """Name of the kernel module of these options, the same in every process so that its binary is reused."""
        digest = hashlib.sha256(repr(self).encode()).hexdigest()[:10]
        return f"warpsph_fluid_{self.arithmetic.label}_{digest}"

    def module_of(self, concept: str) -> str:
        """Name of the module of kernels that only some scenes have."""
        return f"{self.module}_{concept}"
