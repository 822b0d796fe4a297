"""The camera's geometry."""

from __future__ import annotations

import numpy as np
import pytest

from warpsph.rendering.camera import frame_box, look_direction

LOW, HIGH = np.array([-1.0, 0.5, 0.0]), np.array([3.0, 1.5, 1.0])
CORNERS = np.array(np.meshgrid(*zip(LOW, HIGH, strict=True))).reshape(3, -1).T


@pytest.mark.parametrize("up_axis", [1, 2])
@pytest.mark.parametrize(("azimuth", "elevation"), [(0.0, 0.0), (25.0, 18.0), (-130.0, 60.0)])
def test_axes_are_a_rotation_with_up_upwards(up_axis: int, azimuth: float, elevation: float) -> None:
    right, up, forward = look_direction(azimuth, elevation, up_axis)
    np.testing.assert_allclose(
        np.stack([right, up, forward]) @ np.stack([right, up, forward]).T, np.eye(3), atol=1e-12
    )
    np.testing.assert_allclose(np.cross(right, up), -forward, atol=1e-12)
    assert right[up_axis] == pytest.approx(0.0)
    assert up[up_axis] == pytest.approx(np.cos(np.radians(elevation)))


@pytest.mark.parametrize("size", [(1280, 720), (400, 900)])
def test_whole_box_is_seen_and_fills_the_picture(size: tuple[int, int]) -> None:
    camera = frame_box(LOW, HIGH, size, up_axis=2, margin=0.05)
    column, row, depth = camera.project(CORNERS).T
    assert np.all(depth > 0.0)
    left, right, top, bottom = column.min(), size[0] - column.max(), row.min(), size[1] - row.max()
    margins = np.array([left, right, top, bottom]) / np.repeat(size, 2)
    assert margins.min() == pytest.approx(0.05, abs=1e-6)
    assert left == pytest.approx(right, abs=1e-6 * size[0]) or top == pytest.approx(
        bottom, abs=1e-6 * size[1]
    )


def test_higher_points_are_higher_in_the_picture_and_farther_ones_deeper() -> None:
    camera = frame_box(LOW, HIGH, (640, 360), up_axis=2, azimuth=0.0, elevation=10.0)
    middle = (LOW + HIGH) / 2.0
    _, high_row, _ = camera.project(middle[None] + [[0.0, 0.0, 0.4]])[0]
    _, low_row, _ = camera.project(middle[None])[0]
    assert high_row < low_row
    assert camera.project(middle[None] + [[0.0, 1.0, 0.0]])[0, 2] > camera.project(middle[None])[0, 2]


def test_magnified_camera_sees_the_same_in_more_pixels() -> None:
    camera = frame_box(LOW, HIGH, (320, 180), up_axis=2)
    np.testing.assert_allclose(
        camera.magnified(2).project(CORNERS)[:, :2], 2.0 * camera.project(CORNERS)[:, :2], rtol=1e-12
    )
