"""Which shapes a lattice can follow, and how it has to be turned."""

import numpy as np
import pytest

from warpsph.sampling.axes import face_axes, own_axes, same_axes
from warpsph.scene.placement import rotation_matrix
from warpsph.scene.shapes import Box, Plane, Polygon, Sphere, Transform, Union

SQUARE = Box(min=(0.0, 0.0), max=(1.0, 1.0))
L_SHAPE = Polygon(points=((0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)))
TRIANGLE = Polygon(points=((0.0, 0.0), (1.0, 0.0), (0.5, 1.0)))


def turned(shape: Box | Polygon, angle: float) -> Transform:
    return Transform(shape=shape, rotate={"angle": angle})


@pytest.mark.parametrize("shape", [SQUARE, L_SHAPE, Plane(point=(0.0, 0.0), normal=(0.0, -3.0))])
def test_faces_along_the_axes(shape: Box) -> None:
    assert np.array_equal(face_axes(shape, 2), np.eye(2))


@pytest.mark.parametrize(
    "shape",
    [
        TRIANGLE,
        Sphere(center=(0.0, 0.0), radius=1.0),
        Plane(point=(0.0, 0.0), normal=(1.0, 1.0)),
        Union(shapes=(SQUARE, TRIANGLE)),
        Union(shapes=(SQUARE, turned(SQUARE, 20.0))),
    ],
)
def test_curved_oblique_and_mixed_faces_have_no_common_axes(shape: Polygon) -> None:
    assert face_axes(shape, 2) is None


def test_axes_turn_with_nested_transforms() -> None:
    nested = Transform(shape=turned(SQUARE, 20.0), rotate={"angle": 15.0}, translate=(3.0, 1.0))
    axes = face_axes(nested, 2)
    assert axes is not None
    assert axes == pytest.approx(rotation_matrix(np.deg2rad(35.0), None, 2))
    assert own_axes(nested, 2) == pytest.approx(axes)


@pytest.mark.parametrize(("angle", "same"), [(0.0, True), (90.0, True), (-270.0, True), (89.0, False)])
def test_a_quarter_turn_gives_the_same_axes(angle: float, same: bool) -> None:
    assert same_axes(np.eye(2), rotation_matrix(np.deg2rad(angle), None, 2)) == same
