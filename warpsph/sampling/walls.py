"""Wall particles of a boundary: layers as thick as the kernel's support, on one side of its surface."""

from __future__ import annotations

import math

import numpy as np
from scipy.ndimage import maximum_filter1d

from warpsph.sampling.axes import face_axes, own_axes, same_axes
from warpsph.sampling.body_fitted import body_fitted_layers, has_layers
from warpsph.sampling.lattice import TIE, CellBlock, Lattice, cells_inside
from warpsph.sampling.layers import Layering, core
from warpsph.sampling.regions import Period, wall_region
from warpsph.sampling.sets import Placed
from warpsph.sampling.surface_relaxation import relaxed
from warpsph.scene.bounds import bounding_box
from warpsph.scene.schema import Boundary, Scene
from warpsph.scene.shapes import Box, Plane, Shape
from warpsph.scene.types import AXES


def period_of(scene: Scene) -> Period:
    """The periodic axes of a scene."""
    return {AXES.index(axis): ends for axis, ends in scene.domain.periodic.items()}


def layer_count(boundary: Boundary, scene: Scene) -> int:
    """Layers [1] of a wall: as given, or so many that no fluid before the wall sees past it; for structures one."""
    if boundary.layers != "auto":
        return boundary.layers
    return math.ceil(scene.support_radius / scene.spacing - TIE) if scene.fluids else 1


def sample_wall(boundary: Boundary, lattice: Lattice, layers: int, period: Period) -> Placed:
    """The particles of a boundary.

    If the boundary does not say how, surfaces along the lattice and those of meshes continue the lattice, and all
    others carry layers of their own. Nothing lies beyond an open face, nor outside the period of a periodic axis.
    """
    shape, dimension = boundary.shape, len(lattice.origin)
    axes = face_axes(shape, dimension)
    on_lattice = axes is not None and same_axes(axes, lattice.rotation)
    evenness = None
    if boundary.placement == "relaxed":
        placed = _relaxed_wall(boundary, lattice, layers, period)
        positions, evenness = placed.position, placed.evenness
    elif boundary.placement == "auto" and has_layers(shape) and not on_lattice:
        positions = _body_fitted_wall(boundary, lattice, layers)
    elif isinstance(shape, Plane):
        positions = cells_inside(
            lattice, _plane_slab(shape, boundary.side, layers * lattice.spacing)
        ).positions()
    else:
        positions = _lattice_wall(shape, boundary.side, lattice, layers, period)
    margin = TIE * lattice.spacing
    positions = positions[~beyond_open_faces(positions, boundary, margin)]
    return Placed(positions[_within_period(positions, period, margin)], evenness)


def beyond_open_faces(points: np.ndarray, boundary: Boundary, margin: float) -> np.ndarray:
    """Which points (n, dimension) [m] lie farther out than an open face of the boundary: there is no wall.

    Faces are those of the box around the shape, turned with the shape where it is transformed.
    """
    beyond = np.zeros(len(points), dtype=bool)
    axes = own_axes(boundary.shape, points.shape[1])
    low, high = bounding_box(boundary.shape, axes)
    along = points @ axes
    for face in boundary.open:
        axis, end = AXES.index(face[0]), face[2:]
        beyond |= (
            along[:, axis] <= low[axis] + margin if end == "min" else along[:, axis] >= high[axis] + margin
        )
    return beyond


def _within_period(positions: np.ndarray, period: Period, margin: float) -> np.ndarray:
    """Which positions (n, dimension) [m] lie in [low, high) of every periodic axis, less `margin` [m]."""
    within = np.ones(len(positions), dtype=bool)
    for axis, (low, high) in period.items():
        within &= (positions[:, axis] >= low - margin) & (positions[:, axis] < high - margin)
    return within


