"""What shapes enclose, where that has a closed form."""

from __future__ import annotations

from functools import singledispatch

import numpy as np

from warpsph.geometry.polygons import polygon_area
from warpsph.scene.bounds import dimension_of
from warpsph.scene.shapes import Box, Cylinder, Extrusion, Mesh, Naca, Polygon, Shape, Sphere, Transform


@singledispatch
def volume_of(shape: Shape) -> float | None:
    """Volume [m3], in two dimensions area [m2], of a shape; None for planes and combined shapes."""
    return None


@volume_of.register
def _(shape: Box) -> float:
    return float(np.prod(np.subtract(shape.max, shape.min)))


@volume_of.register
def _(shape: Sphere) -> float:
    return np.pi * (shape.radius**2 if len(shape.center) == 2 else 4.0 / 3.0 * shape.radius**3)


@volume_of.register
def _(shape: Cylinder) -> float:
    return float(np.pi * shape.radius**2 * np.linalg.norm(np.subtract(shape.end, shape.start)))


@volume_of.register(Polygon)
@volume_of.register(Naca)
def _(shape: Polygon | Naca) -> float:
    return abs(polygon_area(shape.outline))


@volume_of.register
def _(shape: Extrusion) -> float:
    return abs(polygon_area(shape.outline)) * (shape.high - shape.low)


@volume_of.register
def _(shape: Mesh) -> float:
    return shape.surface.volume


@volume_of.register
def _(shape: Transform) -> float | None:
    inner = volume_of(shape.shape)
    return None if inner is None else inner * shape.scale ** dimension_of(shape)
