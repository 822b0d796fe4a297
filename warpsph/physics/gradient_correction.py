"""Corrected gradients of pressure and velocity: the passes of the renormalised and the finite-particle form."""

from __future__ import annotations

import warp as wp
from warpsph_kernels.gradient_correction import make_finite_particle_kernels, make_renormalised_kernels

from warpsph.particles.neighbours import NeighbourRows
from warpsph.physics.assembly import Assembly


class GradientCorrection:
    """What the form has beyond the plain sums; `excess` is L - I [1] of each fluid particle, renormalised only."""

    def __init__(self, assembly: Assembly, rows: NeighbourRows) -> None:
        options = assembly.options
        self._assembly, self._rows = assembly, rows
        self._renormalised = options.kernel_gradient == "renormalised"
        make = make_renormalised_kernels if self._renormalised else make_finite_particle_kernels
        self._kernels = make(options)
        size = assembly.layout.fluids if self._renormalised else 1
        self.excess = wp.zeros(size, dtype=options.arithmetic.matrix, device=assembly.launcher.device)
        self.bind_lists()

    @property
    def arrays(self) -> dict[str, wp.array]:
        """All arrays of the model, by name."""
        return {"gradient_excess": self.excess} if self._renormalised else {}

    def bind_lists(self) -> None:
        """Build the passes; needed again when the rows of the neighbour lists have grown."""
        a, rows, bind = self._assembly, self._rows, self._assembly.launcher.bind
        lists = (rows.index, rows.ends)
        middle = (*lists, a.scratch.position_pressure, a.state.velocity_volume)
        end = (*lists, a.scratch.position_density, a.state.velocity_volume)
        stage, kernels = "gradient correction", self._kernels
        corrections: tuple[wp.array, ...] = ()
        if self._renormalised:
            self._find = bind(stage, kernels.find_correction, a.constants, *middle, self.excess)
            corrections = (self.excess,)
        self._pressure = bind(
            stage, kernels.correct_pressure, a.constants, *middle, *corrections, a.state.acceleration
        )
        self._divergence = bind(
            stage,
            kernels.correct_divergence,
            a.constants,
            a.clock,
            *end,
            a.state.density_rate,
            a.state.density_deviation,
        )

    def correct_pressure(self) -> None:
        """Correct the pressure part of the accelerations."""
        count = self._rows.targets.count
        if self._renormalised:
            self._find.run(count)
        self._pressure.run(count)

    def correct_divergence(self) -> None:
        """Correct density rate and density at the end of the step."""
        self._divergence.run(self._rows.targets.count)
