"""The pass of modified dynamic walls."""

from __future__ import annotations

import warp as wp
from warpsph_kernels.mirrored_walls import make_look_into_mirror

from warpsph.particles.launch import Pass
from warpsph.particles.neighbours import NeighbourSearch
from warpsph.physics.assembly import Assembly, WallRange


class MirroredWalls:
    """Mirror points of the wall particles and the pass that looks at them.

    Args:
        ways: from each wall particle to its mirror point at time zero [m].
        poses: of the sets, which turn the ways.
    """

    def __init__(self, assembly: Assembly, search: NeighbourSearch, ways: wp.array, poses: wp.array) -> None:
        self._assembly, self._search, self._poses = assembly, search, poses
        self._kernel = make_look_into_mirror(assembly.options)
        self.ways = ways

    def bind(self, walls: WallRange) -> Pass:
        """Return the pass over a range of wall particles; it follows the pose of each set."""
        a = self._assembly
        return a.launcher.bind(
            "mirror points of walls",
            self._kernel,
            a.constants,
            walls.first,
            self._search.grid,
            self._search.tables[0].start,
            self._poses,
            a.state.set_index,
            self.ways,
            a.state.velocity_volume,
            walls.surface.friction,
            a.scratch.position_pressure,
        )
