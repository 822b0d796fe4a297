"""The particles that fill the buffers behind open boundaries, and the columns in which they stand."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from warpsph.sampling.axes import same_axes
from warpsph.sampling.lattice import TIE, Lattice
from warpsph.sampling.patches import Patch
from warpsph.sampling.scene_lattices import lattices_of
from warpsph.scene.schema import Scene


def fluid_of(scene: Scene, patch: Patch) -> str:
    """Name of the fluid in a patch's buffer."""
    return scene.open_boundaries[patch.name].fluid or next(iter(scene.fluids))


def buffer_of(scene: Scene, patch: Patch, lattices: Mapping[str, Lattice] | None = None) -> np.ndarray:
    """Particles (n, dimension) [m] that fill a patch's buffer, up to its water level.

    Behind a disc of fluid that is placed along its surface they stand on rings: a lattice would leave gaps of up to a
    spacing at the wall of a pipe, through which fluid comes back. `lattices`: those of the scene, where they are known.
    """
    name = fluid_of(scene, patch)
    if patch.is_disc and scene.fluids[name].placement == "relaxed":
        return ringed_points(patch, scene.spacing)
    return lattice_points(patch, (lattices or lattices_of(scene))[name])


def ringed_points(patch: Patch, spacing: float) -> np.ndarray:
    """Particles (n, 3) [m] behind a disc, up to its water level: layers a spacing apart, in each the same rings, which
    share its area evenly to half a particle."""
    radius = float(patch.half[0])
    rings = max(round(radius / spacing), 1)
    width = radius / rings
    enclosed = np.round(math.pi * (width * np.arange(rings + 1) / spacing) ** 2).astype(int)
    across = []
    for k, count in enumerate(np.diff(enclosed)):
        angle = 2.0 * math.pi * (np.arange(count) + 0.5 * (k % 2)) / count
        across.append((k + 0.5) * width * np.column_stack([np.cos(angle), np.sin(angle)]))
    layer = np.concatenate(across)
    depths = -(np.arange(round(patch.length / spacing)) + 0.5) * spacing
    points = np.concatenate([patch.points(layer, float(depth)) for depth in depths])
    return points[patch.below_level(points) > TIE * spacing]


def lattice_points(patch: Patch, lattice: Lattice) -> np.ndarray:
    """Particles (n, dimension) [m] that fill a buffer, up to its water level: on the lattice of its fluid if that lies
    along the patch, else on one of its own."""
    dp = lattice.spacing
    if not same_axes(patch.axes, lattice.rotation):
        corner = patch.axes.T @ patch.center - np.concatenate([[0.0], 0.5 * _whole(patch, dp)])
        lattice = Lattice(dp, corner, patch.axes)
    half = np.concatenate([[0.5 * patch.length], patch.half])
    middle = patch.center - 0.5 * patch.length * patch.axes[:, 0]
    extent = np.abs(lattice.rotation.T @ patch.axes) @ half
    first, count = lattice.cells_between(
        lattice.rotation.T @ middle - extent - dp, lattice.rotation.T @ middle + extent + dp
    )
    cells = np.stack(np.meshgrid(*(np.arange(n) for n in count), indexing="ij"), axis=-1)
    points = lattice.centers(cells.reshape(-1, len(count)) + first)
    at = patch.coordinates(points)
    tie = TIE * dp
    inside = (at[:, 0] <= -tie) & (at[:, 0] > -patch.length - tie) & patch.covers(at[:, 1:], -tie)
    inside &= patch.below_level(points) > tie
    return points[inside]


def columns_of(scene: Scene, patch: Patch) -> np.ndarray:
    """Coordinates (n, dimension - 1) [m] across a patch of the columns in which its buffer brings in particles."""
    at = patch.coordinates(buffer_of(scene, patch))
    return at[at[:, 0] > -(1.0 - TIE) * scene.spacing, 1:]


def flow_of_columns(scene: Scene, patch: Patch, speed: np.ndarray) -> float:
    """Volume a second [m3/s; m2/s in 2D] that the columns of a buffer bring in, each over its share of a lattice, at
    speeds (s,) [m/s] at the stations, between which the buffer takes them linearly."""
    columns = columns_of(scene, patch)
    across = [k for k, count in enumerate(patch.counts) if count > 1]
    if across:
        table = speed.reshape([patch.counts[k] for k in across])
        grid = [patch.middles(k) for k in across]
        between = RegularGridInterpolator(grid, table, bounds_error=False, fill_value=None)
        brought = between(columns[:, across]).sum()
    else:
        brought = speed[0] * len(columns)
    return float(brought) * float(scene.spacing ** (scene.dimension - 1))


def _whole(patch: Patch, spacing: float) -> np.ndarray:
    """Lengths across the patch in whole spacings [m]."""
    return np.array(patch.counts) * spacing
