"""Mirror points of wall particles: as far before the surface as the particle is behind it."""

import numpy as np
import pytest

from warpsph.sampling.mirror import mirror_ways
from warpsph.scene.schema import Boundary

BOX = {"type": "box", "min": [0.0, 0.0], "max": [1.0, 1.0]}


def ways(shape: dict, side: str, points: list[list[float]], period=None, **more) -> np.ndarray:
    boundary = Boundary.model_validate({"shape": shape, "side": side, **more})
    return mirror_ways(boundary, np.array(points), 0.1, period or {})


@pytest.mark.parametrize(
    ("side", "point", "way"),
    [
        ("outside", [0.5, -0.15], [0.0, 0.3]),
        ("outside", [1.05, 0.5], [-0.1, 0.0]),
        ("outside", [-0.1, -0.1], [0.2, 0.2]),  # across the corner
        ("inside", [0.5, 0.95], [0.0, 0.1]),
        ("solid", [0.25, 0.5], [-0.5, 0.0]),
        ("inside", [0.5, 0.5], [0.0, 0.0]),  # as far from all sides
    ],
)
def test_mirror_points_of_a_box(side, point, way):
    assert ways(BOX, side, [point])[0] == pytest.approx(way, abs=1e-6)


def test_mirror_points_of_a_disc_lie_on_its_rays():
    points = [[0.9, 0.0], [0.0, -0.75], [0.6, 0.6]]
    found = np.array(points) + ways({"type": "sphere", "center": [0.0, 0.0], "radius": 1.0}, "inside", points)
    radius = np.linalg.norm(points, axis=1)
    assert np.linalg.norm(found, axis=1) == pytest.approx(2.0 - radius, abs=1e-6)
    assert found / np.linalg.norm(found, axis=1)[:, None] == pytest.approx(points / radius[:, None], abs=1e-6)


def test_a_plate_that_fills_the_period_has_no_ends():
    assert ways(BOX, "solid", [[0.02, 0.9]])[0] == pytest.approx([-0.04, 0.0], abs=1e-6)
    assert ways(BOX, "solid", [[0.02, 0.9]], {0: (0.0, 1.0)})[0] == pytest.approx([0.0, 0.2], abs=1e-6)


def test_an_open_face_is_no_surface():
    point = [[-0.05, 1.02]]
    assert ways(BOX, "outside", point, open=["y_max"])[0] == pytest.approx([0.1, 0.0], abs=1e-6)
