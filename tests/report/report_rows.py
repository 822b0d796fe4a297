"""Rows of a validation made by hand."""

from __future__ import annotations

from typing import Any


def row(spacing: float, error: float | None, wall: float | None = 40.0, **other: Any) -> dict[str, Any]:
    """A row with a relative error at a particle spacing [m] that took so many seconds, ten steps in each."""
    fixed = {
        "scene": "tank",
        "resolution": spacing,
        "quantity": "front",
        "value": 1.0,
        "reference": 1.0,
        "error": error,
        "bound": 0.5,
        "holds": error is not None and error <= 0.5,
        "uncertainty": 0.0,
        "source": "closed form",
        "wall_seconds": wall,
        "steps": None if wall is None else round(10 * wall),
        "particles": 300,
        "particle_steps_per_second": 1e6,
        "device": "cpu",
        "threads": 1,
    }
    return fixed | other
