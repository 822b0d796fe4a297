"""A fluid field along a line, interpolated at the points of a table."""

from __future__ import annotations

import numpy as np

from warpsph.frame import Frame
from warpsph.probes import make_probe
from warpsph.scene.probes import PointField, PointProbe
from warpsph.scene.references import InlineProfile, ProfileReference
from warpsph.scene.schema import Scene
from warpsph.scene.tables import read_columns
from warpsph.scene.types import AXES

INTERPOLATED_FROM = ("density", "mass", "volume")
"""Fields that the interpolation needs beside positions and the field itself."""


def profile_values(reference: ProfileReference, scene: Scene, frame: Frame) -> np.ndarray:
    """Coordinates [m], interpolated values and those of the table, shape (3, points); a dry point is no number."""
    position, expected = read_profile(reference, scene)
    values = np.array([_value_at(float(x), reference, scene, frame) for x in position])
    return np.stack([position, values, expected])


def read_profile(reference: ProfileReference, scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates [m] and values of the table, in the unit of the field. Raises TableError."""
    table = reference.table
    if isinstance(table, InlineProfile):
        return np.array(table.position), np.array(table.value)
    position, value = read_columns(scene.base_directory / table.file, (table.position, table.value))
    return position * table.position_scale, value * table.value_scale


def _value_at(coordinate: float, reference: ProfileReference, scene: Scene, frame: Frame) -> float:
    point = list(reference.through)
    point[AXES.index(reference.axis)] = coordinate
    stored, component = _stored_field(reference.field)
    probe = make_probe("profile", PointProbe(at=tuple(point), fields=(stored,)), scene)
    return probe.evaluate(frame)[component]


def _stored_field(field: str) -> tuple[PointField, int]:
    """Name of the field that holds a component, and the component's index."""
    match field:
        case "pressure" | "density":
            return field, 0
        case _:
            return "velocity", AXES.index(field[-1])
