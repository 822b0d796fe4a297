"""The box that pictures of a run frame."""

from __future__ import annotations

import numpy as np

from warpsph.rendering.cache import ParticleCache, RenderedSet

_STRAY = 2.0
"""Percentage of particles at either end of an axis that may fly out of the picture."""


def extent_of(cache: ParticleCache, field: str) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corner (3,) [m] of walls, structures, the whole fluid at the start and nearly all of
    it later.

    Drops that fly far away do not shrink the picture of the rest.
    """
    boxes = [
        _box(particles, stray=_STRAY if index > 0 and particles.kind == "fluid" else 0.0)
        for index in cache.typical_frames()
        for particles in cache.frame(index, field).sets
        if len(particles.position)
    ]
    lows, highs = zip(*boxes, strict=True)
    return np.min(lows, axis=0), np.max(highs, axis=0)


def _box(particles: RenderedSet, *, stray: float) -> tuple[np.ndarray, np.ndarray]:
    low, high = np.percentile(particles.position, [stray, 100.0 - stray], axis=0)
    radius = 0.5 * particles.diameter
    return low - radius, high + radius
