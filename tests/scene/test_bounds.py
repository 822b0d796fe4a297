"""Boxes around shapes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter

from warpsph.scene.bounds import bounding_box, extent
from warpsph.scene.placement import cross_matrix, placement, rotation_matrix
from warpsph.scene.shapes import Box, Cylinder, Extrusion, Plane, Polygon, Shape, Sphere, Transform

TRIANGLE = ((0.0, 0.0), (2.0, 0.5), (1.0, 3.0))


@pytest.mark.parametrize(
    ("shape", "low", "high"),
    [
        (Box(min=(0.0, -1.0), max=(2.0, 3.0)), (0.0, -1.0), (2.0, 3.0)),
        (Sphere(center=(1.0, 0.0, 2.0), radius=0.5), (0.5, -0.5, 1.5), (1.5, 0.5, 2.5)),
        (Cylinder(start=(0.0, 0.0, 1.0), end=(0.0, 4.0, 1.0), radius=0.5), (-0.5, 0.0, 0.5), (0.5, 4.0, 1.5)),
        (Polygon(points=TRIANGLE), (0.0, 0.0), (2.0, 3.0)),
        (Extrusion(points=TRIANGLE, axis="y", low=-1.0, high=1.0), (0.0, -1.0, 0.0), (2.0, 1.0, 3.0)),
        (Plane(point=(0.0, 2.0), normal=(0.0, 5.0)), (-np.inf, -np.inf), (np.inf, 2.0)),
        (Plane(point=(0.0, 2.0), normal=(0.0, -1.0)), (-np.inf, 2.0), (np.inf, np.inf)),
        (Plane(point=(0.0, 2.0), normal=(1.0, 1.0)), (-np.inf, -np.inf), (np.inf, np.inf)),
    ],
)
def test_box_by_hand(shape: Shape, low: tuple[float, ...], high: tuple[float, ...]) -> None:
    found = bounding_box(shape)
    assert found[0] == pytest.approx(low)
    assert found[1] == pytest.approx(high)


def test_combined_shapes() -> None:
    parts = [
        {"type": "box", "min": [0.0, 0.0], "max": [2.0, 1.0]},
        {"type": "sphere", "center": [2.0, 0.5], "radius": 1.0},
    ]
    adapter = TypeAdapter(Shape)
    united = adapter.validate_python({"type": "union", "shapes": parts})
    common = adapter.validate_python({"type": "intersection", "shapes": parts})
    rest = adapter.validate_python({"type": "difference", "base": parts[0], "subtract": [parts[1]]})
    assert np.array_equal(bounding_box(united), [[0.0, -0.5], [3.0, 1.5]])
    assert np.array_equal(bounding_box(common), [[1.0, 0.0], [2.0, 1.0]])
    assert np.array_equal(bounding_box(rest), [[0.0, 0.0], [2.0, 1.0]])


@given(st.floats(-720.0, 720.0), st.floats(0.1, 10.0), st.floats(0.0, 6.3))
def test_extent_of_a_transformed_polygon_is_that_of_its_corners(
    angle: float, scale: float, towards: float
) -> None:
    shape = Transform(
        shape=Polygon(points=TRIANGLE),
        scale=scale,
        rotate={"angle": angle, "center": (1.0, -2.0)},
        translate=(3.0, 0.5),
    )
    rotation, displacement = placement(shape, 2)
    direction = np.array([np.cos(towards), np.sin(towards)])
    along = (scale * np.array(TRIANGLE) @ rotation.T + displacement) @ direction
    assert extent(shape, direction) == pytest.approx((along.min(), along.max()), abs=1e-9)


def test_box_in_turned_axes() -> None:
    turned = Transform(shape=Box(min=(1.0, 2.0), max=(3.0, 5.0)), rotate={"angle": 30.0})
    low, high = bounding_box(turned, rotation_matrix(np.deg2rad(30.0), None, 2))
    assert low == pytest.approx([1.0, 2.0])
    assert high == pytest.approx([3.0, 5.0])


@given(
    st.floats(-7.0, 7.0),
    st.tuples(*[st.floats(-2.0, 2.0)] * 3).filter(lambda axis: np.linalg.norm(axis) > 0.1),
)
def test_rotation_matrix_is_a_rotation_about_its_axis(angle: float, axis: tuple[float, float, float]) -> None:
    """It keeps its axis, is orthogonal, and its trace is 1 + 2 cos(angle), in the right-handed sense."""
    matrix = rotation_matrix(angle, axis, 3)
    assert matrix @ axis == pytest.approx(np.array(axis), abs=1e-12)
    assert matrix @ matrix.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.trace(matrix) == pytest.approx(1.0 + 2.0 * np.cos(angle), abs=1e-12)
    across = np.cross(axis, [0.3, -1.0, 0.7])
    assert np.dot(np.cross(across, matrix @ across), axis) * np.sin(angle) >= -1e-12


def test_cross_matrix_is_the_cross_product() -> None:
    first, second = np.array([1.0, -2.0, 0.5]), np.array([0.3, 4.0, -1.0])
    assert cross_matrix(first) @ second == pytest.approx(np.cross(first, second))
