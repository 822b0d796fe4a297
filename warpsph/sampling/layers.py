"""Layers of particles along the surface of a primitive: half a spacing from it, one and a half, and so on."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial, singledispatch

import numpy as np

from warpsph.sampling.contours import disc_layers, polygon_layers
from warpsph.sampling.distance import signed_distance
from warpsph.sampling.lattice import Lattice, cells_inside
from warpsph.sampling.packing import SURFACE_CLEARANCE, pushed_inside
from warpsph.scene.shapes import Box, Cylinder, Extrusion, Naca, Plane, Polygon, Shape, Sphere


@dataclass(frozen=True)
class Layering:
    """How many layers [1] of which spacing [m] to put on which side of a surface.

    `anchor` (dimension,) [m] is a cell corner of the lattice that the flat ends of a shape continue. The two
    corners `limits` (dimension,) [m] end a plane that has no bounds of its own.
    """

    layers: int
    spacing: float
    outward: bool
    anchor: np.ndarray
    limits: tuple[np.ndarray, np.ndarray] | None = None

    @property
    def depths(self) -> np.ndarray:
        """Distances (layers,) [m] of the layers from the surface."""
        return (np.arange(self.layers) + 0.5) * self.spacing

    @property
    def thickness(self) -> float:
        """Of all layers together [m]."""
        return self.layers * self.spacing


def core(shape: Shape, depth: float, lattice: Lattice) -> np.ndarray:
    """Lattice points (n, dimension) [m] deeper than `depth` [m] in the shape, clear of what ends there."""
    distance = partial(signed_distance, shape)
    points = cells_inside(lattice, shape).positions()
    points = points[distance(points) < -depth]
    points, fits = pushed_inside(
        points, distance, depth + SURFACE_CLEARANCE * lattice.spacing, lattice.spacing
    )
    return points[fits]


@singledispatch
def surface_layers(shape: Shape, layering: Layering) -> np.ndarray:
    """Layers (n, dimension) [m] along the surface of a primitive."""
    raise TypeError(f"no layers are defined for {type(shape).__name__}")


@surface_layers.register(Polygon)
@surface_layers.register(Naca)
def _(shape: Polygon | Naca, layering: Layering) -> np.ndarray:
    return polygon_layers(shape.outline, layering.depths, layering.outward, layering.spacing)


@surface_layers.register
def _(shape: Sphere, layering: Layering) -> np.ndarray:
    if len(shape.center) == 2:
        return disc_layers(shape.center, shape.radius, layering.depths, layering.outward, layering.spacing)
    depths = layering.depths
    radii = shape.radius + depths if layering.outward else (shape.radius - depths)[depths < shape.radius]
    shells = [np.array(shape.center) + _shell(radius, layering.spacing) for radius in radii]
    return np.concatenate([np.empty((0, 3)), *shells])


@surface_layers.register
def _(shape: Box, layering: Layering) -> np.ndarray:
    (x_min, y_min), (x_max, y_max) = shape.min[:2], shape.max[:2]
    face = Polygon(points=((x_min, y_min), (x_max, y_min), (x_max, y_max), (x_min, y_max)))
    if len(shape.min) == 2:
        return surface_layers(face, layering)
    return _prism_layers(face, np.eye(3), shape.min[2], shape.max[2], layering)


@surface_layers.register
def _(shape: Extrusion, layering: Layering) -> np.ndarray:
    axis = "xyz".index(shape.axis)
    across = [k for k in range(3) if k != axis]
    frame = np.eye(3)[:, [*across, axis]]
    section = shape.section or Polygon(points=shape.points)
    return _prism_layers(section, frame, shape.low, shape.high, layering)


@surface_layers.register
def _(shape: Cylinder, layering: Layering) -> np.ndarray:
    start, end = np.array(shape.start), np.array(shape.end)
    frame = _frame_along(end - start)
    (u, v, low), high = start @ frame, end @ frame[:, 2]
    return _prism_layers(Sphere(center=(u, v), radius=shape.radius), frame, low, high, layering)


@surface_layers.register
def _(shape: Plane, layering: Layering) -> np.ndarray:
    frame = _frame_along(np.array(shape.normal))
    point = np.array(shape.point)
    low, high = _plane_limits(shape, layering)
    reach = np.abs([low - point, high - point]).max(axis=0) @ np.abs(frame[:, :-1])
    ticks = [_symmetric_ticks(extent, layering.spacing) for extent in reach]
    depths = layering.depths if layering.outward else -layering.depths
    along = np.stack(np.meshgrid(*ticks, depths, indexing="ij"), axis=-1).reshape(-1, len(point))
    foot = point + along[:, :-1] @ frame[:, :-1].T
    margin = 1e-9 * layering.spacing
    within = np.all((foot >= low - margin) & (foot <= high + margin), axis=1)
    return foot[within] + np.outer(along[within, -1], frame[:, -1])


def _plane_limits(shape: Plane, layering: Layering) -> tuple[np.ndarray, np.ndarray]:
    if shape.bounds is not None:
        return np.array(shape.bounds.min), np.array(shape.bounds.max)
    if layering.limits is None:
        raise ValueError("a plane without bounds has no end")
    return layering.limits


def _prism_layers(
    section: Shape, frame: np.ndarray, low: float, high: float, layering: Layering
) -> np.ndarray:
    """Layers round a prism, whose section has its coordinates along the frame's first two columns."""
    anchor = layering.anchor @ frame
    flat = replace(layering, anchor=anchor[:2], limits=None)
    lattice = Lattice(layering.spacing, anchor[:2], np.eye(2))
    count = max(1, round((high - low) / layering.spacing))
    between = low + (np.arange(count) + 0.5) * (high - low) / count
    if layering.outward:
        beyond = np.concatenate([low - layering.depths, high + layering.depths])
        lateral, ends, end_depth = np.concatenate([between, beyond]), beyond, 0.0
    else:
        near_ends = np.minimum(between - low, high - between) < layering.thickness
        lateral, ends, end_depth = between, between[near_ends], layering.thickness
    return np.concatenate(
        [
            _stacked(surface_layers(section, flat), lateral) @ frame.T,
            _stacked(core(section, end_depth, lattice), ends) @ frame.T,
        ]
    )


