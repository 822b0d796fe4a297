"""Streamlines of a plane flow: velocities of particles on a grid, and the lines along them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from scipy.spatial import cKDTree

from warpsph.rendering.cache import RenderedSet

COLOUR = "#ffffff"
_REACH = 2.0
"""Particle diameters within which a grid point sees particles; where there is none within one, there is no fluid."""
_NEIGHBOURS = 16
_DENSITY = 1.6
"""Of matplotlib's lines: at most some 50 side by side."""


def draw_streamlines(axes: Axes, fluids: Sequence[RenderedSet]) -> None:
    """Draw the lines that are tangent to the velocity (n, 2) [m/s] of the fluids at this moment."""
    if not fluids:
        return
    position = np.concatenate([fluid.position[:, :2] for fluid in fluids])
    velocity = np.concatenate([_velocity(fluid) for fluid in fluids])
    x, y, on_grid = velocity_on_grid(position, velocity, fluids[0].diameter)
    if not len(x) or not np.any(on_grid[np.isfinite(on_grid)]):
        return
    lines = axes.streamplot(
        x, y, on_grid[..., 0], on_grid[..., 1], density=_DENSITY, color=COLOUR, linewidth=0.8, arrowsize=0.8
    )
    lines.lines.set_alpha(0.85)


def velocity_on_grid(
    position: np.ndarray, velocity: np.ndarray, spacing: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return x (m,), y (k,) [m] and the velocity (k, m, 2) [m/s] on a grid of one spacing, NaN where there is no fluid.

    The weighted mean of Shepard (1968) over the nearest particles, with weights that fall to nought at twice the
    spacing.
    """
    low, high = position.min(axis=0), position.max(axis=0)
    x, y = (np.linspace(a, b, max(2, round((b - a) / spacing) + 1)) for a, b in zip(low, high, strict=True))
    points = np.stack(np.meshgrid(x, y), axis=-1)
    reach = _REACH * spacing
    distance, near = cKDTree(position).query(points, k=_NEIGHBOURS, distance_upper_bound=reach, workers=-1)
    weight = np.maximum(1.0 - distance / reach, 0.0) ** 2
    padded = np.vstack([velocity, np.zeros(2)])
    total = weight.sum(axis=-1, keepdims=True)
    mean = (weight[..., None] * padded[near]).sum(axis=-2) / np.where(total > 0.0, total, np.inf)
    mean[distance[..., 0] > spacing] = np.nan
    return x, y, mean


def _velocity(fluid: RenderedSet) -> np.ndarray:
    if fluid.velocity is None:
        raise ValueError(f"the frame of {fluid.name!r} was read without velocities")
    return fluid.velocity[:, :2]
