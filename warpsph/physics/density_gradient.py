"""The density gradient of the fluid, for density diffusion that takes it away."""

from __future__ import annotations

import warp as wp
from warpsph_kernels.density_gradient import make_density_gradient

from warpsph.particles.neighbours import NeighbourRows
from warpsph.physics.assembly import Assembly


class DensityGradient:
    """The gradient [kg/m^(dim+1)] of each fluid particle, and the pass that finds it."""

    def __init__(self, assembly: Assembly, rows: NeighbourRows) -> None:
        self._assembly, self._rows = assembly, rows
        self._kernel = make_density_gradient(assembly.options)
        self.gradient = wp.zeros(
            assembly.layout.fluids, dtype=assembly.options.arithmetic.vector, device=assembly.launcher.device
        )
        self.bind_lists()

    @property
    def arrays(self) -> dict[str, wp.array]:
        """All arrays of the model, by name."""
        return {"density_gradient": self.gradient}

    def bind_lists(self) -> None:
        """Build the pass; needed again when the rows of the neighbour lists have grown."""
        a, rows = self._assembly, self._rows
        self._find = a.launcher.bind(
            "density gradient",
            self._kernel,
            a.constants,
            rows.index,
            rows.ends,
            a.scratch.position_density,
            a.state.velocity_volume,
            self.gradient,
        )

    def find(self) -> None:
        """Find the gradient from positions and densities at the end of the step."""
        self._find.run(self._rows.targets.count)
