"""What keeps the particles of the fluid evenly spread: transport velocity or shifting."""

from __future__ import annotations

from collections.abc import Callable

import warp as wp
from warpsph_kernels.particle_order import LARGEST_SHIFT, make_order_kernels

from warpsph.particles.neighbours import NeighbourRows
from warpsph.physics.assembly import Assembly
from warpsph.scene.fluid_models import ParticleOrder


class ParticleOrderModel:
    """The shift velocity of the fluid and the passes that find it.

    shift: dv [m/s] of the last step, which the next one begins with; next_shift: that of this step; coverage:
    smallest eigenvalue of the moment matrix [1], of shifting only; closing: rate at which shifts bring particles
    together [1/s], where the density follows it.
    """

    def __init__(self, assembly: Assembly, rows: NeighbourRows, order: ParticleOrder, spacing: float) -> None:
        arithmetic, device = assembly.options.arithmetic, assembly.launcher.device
        fluids = assembly.layout.fluids
        self._assembly, self._rows = assembly, rows
        self._finds_surface = order.type == "shifting"
        self._strength = arithmetic.real(order.strength)
        self._kernels = make_order_kernels(assembly.options)
        self.shift = wp.zeros(fluids, dtype=arithmetic.vector, device=device)
        self.next_shift = wp.zeros(fluids, dtype=arithmetic.vector, device=device)
        self.coverage = wp.zeros(fluids if self._finds_surface else 1, dtype=arithmetic.real, device=device)
        follows = assembly.options.density_follows
        self.closing = wp.zeros(fluids if follows else 1, dtype=arithmetic.real, device=device)
        self._following = {"closing": self.closing} if follows else {}
        self.largest_shift = LARGEST_SHIFT * spacing
        self.complete_coverage: Callable[[], None] | None = None
        """What the coverage of particles lacks whose neighbours are not all there."""
        self.bind_lists()

    @property
    def own_arrays(self) -> dict[str, wp.array]:
        """Arrays of shape (fluids,) that follow the order of the fluid and belong into a checkpoint."""
        return {"shift": self.shift} | self._following

    @property
    def arrays(self) -> dict[str, wp.array]:
        """All arrays of the model, by name."""
        found = {"shift": self.shift, "next_shift": self.next_shift, "coverage": self.coverage}
        return found | self._following

    @property
    def passes(self) -> list[str]:
        return ["particle order", "surface"] if self._finds_surface else ["particle order"]

    def bind_lists(self) -> None:
        """Build the passes; needed again when the rows of the neighbour lists have grown."""
        a, rows = self._assembly, self._rows
        lists = (rows.index, rows.ends, a.scratch.position_pressure, a.state.velocity_volume)
        self._find = a.launcher.bind(
            "particle order",
            self._kernels.find_order,
            a.constants,
            a.clock,
            self._strength,
            *lists,
            self.shift,
            self.next_shift,
            self.coverage,
            self.closing,
            a.state.acceleration,
        )
        self._limit = a.launcher.bind(
            "surface", self._kernels.limit_at_surface, a.constants, *lists, self.coverage, self.next_shift
        )

    def find(self) -> None:
        """Add what the last shift carries to the accelerations, if it carries anything, and find the next shift."""
        count = self._rows.targets.count
        self._find.run(count)
        if self._finds_surface:
            if self.complete_coverage:
                self.complete_coverage()
            self._limit.run(count)