def _lattice_wall(shape: Shape, side: str, lattice: Lattice, layers: int, period: Period) -> np.ndarray:
    inside = _within_periodic_cells(cells_inside(lattice, shape), period)
    if side == "solid":
        return inside.positions()
    padded = _padded(inside, layers, period)
    if side == "outside":
        wall = _grown(padded.mask, layers) & ~padded.mask
    else:
        wall = padded.mask & _grown(~padded.mask, layers)
    return CellBlock(lattice, padded.first, wall).positions()


def _relaxed_wall(boundary: Boundary, lattice: Lattice, layers: int, period: Period) -> Placed:
    region = wall_region(boundary, layers * lattice.spacing, period)
    points = _lattice_wall(boundary.shape, boundary.side, lattice, layers, period)
    return relaxed(points[region(points) < 0.0], region, lattice)


def _within_periodic_cells(block: CellBlock, period: Period) -> CellBlock:
    """The block without the cells beyond the periodic faces."""
    first, mask = block.first.copy(), block.mask
    for axis in _lattice_periods(block.lattice, period):
        start, count = _cells_of_period(block.lattice, axis, period)
        stop = start + count - first[axis]
        begin = max(start - first[axis], 0)
        mask = np.take(mask, range(begin, min(stop, mask.shape[axis])), axis=axis)
        first[axis] += begin
    return CellBlock(block.lattice, first, mask)


def _padded(block: CellBlock, layers: int, period: Period) -> CellBlock:
    """The block with `layers` more cells all round: empty, or periodic images where it fills the period."""
    mask = block.mask
    periods = _lattice_periods(block.lattice, period)
    for axis in range(mask.ndim):
        full = axis in periods and mask.shape[axis] == _cells_of_period(block.lattice, axis, period)[1]
        width = [(layers, layers) if k == axis else (0, 0) for k in range(mask.ndim)]
        mask = np.pad(mask, width, mode="wrap" if full else "constant")
    return CellBlock(block.lattice, block.first - layers, mask)


def _lattice_periods(lattice: Lattice, period: Period) -> Period:
    """The periodic axes, for a lattice along the axes; none for a lattice that is turned against them."""
    return period if np.array_equal(lattice.rotation, np.eye(len(lattice.origin))) else {}


def _cells_of_period(lattice: Lattice, axis: int, period: Period) -> tuple[int, int]:
    """First cell and number of cells of the lattice along a periodic axis."""
    low, high = period[axis]
    first = round((low - lattice.origin[axis]) / lattice.spacing)
    return first, round((high - low) / lattice.spacing)


def _grown(mask: np.ndarray, layers: int) -> np.ndarray:
    """The marked cells and all within `layers` cells of them, diagonals included."""
    grown = mask.view(np.uint8)
    for axis in range(mask.ndim):
        grown = maximum_filter1d(grown, 2 * layers + 1, axis=axis, mode="constant")
    return grown.view(bool)


def _plane_slab(plane: Plane, side: str, thickness: float) -> Box:
    """The region of the layers along a plane whose normal is an axis."""
    if plane.bounds is None:
        raise ValueError("a plane without bounds has no end")
    low, high = np.array(plane.bounds.min), np.array(plane.bounds.max)
    axis = int(np.argmax(np.abs(plane.normal)))
    towards = np.sign(plane.normal[axis]) * (1.0 if side == "outside" else -1.0)
    low[axis], high[axis] = sorted([plane.point[axis], plane.point[axis] + towards * thickness])
    return Box(min=tuple(low), max=tuple(high))


def _body_fitted_wall(boundary: Boundary, lattice: Lattice, layers: int) -> np.ndarray:
    thickness = layers * lattice.spacing
    low, high = bounding_box(boundary.shape)
    layering = Layering(
        layers=layers,
        spacing=lattice.spacing,
        outward=boundary.side == "outside",
        anchor=lattice.rotation @ lattice.origin,
        limits=(low - thickness, high + thickness) if np.isfinite([low, high]).all() else None,
    )
    positions = body_fitted_layers(boundary.shape, layering)
    if boundary.side != "solid":
        return positions
    return np.concatenate([positions, core(boundary.shape, thickness, lattice)])
