"""Spheres on the canvas: place, size, what hides what, and surfaces that smoothing must leave alone."""

from __future__ import annotations

import numpy as np
import pytest
import warp as wp
from warpsph_kernels import surface_splatting as kernels

from warpsph.rendering.camera import Camera
from warpsph.rendering.canvas import BACKGROUND, Canvas, Material, Spheres, occlusion

RED, BLUE = Material(np.array([[1.0, 0.0, 0.0]])), Material(np.array([[0.0, 0.0, 1.0]]))


@pytest.fixture
def camera() -> Camera:
    """At the origin, looking along y with z up; a sphere at distance 10 is 20 pixels a metre wide."""
    axes = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
    return Camera(np.zeros(3), axes, focal=200.0, width=120, height=80)


def sphere(x: float, y: float, z: float, radius: float = 1.0) -> Spheres:
    return Spheres(np.array([[x, y, z]]), np.array([radius]), spacing=0.05)


def covered_by(picture: np.ndarray) -> np.ndarray:
    return np.any(np.abs(picture - BACKGROUND) > 1e-3, axis=-1)


def painted(camera: Camera, *layers: tuple[Spheres, Material]) -> np.ndarray:
    canvas = Canvas(camera)
    for spheres, material in layers:
        canvas.paint_front(spheres, np.zeros(len(spheres.radii)), material)
    return canvas.image()


def test_sphere_covers_its_disc(camera: Camera) -> None:
    covered = covered_by(painted(camera, (sphere(2.0, 10.0, 1.0), RED)))
    rows, columns = np.nonzero(covered)
    assert (columns.mean() + 0.5, rows.mean() + 0.5) == pytest.approx((60.0 + 40.0, 40.0 - 20.0), abs=0.5)
    assert covered.sum() == pytest.approx(np.pi * 20.0**2, rel=0.05)


def test_nearer_sphere_hides_the_farther_whatever_the_order(camera: Camera) -> None:
    near, far = (sphere(0.0, 8.0, 0.0), RED), (sphere(0.0, 12.0, 0.0), BLUE)
    for layers in ((near, far), (far, near)):
        red, _, blue = painted(camera, *layers)[40, 60]
        assert red > 5.0 * blue


def test_back_surface_lets_the_inside_be_seen(camera: Camera) -> None:
    """A front and a back wall: painted from the back, a sphere between them shows; from the front it does not."""
    walls = Spheres(np.array([[0.0, 8.0, 0.0], [0.0, 14.0, 0.0]]), np.array([1.0, 1.0]), spacing=0.05)
    canvas = Canvas(camera)
    canvas.paint_back(walls, BLUE)
    canvas.paint_front(sphere(0.0, 11.0, 0.0, 0.5), np.zeros(1), RED)
    red, _, blue = canvas.image()[40, 60]
    assert red > 5.0 * blue
    red, _, blue = painted(camera, (walls, BLUE), (sphere(0.0, 11.0, 0.0, 0.5), RED))[40, 60]
    assert blue > 5.0 * red


def test_values_choose_the_colour(camera: Camera) -> None:
    material = Material(np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]), low=10.0, high=20.0)
    for value, channel in ((10.0, 2), (20.0, 0), (1e9, 0), (-1e9, 2)):
        canvas = Canvas(camera)
        canvas.paint_front(sphere(0.0, 10.0, 0.0), np.array([value]), material)
        assert np.argmax(canvas.image()[40, 60]) == channel


def test_light_comes_from_above(camera: Camera) -> None:
    picture = painted(camera, (sphere(0.0, 10.0, 0.0), RED))
    assert picture[25, 60, 0] > picture[55, 60, 0] + 0.1


def test_spheres_behind_the_eye_are_not_drawn(camera: Camera) -> None:
    assert not covered_by(painted(camera, (sphere(0.0, -10.0, 0.0), RED))).any()


def test_copy_can_be_painted_without_changing_the_original(camera: Camera) -> None:
    canvas = Canvas(camera)
    canvas.copy().paint_front(sphere(0.0, 10.0, 0.0), np.zeros(1), RED)
    assert not covered_by(canvas.image()).any()


@pytest.mark.parametrize("along_rows", [0, 1])
def test_smoothing_leaves_a_plane_and_flattens_a_bump(along_rows: int) -> None:
    """Opposite neighbours of a plane have its mean, so nothing changes, up to rounding of depths near 10."""
    rows, columns = np.mgrid[0:40, 0:50]
    plane = (10.0 + 0.03 * rows - 0.05 * columns).astype(np.float32)
    bumpy = plane.copy()
    bumpy[20, 25] -= 0.1
    smoothed = []
    for depth in (plane, bumpy):
        result = wp.empty(depth.shape, dtype=float)
        wp.launch(kernels.smooth, depth.shape, [wp.array(depth), along_rows, 4, 0.5], [result])
        smoothed.append(result.numpy())
    np.testing.assert_allclose(smoothed[0], plane, atol=1e-5)
    assert abs(smoothed[1][20, 25] - plane[20, 25]) < 0.05


def test_smoothing_keeps_an_edge_between_two_surfaces() -> None:
    depth = np.full((5, 40), 10.0, np.float32)
    depth[:, 20:] = 12.0
    result = wp.empty(depth.shape, dtype=float)
    wp.launch(kernels.smooth, depth.shape, [wp.array(depth), 1, 6, 0.5], [result])
    np.testing.assert_array_equal(result.numpy(), depth)


def test_occlusion_darkens_the_ground_beside_a_body_and_nothing_else() -> None:
    depth = np.full((90, 90), 10.0, np.float32)
    depth[30:60, 30:60] = 8.0
    depth[:, 85:] = np.inf
    dark = occlusion(depth)
    assert dark[45, 62] > 0.3
    assert dark[45, 45] == dark[5, 5] == dark[45, 88] == 0.0
