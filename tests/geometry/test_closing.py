"""Surfaces are closed, face outwards and enclose the right volume, or are refused with the place that is wrong."""

import mesh_builders as build
import numpy as np
import pytest

from warpsph.geometry.closing import closed_mesh
from warpsph.geometry.errors import GeometryError
from warpsph.geometry.winding import winding_number


def test_volume_of_a_box_is_that_of_its_edges() -> None:
    mesh = closed_mesh(*build.box((-1.0, 2.0, 0.0), (0.5, 3.0, 4.0)))
    assert mesh.volume == pytest.approx(1.5 * 1.0 * 4.0, rel=1e-14)


@pytest.mark.parametrize("fineness", [2, 3, 4])
def test_volume_of_a_sphere_converges_in_second_order(fineness: int) -> None:
    """Chords of an edge e lie up to e^2 / (8 R) inside: halving the edges quarters the volume that is missing."""

    def missing(level: int) -> float:
        return 4.0 / 3.0 * np.pi - closed_mesh(*build.ball(fineness=level)).volume

    assert missing(fineness - 1) / missing(fineness) == pytest.approx(4.0, rel=0.1)


def test_vertices_of_each_triangle_for_itself_are_joined() -> None:
    """An STL file repeats the corners of every triangle."""
    vertices, faces = build.ball(fineness=2)
    rounded = vertices[faces].reshape(-1, 3).astype(np.float32).astype(np.float64)
    mesh = closed_mesh(rounded, np.arange(faces.size).reshape(-1, 3))
    assert len(mesh.vertices) == len(vertices)


def test_open_surface_is_refused_with_number_and_place() -> None:
    vertices, faces = build.box()
    with pytest.raises(
        GeometryError, match=r"open along 4 of its 17 edges, in 1 place, the first from \("
    ) as refused:
        closed_mesh(vertices, _without(faces, vertices, axis=2, value=1.0))
    assert "(0, 0, 1)" in str(refused.value)
    assert "Fill Holes" in str(refused.value)


def test_two_holes_are_two_places() -> None:
    vertices, faces = build.box()
    both = _without(_without(faces, vertices, axis=2, value=1.0), vertices, axis=2, value=0.0)
    with pytest.raises(GeometryError, match=r"in 2 places"):
        closed_mesh(vertices, both)


def test_surface_of_mixed_winding_is_wound_alike() -> None:
    vertices, faces = build.ball(fineness=2)
    mixed = np.where(np.random.default_rng(1).random((len(faces), 1)) < 0.4, faces[:, ::-1], faces)
    assert closed_mesh(vertices, mixed).volume == pytest.approx(
        closed_mesh(vertices, faces).volume, rel=1e-12
    )


def test_surface_without_two_sides_is_refused() -> None:
    """A Klein bottle: a grid whose columns close with the rows reversed. Its places do not matter."""
    n = 8
    number = np.arange(n * n).reshape(n, n)
    wrapped = np.vstack([number, np.roll(number[:1, ::-1], 1, axis=1)])
    wrapped = np.hstack([wrapped, wrapped[:, :1]])
    a, b, c, d = wrapped[:-1, :-1], wrapped[1:, :-1], wrapped[1:, 1:], wrapped[:-1, 1:]
    faces = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    with pytest.raises(GeometryError, match="cannot agree on which side is outside"):
        closed_mesh(np.random.default_rng(0).random((n * n, 3)), faces)


def test_flat_surface_encloses_nothing() -> None:
    triangle = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    with pytest.raises(GeometryError, match="no volume"):
        closed_mesh(triangle, np.array([[0, 1, 2], [0, 2, 1]]))


def test_shell_that_faces_inwards_within_another_is_a_cavity() -> None:
    hollow = build.together(
        build.box((-2.0,) * 3, (2.0,) * 3), build.reversed_(build.box((-1.0,) * 3, (1.0,) * 3))
    )
    for triangles in (hollow, build.reversed_(hollow)):
        mesh = closed_mesh(*triangles)
        assert mesh.volume == pytest.approx(64.0 - 8.0, rel=1e-14)
        assert winding_number(mesh.corners, np.zeros(3)) == pytest.approx(0.0, abs=1e-12)
        assert winding_number(mesh.corners, np.array([1.5, 0.0, 0.0])) == pytest.approx(1.0, abs=1e-12)


def test_body_that_faces_inwards_beside_another_is_turned() -> None:
    mesh = closed_mesh(
        *build.together(build.box(), build.reversed_(build.box((3.0, 0.0, 0.0), (3.5, 1.0, 1.0))))
    )
    assert mesh.volume == pytest.approx(1.5, rel=1e-14)


def test_index_without_a_vertex_is_refused() -> None:
    vertices, faces = build.box()
    with pytest.raises(GeometryError, match="no vertex"):
        closed_mesh(vertices[:-1], faces)


def _without(faces: np.ndarray, vertices: np.ndarray, axis: int, value: float) -> np.ndarray:
    """The faces less those in a plane across an axis."""
    return faces[~(vertices[faces][:, :, axis] == value).all(axis=1)]
