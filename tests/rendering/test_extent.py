"""What the pictures of a run frame."""

from __future__ import annotations

import numpy as np
import pytest

from warpsph.rendering.cache import ParticleCache, RenderedFrame, RenderedSet
from warpsph.rendering.extent import extent_of


class Splash(ParticleCache):
    """A column of water from which, later, one particle in a hundred has flown far away."""

    def __init__(self) -> None:
        self.codes = [0.0, 1.0]

    def frame(self, index: int, field: str) -> RenderedFrame:
        position = np.linspace([0.0, 0.0, 0.0], [1.0, 2.0, 0.0], 500)
        if index == 1:
            position = position * [1.0, 0.5, 1.0]
            position[:5] += 100.0
        return RenderedFrame(float(index), (RenderedSet("water", "fluid", position, 0.2, None),))


def test_picture_frames_the_start_and_ignores_far_drops() -> None:
    low, high = extent_of(Splash(), "velocity")
    assert low == pytest.approx([-0.1, -0.1, -0.1])
    assert high == pytest.approx([1.1, 2.1, 0.1])
