"""Density of the fluid by summation."""

from __future__ import annotations

import itertools

import numpy as np
import warp as wp
from warpsph_kernels.summation import make_sum_density

from warpsph.laws.smoothing import SMOOTHING_LAWS
from warpsph.particles.neighbours import NeighbourRows
from warpsph.physics.assembly import Assembly
from warpsph.scene.schema import Scene


def lattice_sum(scene: Scene) -> float:
    """Return sum_b dp^d W_ab over a square or cubic lattice, the particle itself included."""
    law, h_over_dp = SMOOTHING_LAWS[scene.numerics.kernel], scene.numerics.h_over_dp
    reach = int(np.ceil(law.support * h_over_dp))
    sites = np.array(list(itertools.product(range(-reach, reach + 1), repeat=scene.dimension)))
    q = np.linalg.norm(sites, axis=1) / h_over_dp
    return float(law.value(q, scene.dimension).sum() / h_over_dp**scene.dimension)


class DensitySum:
    """The pass that sums the density."""

    def __init__(self, assembly: Assembly, rows: NeighbourRows, scene: Scene) -> None:
        self._assembly, self._rows = assembly, rows
        self._kernel = make_sum_density(assembly.options)
        self._lattice_sum = wp.float64(lattice_sum(scene))
        self.bind_lists()

    def bind_lists(self) -> None:
        """Build the pass; needed again when the rows of the neighbour lists have grown."""
        a, rows = self._assembly, self._rows
        self._sum = a.launcher.bind(
            "sum density",
            self._kernel,
            a.constants,
            self._lattice_sum,
            rows.index,
            rows.ends,
            a.scratch.position_pressure,
            a.state.density_deviation,
        )

    def find(self) -> None:
        """Sum the density at the positions of the middle of the step."""
        self._sum.run(self._rows.targets.count)
