"""The pass of modified dynamic walls."""

from __future__ import annotations

import numpy as np
import warp as wp
from warpsph_kernels.mirrored_walls import make_look_into_mirror

from warpsph.particles.launch import Pass
from warpsph.particles.neighbours import NeighbourSearch
from warpsph.particles.state import write_array
from warpsph.physics.assembly import Assembly, WallSurface


class MirroredWalls:
    """Mirror points of the wall particles and the pass that looks at them.

    Args:
        ways: from each wall particle to its mirror point at time zero, (walls, dimension) [m].
    """

    def __init__(self, assembly: Assembly, search: NeighbourSearch, ways: np.ndarray) -> None:
        self._assembly, self._search = assembly, search
        self._kernel = make_look_into_mirror(assembly.options)
        self.ways = wp.zeros(
            len(ways), dtype=assembly.options.arithmetic.vector, device=assembly.launcher.device
        )
        write_array(self.ways, ways)

    def bind(self, surface: WallSurface, poses: wp.array) -> Pass:
        """Return the pass over all wall particles; it follows the pose of each set."""
        a = self._assembly
        return a.launcher.bind(
            "mirror points of walls",
            self._kernel,
            a.constants,
            a.layout.fluids,
            self._search.grid,
            self._search.tables[0].start,
            poses,
            a.state.set_index,
            self.ways,
            a.state.velocity_volume,
            surface.friction,
            a.scratch.position_pressure,
        )
