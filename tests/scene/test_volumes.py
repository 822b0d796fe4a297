"""Volumes of shapes in closed form against hand values."""

from typing import Any

import numpy as np
import pytest
from pydantic import TypeAdapter

from warpsph.scene.shapes import Shape
from warpsph.scene.volumes import volume_of

BOX = {"type": "box", "min": [0.0, 0.0, 0.0], "max": [1.0, 2.0, 3.0]}
TRIANGLE = [[0.0, 0.0], [0.0, 2.0], [3.0, 0.0]]


@pytest.mark.parametrize(
    ("spec", "volume"),
    [
        (BOX, 6.0),
        ({"type": "sphere", "center": [1.0, 1.0], "radius": 2.0}, 4.0 * np.pi),
        ({"type": "sphere", "center": [1.0, 1.0, 0.0], "radius": 2.0}, 32.0 / 3.0 * np.pi),
        ({"type": "cylinder", "start": [0.0, 0.0, 0.0], "end": [0.0, 3.0, 4.0], "radius": 2.0}, 20.0 * np.pi),
        ({"type": "polygon", "points": TRIANGLE}, 3.0),
        ({"type": "extrusion", "points": TRIANGLE, "axis": "x", "low": -1.0, "high": 1.0}, 6.0),
        ({"type": "transform", "scale": 0.5, "shape": BOX}, 0.75),
        ({"type": "union", "shapes": [BOX]}, None),
        ({"type": "transform", "scale": 0.5, "shape": {"type": "union", "shapes": [BOX]}}, None),
        ({"type": "plane", "point": [0.0, 0.0], "normal": [0.0, 1.0]}, None),
    ],
)
def test_volume(spec: dict[str, Any], volume: float | None) -> None:
    assert volume_of(TypeAdapter(Shape).validate_python(spec)) == pytest.approx(volume)
