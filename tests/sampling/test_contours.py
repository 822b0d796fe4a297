"""Layers along plane outlines: at their depth, evenly spaced, closed round corners."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from warpsph.sampling.contours import circle, disc_layers, polygon_layers
from warpsph.sampling.distance import polygon_distance
from warpsph.sampling.packing import CLOSEST

SPACING = 0.05
DEPTHS = SPACING * np.array([0.5, 1.5, 2.5])
HOLE_OF_SQUARE_LATTICE = np.sqrt(0.5)

STAR = np.array(
    [[r * np.cos(a), r * np.sin(a)] for r, a in zip([1.0, 0.5] * 5, np.pi / 5 * np.arange(10), strict=True)]
)
OUTLINES = {
    "triangle": np.array([[0.0, 0.0], [1.0, 0.0], [0.3, 0.8]]),
    "step": np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.5, 0.5], [0.5, 1.0], [0.0, 1.0]]),
    "star": STAR,
    "ellipse": np.stack([0.8 * np.cos(t := 2 * np.pi * np.arange(200) / 200), 0.3 * np.sin(t)], axis=1),
}


def nearest_neighbours(points: np.ndarray) -> np.ndarray:
    return cKDTree(points).query(points, 2)[0][:, 1]


@pytest.mark.parametrize("outward", [True, False])
@pytest.mark.parametrize("name", OUTLINES)
def test_layers_fill_the_band_without_hole_or_crowd(name: str, outward: bool) -> None:
    """Between layers no point is much farther from a particle than the middle of a lattice's cell."""
    corners, side = OUTLINES[name], 1.0 if outward else -1.0
    points = polygon_layers(corners, DEPTHS, outward, SPACING)
    grid = np.stack(np.meshgrid(*[np.arange(-1.2, 1.2, 0.01)] * 2), axis=-1).reshape(-1, 2)
    behind = side * polygon_distance(corners, grid)
    band = grid[(behind > DEPTHS[0]) & (behind < DEPTHS[-1])]
    assert nearest_neighbours(points).min() > CLOSEST * SPACING
    assert cKDTree(points).query(band)[0].max() < 1.2 * HOLE_OF_SQUARE_LATTICE * SPACING
    assert np.all(side * polygon_distance(corners, points) > 0.0)


def test_layers_of_a_rectangle_are_the_lattice_with_its_corners_filled() -> None:
    rectangle = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.0, 0.5]])
    points = polygon_layers(rectangle, DEPTHS, True, SPACING)
    on_lattice = points / SPACING - 0.5
    assert np.allclose(on_lattice, np.round(on_lattice), atol=1e-9)
    assert len(points) == 26 * 16 - 20 * 10


def test_turning_the_outline_round_changes_nothing() -> None:
    one, other = (polygon_layers(c, DEPTHS, True, SPACING) for c in (STAR, STAR[::-1]))
    assert cKDTree(one).query(other)[0].max() < 0.5 * SPACING
    assert len(one) == pytest.approx(len(other), rel=0.02)


def test_a_finely_divided_circle_gets_the_rings_of_a_disc() -> None:
    angle = 2.0 * np.pi * np.arange(400) / 400
    outline = 0.5 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = polygon_layers(outline, DEPTHS, True, SPACING)
    rings = disc_layers([0.0, 0.0], 0.5, DEPTHS, True, SPACING)
    assert len(points) == len(rings)
    radii = np.sort(np.linalg.norm(points, axis=1))
    assert radii == pytest.approx(np.sort(np.linalg.norm(rings, axis=1)), abs=1e-3 * SPACING)


def test_a_wall_thinner_than_the_spacing_keeps_one_row() -> None:
    """A wedge with a tip of 5 degrees is 23 spacings long where it is thinner than two layers."""
    tip = np.array([[0.0, 0.0], [1.0, -0.0435], [1.0, 0.0435]])
    points = polygon_layers(tip, DEPTHS, False, SPACING)
    centerline = np.stack([np.linspace(0.1, 1.0, 100), np.zeros(100)], axis=1)
    assert cKDTree(points).query(centerline)[0].max() < SPACING


@pytest.mark.parametrize("outward", [True, False])
def test_rings_of_a_disc_are_evenly_spaced(outward: bool) -> None:
    center, radius = np.array([1.0, 2.0]), 0.31
    points = disc_layers(center, radius, DEPTHS, outward, SPACING)
    depth = np.abs(np.linalg.norm(points - center, axis=1) - radius)
    assert np.unique(depth.round(9)) == pytest.approx(DEPTHS)
    for layer in DEPTHS:
        ring = points[np.isclose(depth, layer)]
        assert nearest_neighbours(ring) == pytest.approx(SPACING, rel=0.1)


@pytest.mark.parametrize(("radius", "count"), [(0.1, 1), (0.5, 3), (10.0, 63)])
def test_points_on_a_circle(radius: float, count: int) -> None:
    assert len(circle(radius, 1.0)) == count