def _stacked(section: np.ndarray, heights: np.ndarray) -> np.ndarray:
    """Points (n * m, 3): a plane arrangement (n, 2) at each of the heights (m,)."""
    repeated = np.tile(section, (len(heights), 1))
    return np.column_stack([repeated, np.repeat(heights, len(section))])


def _shell(radius: float, spacing: float) -> np.ndarray:
    """Points (n, 3) on a sphere about the origin, spread evenly along a Fibonacci spiral."""
    count = round(4.0 * np.pi * (radius / spacing) ** 2)
    if count < 2:
        return np.zeros((1, 3))
    height = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    longitude = np.pi * (3.0 - np.sqrt(5.0)) * np.arange(count)
    across = np.sqrt(1.0 - height**2)
    return radius * np.stack([across * np.cos(longitude), across * np.sin(longitude), height], axis=1)


def _frame_along(direction: np.ndarray) -> np.ndarray:
    """Orthonormal columns of which the last points along the direction; axes as far as possible."""
    dimension = len(direction)
    last = direction / np.linalg.norm(direction)
    start = np.argmax(np.abs(last))
    candidates = np.eye(dimension)[:, np.arange(dimension) != start]
    columns = [last]
    for candidate in candidates.T:
        column = candidate - sum(np.dot(candidate, known) * known for known in columns)
        columns.append(column / np.linalg.norm(column))
    return np.stack([*columns[1:], last], axis=1)


def _symmetric_ticks(reach: float, spacing: float) -> np.ndarray:
    """Coordinates (n,) at half a spacing, one and a half ... to both sides of zero, beyond `reach`."""
    half = (np.arange(int(np.ceil(reach / spacing)) + 1) + 0.5) * spacing
    return np.concatenate([-half[::-1], half])
