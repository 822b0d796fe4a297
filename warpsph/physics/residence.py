"""How long fluid has been between the open boundaries, for scenes that ask for it."""

from __future__ import annotations

import warp as wp
from warpsph_kernels.residence import make_grow_older

from warpsph.physics.assembly import Assembly


class ResidenceModel:
    """The age of each particle: the time since it entered the domain, or since the start where it began inside.

    A particle that takes the place of one that enters begins in a buffer, and so without age, as its parent is.

    Args:
        tag: (places,) patch in whose buffer a particle is, else -1.
    """

    def __init__(self, assembly: Assembly, tag: wp.array) -> None:
        self.age = wp.zeros(tag.shape[0], dtype=wp.float64, device=assembly.launcher.device)
        kernel = make_grow_older(assembly.options)
        self._grow = assembly.launcher.bind("residence", kernel, assembly.clock, tag, self.age)

    def grow_older(self, count: int) -> None:
        """Let the first `count` particles grow older by a step."""
        self._grow.run(count)
