"""One colour scale for a whole run."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from warpsph.rendering.cache import ParticleCache, RenderedFrame, RenderedSet
from warpsph.rendering.colour import WATER, scale_of


class OneSet(ParticleCache):
    """A cache of one frame with given values."""

    def __init__(self, values: np.ndarray) -> None:
        self.values = values
        self.codes = [0.0]

    def frame(self, index: int, field: str) -> RenderedFrame:
        fluid = RenderedSet("water", "fluid", np.zeros((len(self.values), 3)), 0.1, self.values)
        return RenderedFrame(0.0, (fluid,))

    def unit(self, field: str) -> str:
        return "u"


def test_speed_starts_at_zero_and_ignores_a_few_fast_drops() -> None:
    values = np.full(1000, 2.0)
    values[:5] = 500.0
    scale = scale_of(OneSet(values), "velocity")
    assert (scale.low, scale.high, scale.label) == (0.0, pytest.approx(2.0), "velocity [u]")


def test_noise_below_zero_does_not_shift_a_pressure_scale() -> None:
    scale = scale_of(OneSet(np.linspace(-100.0, 1000.0, 500)), "pressure")
    assert scale.low == 0.0


def test_signed_field_is_centred_on_zero() -> None:
    scale = scale_of(OneSet(np.linspace(-80.0, 100.0, 500)), "vorticity")
    assert scale.low == -scale.high
    assert scale.colours.name == "RdBu_r"


@pytest.mark.parametrize("field", ["velocity", "pressure"])
def test_uniform_field_has_a_scale_of_finite_width(field: str) -> None:
    scale = scale_of(OneSet(np.zeros(10)), field)
    assert scale.high > scale.low
    assert np.all(np.isfinite(scale.rgb(np.zeros(3))))


def test_scale_is_that_of_the_fluid_and_the_same_for_all_frames(write_run: Callable[..., Path]) -> None:
    scale = scale_of(ParticleCache(write_run(2)), "pressure")
    assert scale.high < 700.0  # water reaches x = 0.7 m, walls 1.3 m
    assert scale.label == "pressure [Pa]"


def test_lightness_of_the_water_map_rises_evenly() -> None:
    """Luminance (Rec. 709 weights) never falls, so that the map survives a black-and-white print."""
    luminance = WATER(np.linspace(0.0, 1.0, 64))[:, :3] @ [0.2126, 0.7152, 0.0722]
    assert np.all(np.diff(luminance) > 0.0)
    assert luminance[-1] < 0.93  # still visible on white
