"""Distances from meshes against those of the same bodies in closed form."""

import mesh_builders as build
import numpy as np
import pytest

from warpsph.geometry.closing import closed_mesh
from warpsph.geometry.mesh_distance import mesh_distance
from warpsph.sampling.distance import signed_distance
from warpsph.scene.shapes import Box

LOW, HIGH = (3.0, -1.0, 0.5), (4.0, 1.0, 3.5)


def points_about(low: tuple[float, ...], high: tuple[float, ...], count: int = 20_000) -> np.ndarray:
    middle, size = np.add(low, high) / 2.0, np.subtract(high, low)
    return middle + 1.6 * size * (np.random.default_rng(0).random((count, 3)) - 0.5)


def test_distance_from_a_box() -> None:
    """The nearest triangle is found in single precision, so that a nearer one may be missed by its rounding."""
    points = points_about(LOW, HIGH)
    distance = mesh_distance(closed_mesh(*build.box(LOW, HIGH)))(points)
    assert distance == pytest.approx(signed_distance(Box(min=LOW, max=HIGH), points), abs=3.0 * 2.0**-24)


def test_distance_from_a_ball_is_within_the_sagitta_of_its_triangles() -> None:
    vertices, faces = build.ball()
    longest = np.linalg.norm(vertices[faces] - np.roll(vertices[faces], 1, axis=1), axis=2).max()
    points = points_about((-1.0,) * 3, (1.0,) * 3)
    excess = mesh_distance(closed_mesh(vertices, faces))(points) - (np.linalg.norm(points, axis=1) - 1.0)
    assert excess.min() > -1e-7
    assert excess.max() < longest**2 / 6.0  # of an equilateral triangle, e^2 / (6 R)


@pytest.mark.parametrize("depth", [1e-2, 1e-4, 1e-6, 1e-8, 1e-10])
def test_side_of_points_close_to_the_surface(depth: float) -> None:
    """Where single precision no longer tells the sides apart, the direction from the nearest point does."""
    mesh = closed_mesh(*build.ball(radius=50.0, center=(300.0, 0.0, 0.0)))
    a, b, c = np.moveaxis(mesh.corners, 1, 0)
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    for side in (1.0, -1.0):
        distance = mesh_distance(mesh)((a + b + c) / 3.0 + side * depth * normal)
        assert np.all(np.sign(distance) == side)
        assert distance == pytest.approx(np.full(len(distance), side * depth), abs=1e-12 * 300.0)


def test_points_in_the_planes_of_faces_have_a_side() -> None:
    """A lattice often has its points in the plane of a face but for rounding."""
    points = points_about(LOW, HIGH)
    points[:, 0] = HIGH[0] + np.where(np.arange(len(points)) % 2 == 0, 1e-9, -1e-9)
    distance = mesh_distance(closed_mesh(*build.box(LOW, HIGH)))(points)
    expected = signed_distance(Box(min=LOW, max=HIGH), points)
    assert np.array_equal(np.sign(distance), np.sign(expected))


def test_cavity_is_outside() -> None:
    hollow = build.together(build.ball(2.0), build.reversed_(build.ball(1.0)))
    distance = mesh_distance(closed_mesh(*hollow))(
        np.array([[0.0, 0.0, 0.0], [1.5, 0.0, 0.0], [3.0, 0.0, 0.0]])
    )
    assert distance == pytest.approx([1.0, -0.5, 1.0], abs=5e-3)


def test_overlapping_shells_are_one_solid() -> None:
    """Also in the planes of the faces that lie within the other box."""
    both = build.together(
        build.box((0.0, 0.0, 0.0), (2.0, 1.0, 1.0)), build.box((1.0, 0.2, 0.2), (3.0, 0.8, 0.8))
    )
    hidden = np.array(
        [[1.0 + 1e-12, 0.5, 0.5], [1.0 - 1e-9, 0.4, 0.5], [2.0 - 1e-12, 0.5, 0.5], [2.0 + 1e-9, 0.5, 0.6]]
    )
    visible = np.array([[0.5, 0.5, 0.5], [2.5, 0.5, 0.5], [2.5, 0.1, 0.5]])
    distance = mesh_distance(closed_mesh(*both))
    assert np.all(distance(hidden) < 0.0)
    assert distance(visible) == pytest.approx([-0.5, -0.3, 0.1], abs=1e-6)


def test_any_number_of_points() -> None:
    distance = mesh_distance(closed_mesh(*build.box()))
    points = np.tile([[0.5, 0.5, 0.75]], (9000, 1))
    for count in (0, 1, 4096, 4097, 9000):
        assert distance(points[:count]) == pytest.approx(np.full(count, -0.25))
