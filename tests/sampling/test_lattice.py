"""Cells of a lattice that belong to a shape."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from warpsph.sampling.distance import signed_distance
from warpsph.sampling.lattice import TIE, Lattice, cells_inside
from warpsph.scene.placement import rotation_matrix
from warpsph.scene.shapes import Box, Cylinder, Difference, Polygon, Shape, Sphere


def lattice(spacing: float, dimension: int = 2, angle: float = 0.0) -> Lattice:
    return Lattice(spacing, np.zeros(dimension), rotation_matrix(np.deg2rad(angle), None, dimension))


@given(st.floats(0.3, 3.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_count_agrees_with_the_area_to_half_a_cell_along_the_edge(radius: float, x: float, y: float) -> None:
    """All cells of a disc lie in the disc grown by half a cell's diagonal and fill the one shrunk by it."""
    spacing = 0.05
    count = len(cells_inside(lattice(spacing), Sphere(center=(x, y), radius=radius)).positions())
    half_diagonal = spacing / np.sqrt(2.0)
    assert (
        np.pi * (radius - half_diagonal) ** 2 <= count * spacing**2 <= np.pi * (radius + half_diagonal) ** 2
    )


SHAPES = [
    Difference(base=Box(min=(0.0, 0.0), max=(2.0, 1.3)), subtract=(Sphere(center=(1.0, 1.0), radius=0.4),)),
    Polygon(points=((0.0, 0.0), (3.0, 0.1), (1.0, 0.7), (1.2, 2.0))),
    Cylinder(start=(0.0, 0.0, 0.0), end=(1.0, 0.5, 0.2), radius=0.3),
]


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.type)
@pytest.mark.parametrize("angle", [0.0, 25.0])
def test_block_by_block_is_the_same_as_cell_by_cell(shape: Shape, angle: float) -> None:
    grid = lattice(0.03, dimension=3 if shape.type == "cylinder" else 2, angle=angle)
    dimension = len(grid.origin)
    cells = np.moveaxis(np.indices((250,) * dimension if dimension == 2 else (90,) * 3), 0, -1)
    cells = cells.reshape(-1, dimension) - (100 if dimension == 2 else 30)
    inside = signed_distance(shape, grid.centers(cells - TIE)) < 0.0
    found = cells_inside(grid, shape).positions()
    assert len(found) == inside.sum()
    assert np.allclose(found, grid.centers(cells[inside]), atol=1e-12)


@given(st.integers(1, 200).map(lambda halves: halves / 2.0) | st.floats(0.6, 100.0))
def test_two_boxes_that_touch_share_no_cell_and_leave_none(cut: float) -> None:
    """Also where the common face runs through cell centres, half a spacing off the lattice."""
    grid = lattice(1.0)
    left = cells_inside(grid, Box(min=(0.0, 0.0), max=(cut, 3.0)))
    right = cells_inside(grid, Box(min=(cut, 0.0), max=(101.0, 3.0)))
    columns = np.sort(np.concatenate([left.positions(), right.positions()])[:, 0])
    assert np.array_equal(columns, np.repeat(np.arange(101) + 0.5, 3))


@pytest.mark.parametrize(("length", "cells"), [(1.0, 10), (1.04, 10), (1.06, 11), (0.1 * 3, 3)])
def test_a_length_is_rounded_to_the_nearest_multiple(length: float, cells: int) -> None:
    assert len(cells_inside(lattice(0.1), Box(min=(0.0, 0.0), max=(length, 0.1))).positions()) == cells


def test_first_particle_is_half_a_spacing_inside_the_face() -> None:
    positions = cells_inside(lattice(0.1), Box(min=(0.0, 0.2), max=(0.5, 0.4))).positions()
    assert positions.min(axis=0) == pytest.approx([0.05, 0.25])
    assert positions.max(axis=0) == pytest.approx([0.45, 0.35])
