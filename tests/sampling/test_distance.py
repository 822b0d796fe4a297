"""Signed distances against hand values, other shapes and the laws they must obey."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from pydantic import TypeAdapter

from warpsph.sampling.distance import polygon_distance, signed_distance, steepest_direction
from warpsph.scene.placement import placement
from warpsph.scene.shapes import Box, Cylinder, Extrusion, Plane, Polygon, Shape, Sphere, Transform

POINTS_2D = arrays(np.float64, (20, 2), elements=st.floats(-3.0, 3.0))
POINTS_3D = arrays(np.float64, (20, 3), elements=st.floats(-3.0, 3.0))
STEP = ((0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0))


def shape_of(**spec: object) -> Shape:
    return TypeAdapter(Shape).validate_python(spec)


COMBINED = shape_of(
    type="difference",
    base={
        "type": "union",
        "shapes": [
            {"type": "box", "min": [-1.0, -1.0], "max": [1.0, 0.5]},
            {"type": "polygon", "points": [[0.0, 0.0], [2.0, 0.0], [1.0, 2.0]]},
        ],
    },
    subtract=[{"type": "sphere", "center": [0.0, 0.0], "radius": 0.7}],
)


@pytest.mark.parametrize(
    ("shape", "point", "distance"),
    [
        (Box(min=(0.0, 0.0), max=(2.0, 1.0)), (1.0, 0.6), -0.4),
        (Box(min=(0.0, 0.0), max=(2.0, 1.0)), (5.0, 5.0), 5.0),
        (Box(min=(0.0, 0.0, 0.0), max=(1.0, 1.0, 1.0)), (3.0, 0.5, 0.5), 2.0),
        (Sphere(center=(1.0, 0.0), radius=2.0), (1.0, 0.5), -1.5),
        (Cylinder(start=(0.0, 0.0, 0.0), end=(0.0, 0.0, 4.0), radius=1.0), (4.0, 0.0, 8.0), 5.0),
        (Cylinder(start=(0.0, 0.0, 0.0), end=(4.0, 0.0, 0.0), radius=1.0), (2.0, 0.0, 0.25), -0.75),
        (Polygon(points=STEP), (1.5, 1.5), 0.5),
        (Polygon(points=STEP), (0.5, 0.5), -0.5),
        (Polygon(points=STEP), (1.25, 1.5), 0.25),
        (Extrusion(points=STEP, axis="y", low=0.0, high=1.0), (0.5, 0.9, 0.5), -0.1),
        (Extrusion(points=STEP, axis="y", low=0.0, high=1.0), (-3.0, 5.0, 0.5), 5.0),
        (Plane(point=(0.0, 1.0), normal=(0.0, 2.0)), (7.0, 3.0), 2.0),
    ],
)
def test_distance_by_hand(shape: Shape, point: tuple[float, ...], distance: float) -> None:
    assert signed_distance(shape, np.array([point])) == pytest.approx([distance], abs=1e-14)


@given(POINTS_2D)
def test_rectangle_as_polygon_is_a_box(points: np.ndarray) -> None:
    corners = np.array([[-1.0, 0.0], [2.0, 0.0], [2.0, 1.5], [-1.0, 1.5]])
    rectangle = Box(min=(-1.0, 0.0), max=(2.0, 1.5))
    expected = signed_distance(rectangle, points)
    for outline in (corners, corners[::-1]):
        assert polygon_distance(outline, points) == pytest.approx(expected, abs=1e-12)


@given(POINTS_3D)
def test_extruded_rectangle_is_a_box(points: np.ndarray) -> None:
    rectangle = ((-1.0, -0.5), (1.0, -0.5), (1.0, 2.0), (-1.0, 2.0))
    prism = Extrusion(points=rectangle, axis="x", low=0.0, high=1.5)
    same = Box(min=(0.0, -1.0, -0.5), max=(1.5, 1.0, 2.0))
    assert signed_distance(prism, points) == pytest.approx(signed_distance(same, points), abs=1e-12)


@given(POINTS_2D, POINTS_2D)
def test_no_distance_changes_faster_than_one_walks(first: np.ndarray, second: np.ndarray) -> None:
    change = np.abs(signed_distance(COMBINED, first) - signed_distance(COMBINED, second))
    assert np.all(change <= np.linalg.norm(first - second, axis=1) + 1e-12)


@given(POINTS_2D)
def test_combined_sign_is_that_of_set_algebra(points: np.ndarray) -> None:
    (base, disc) = (part for _, part in COMBINED.parts())
    united = np.any([signed_distance(part, points) < 0.0 for _, part in base.parts()], axis=0)
    inside = united & ~(signed_distance(disc, points) < 0.0)
    off_surface = np.abs(signed_distance(COMBINED, points)) > 1e-12
    assert np.array_equal((signed_distance(COMBINED, points) < 0.0)[off_surface], inside[off_surface])


@given(POINTS_3D, st.floats(-360.0, 360.0), st.floats(0.1, 10.0))
def test_transform_carries_the_distance_with_it(points: np.ndarray, angle: float, scale: float) -> None:
    inner = Cylinder(start=(0.0, 0.0, 0.0), end=(1.0, 1.0, 0.0), radius=0.5)
    moved = Transform(
        shape=inner,
        scale=scale,
        rotate={"angle": angle, "axis": (1.0, 2.0, -1.0), "center": (0.3, 0.0, 1.0)},
        translate=(1.0, -2.0, 0.5),
    )
    rotation, displacement = placement(moved, 3)
    images = scale * points @ rotation.T + displacement
    expected = scale * signed_distance(inner, points)
    assert signed_distance(moved, images) == pytest.approx(expected, abs=1e-9 * scale)


def test_steepest_direction_points_away_from_a_disc() -> None:
    disc = Sphere(center=(0.0, 0.0), radius=1.0)
    points = np.array([[3.0, 4.0], [-0.2, 0.0]])
    direction = steepest_direction(lambda at: signed_distance(disc, at), points, 1e-5)
    assert direction == pytest.approx(np.array([[0.6, 0.8], [-1.0, 0.0]]), abs=1e-9)
