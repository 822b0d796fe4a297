"""Walls: what the fluid sees of them, and the force on them. What moves them is elsewhere."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.boundary import make_wall_kernels

from warpsph.particles.launch import Pass
from warpsph.particles.state import host_view, write_array
from warpsph.physics.assembly import Assembly, WallRange, WallSurface
from warpsph.physics.mirrored_walls import MirroredWalls

Reaction = Callable[[WallRange, wp.array], None]
"""Adds to the force on each wall particle [N] what acts beside pair forces."""


class WallModel:
    """The passes of a range of wall particles, by the wall method of the scene.

    Args:
        label: `wall`, or `face` of a structure; names arrays and stages.
        mirror: mirror points of modified dynamic walls.
    """

    def __init__(
        self,
        assembly: Assembly,
        walls: WallRange,
        label: str,
        fluid_reaction: Reaction,
        mirror: MirroredWalls | None = None,
    ) -> None:
        self.walls = walls
        self._label = label
        self._mirror = mirror
        self._fluid_reaction = fluid_reaction
        self._assembly = assembly
        self._kernels = make_wall_kernels(assembly.options)
        arithmetic, device = assembly.options.arithmetic, assembly.launcher.device
        self.force = wp.zeros(max(walls.count, 1), dtype=arithmetic.vector, device=device)
        self.bind_lists()

    @property
    def own_arrays(self) -> dict[str, wp.array]:
        """Arrays of shape (count,) that follow the order of the particles and belong into a checkpoint."""
        mirror = {f"{self._label}_mirror": self._mirror.ways} if self._mirror else {}
        return mirror | {f"{self._label}_friction": self.walls.surface.friction}

    @property
    def method(self) -> str:
        return self._assembly.options.wall

    def impose(self) -> None:
        """Set the pressure and the friction velocity that the fluid sees at the walls."""
        self._impose.run(self.walls.count)

    def update_density(self) -> None:
        """Advance the density of dynamic walls; other walls have none."""
        if self.method == "dynamic":
            self._update_density.run(self.walls.count)

    def synchronise(self) -> None:
        """Bring the wall pressure to the time of the fluid, without advancing anything."""
        if self.method == "dynamic":
            self._show.run(self.walls.count)
        else:
            self._impose.run(self.walls.count)

    def start(self) -> None:
        """Give dynamic walls the density at which they are in equilibrium with the fluid before them."""
        if self.method != "dynamic":
            return
        a, first, count = self._assembly, self.walls.first, self.walls.count
        self._extrapolation().run(count)
        pressure = host_view(a.scratch.position_pressure)[first : first + count, -1].astype(np.float64)
        deviation = a.density_deviation(np.maximum(pressure, 0.0))
        write_array(a.state.density_deviation[first:], deviation)

    def react(self) -> wp.array:
        """Return the force of the fluid on each wall particle [N], shape (count,); needs synchronised records."""
        self._react.run(self.walls.count)
        self._fluid_reaction(self.walls, self.force)
        return self.force

    def bind_lists(self) -> None:
        """Build the passes; needed again when the rows of the neighbour lists have grown."""
        a, walls = self._assembly, self.walls
        self._react = a.launcher.bind(
            f"{self._label} force",
            self._kernels.react,
            a.constants,
            walls.first,
            walls.rows.index,
            walls.rows.ends,
            a.scratch.position_pressure,
            a.state.velocity_volume,
            walls.surface.friction,
            walls.surface.normal,
            self.force,
        )
        if self.method == "dynamic":
            self._bind_dynamic()
        elif self._mirror:
            self._impose = self._mirror.bind(walls)
        else:
            self._impose = self._extrapolation()

    def _extrapolation(self) -> Pass:
        a, walls = self._assembly, self.walls
        return a.launcher.bind(
            f"extrapolate to {self._label}s",
            self._kernels.extrapolate,
            a.constants,
            walls.first,
            walls.rows.index,
            walls.rows.ends,
            a.state.density_deviation,
            a.state.acceleration,
            a.state.velocity_volume,
            walls.surface.friction,
            a.scratch.position_pressure,
        )

    def _bind_dynamic(self) -> None:
        a, walls = self._assembly, self.walls
        state, scratch, real = a.state, a.scratch, a.options.arithmetic.real

        def set_pressure(half_steps: float) -> Any:
            return a.launcher.bind(
                f"{self._label} pressure",
                self._kernels.set_pressure,
                a.constants,
                a.clock,
                walls.first,
                real(half_steps),
                state.density_rate,
                state.velocity_volume,
                walls.surface.friction,
                state.density_deviation,
                scratch.position_pressure,
            )

        self._impose, self._show = set_pressure(1.0), set_pressure(0.0)
        self._update_density = a.launcher.bind(
            f"update {self._label} density",
            self._kernels.update_density,
            a.constants,
            a.clock,
            walls.first,
            walls.rows.index,
            walls.rows.ends,
            scratch.position_density,
            state.velocity_volume,
            state.density_rate,
            state.density_deviation,
        )


def make_wall_surface(arithmetic: Arithmetic, no_slip: np.ndarray, device: Any) -> WallSurface:
    """Return the surface arrays of walls; `no_slip` has 1 for each particle of a no-slip wall and 0 for others."""
    size = max(len(no_slip), 1)
    friction = wp.zeros(size, dtype=arithmetic.record, device=device)
    write_array(friction, np.column_stack([np.zeros((len(no_slip), arithmetic.dimension)), no_slip]))
    return WallSurface(friction, wp.zeros(size, dtype=arithmetic.vector, device=device))


def no_slip_flags(slips: Sequence[bool], counts: Sequence[int]) -> np.ndarray:
    """Return 1 for each particle of a no-slip wall and 0 for others, walls in order."""
    return np.repeat(np.asarray(slips, dtype=float), counts)
