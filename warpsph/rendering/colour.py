"""One colour scale for all frames of a run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize

from warpsph.rendering.cache import ParticleCache

WATER = LinearSegmentedColormap.from_list(
    "water", ["#0a2350", "#104a8c", "#1f79bd", "#4aa6d2", "#86cddc", "#c2ebe0"]
)
"""Deep blue at rest to foam at speed; lightness rises evenly, and the light end still stands out on white."""

_ROBUST_PERCENTILES = (1.0, 99.0)
_BOTH_SIGNS = 0.5
"""Ratio of the smaller to the larger end from which a field counts as signed."""


@dataclass(frozen=True)
class ColourScale:
    """Colour map between two values, with the label of its bar."""

    low: float
    high: float
    colours: Colormap
    label: str

    def mappable(self) -> ScalarMappable:
        """What a colour bar is drawn from."""
        return ScalarMappable(Normalize(self.low, self.high), self.colours)

    def rgb(self, values: np.ndarray) -> np.ndarray:
        """Colours (..., 3) in [0, 1] as float32; values outside the scale take its ends."""
        fraction = (values - self.low) / (self.high - self.low)
        return self.colours(np.clip(fraction, 0.0, 1.0))[..., :3].astype(np.float32)


def scale_of(cache: ParticleCache, field: str) -> ColourScale:
    """A scale that fits the whole run: robust percentiles over its fluids and structures.

    Speeds start at zero, and so do fields whose negative values are but noise, such as pressure; fields of
    both signs get a diverging map about zero.
    """
    frames = (cache.frame(index, field) for index in cache.typical_frames())
    bodies = (body for frame in frames for body in frame.of_kind("fluid", "structure"))
    samples = [body.value for body in bodies if body.value is not None]
    low, high = _robust_range(np.concatenate(samples)) if samples else (0.0, 1.0)
    unit = cache.unit(field)
    label = f"{field} [{unit}]" if unit else field
    if field == "velocity":
        return ColourScale(0.0, high if high > 0.0 else 1.0, WATER, label)
    extreme = max(-low, high)
    if low < 0.0 < high and min(-low, high) > _BOTH_SIGNS * extreme:
        return ColourScale(-extreme, extreme, colormaps["RdBu_r"], label)
    bottom = 0.0 if low < 0.0 < high else low
    return ColourScale(bottom, high if high > bottom else bottom + 1.0, colormaps["viridis"], label)


def _robust_range(values: np.ndarray) -> tuple[float, float]:
    values = values[np.isfinite(values)]
    if values.size == 0:
        return 0.0, 1.0
    low, high = np.percentile(values, _ROBUST_PERCENTILES)
    return float(low), float(high)
