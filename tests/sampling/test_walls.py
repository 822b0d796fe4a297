"""Walls: on which side, how thick, where they end."""

from typing import Any

import numpy as np
import pytest
from builders import still_tank
from scipy.spatial import cKDTree
from structure_builders import block

from warpsph.sampling.distance import signed_distance
from warpsph.sampling.lattice import Lattice
from warpsph.sampling.walls import layer_count, sample_wall
from warpsph.scene.schema import Boundary

SPACING = 0.1
SQUARE = {"type": "box", "min": [0.0, 0.0], "max": [1.0, 1.0]}
CUBE = {"type": "box", "min": [0.0, 0.0, 0.0], "max": [1.0, 1.0, 1.0]}


def boundary(shape: dict[str, Any], side: str = "outside", **more: Any) -> Boundary:
    return Boundary.model_validate({"shape": shape, "side": side, **more})


def wall(
    spec: Boundary, dimension: int = 2, period: dict[int, tuple[float, float]] | None = None
) -> np.ndarray:
    lattice = Lattice(SPACING, np.zeros(dimension), np.eye(dimension))
    return sample_wall(spec, lattice, 3, period or {}).position


@pytest.mark.parametrize(("support", "layers"), [(3.0, 3), (2.6, 3), (2.0 * 1.5, 3), (2.0, 2), (4.1, 5)])
def test_automatic_layers_reach_as_far_as_the_support(support: float, layers: int) -> None:
    scene = still_tank(numerics={"h_over_dp": support / 2.0})
    assert layer_count(boundary(SQUARE), scene) == layers
    assert layer_count(boundary(SQUARE, layers=7), scene) == 7


def test_structures_touch_walls_of_one_layer() -> None:
    assert layer_count(boundary(SQUARE), block()) == 1
    assert layer_count(boundary(SQUARE, layers=7), block()) == 7


@pytest.mark.parametrize(
    ("side", "count"), [("outside", 16**2 - 10**2), ("inside", 10**2 - 4**2), ("solid", 10**2)]
)
def test_box_sides(side: str, count: int) -> None:
    positions = wall(boundary(SQUARE, side))
    inside = signed_distance(boundary(SQUARE).shape, positions) < 0.0
    assert len(positions) == count
    assert inside.all() == (side != "outside")
    assert inside.any() == (side != "outside")


def test_box_corners_are_filled_in_three_dimensions() -> None:
    assert len(wall(boundary(CUBE), 3)) == 16**3 - 10**3


@pytest.mark.parametrize("face", ["x_min", "x_max", "y_min", "y_max"])
def test_walls_reach_exactly_up_to_an_open_face(face: str) -> None:
    """The side walls end half a spacing before the open face; nothing lies beyond it."""
    positions = wall(boundary(SQUARE, open=[face]))
    along = positions[:, "xy".index(face[0])]
    end = along.max() if face.endswith("max") else along.min()
    assert len(positions) == 16**2 - 10**2 - 3 * 16
    assert end == pytest.approx(0.95 if face.endswith("max") else 0.05)


def test_an_open_cylinder_has_no_lid() -> None:
    cylinder = {"type": "cylinder", "start": [0.0, 0.0, 0.0], "end": [0.0, 0.0, 1.0], "radius": 0.5}
    closed, opened = (wall(boundary(cylinder, open=faces), 3) for faces in ([], ["z_max"]))
    assert closed[:, 2].max() == pytest.approx(1.25)
    assert opened[:, 2].max() == pytest.approx(0.95)
    assert len(opened) == np.sum(closed[:, 2] < 1.0)


def test_the_open_face_turns_with_the_tank() -> None:
    turned = {"type": "transform", "shape": SQUARE, "rotate": {"angle": 30.0}}
    rotation = np.array([[np.sqrt(0.75), -0.5], [0.5, np.sqrt(0.75)]])
    spec = boundary(turned, open=["y_max"])
    positions = sample_wall(spec, Lattice(SPACING, np.zeros(2), rotation), 3, {}).position
    upright = wall(boundary(SQUARE, open=["y_max"]))
    assert cKDTree(positions).query(upright @ rotation.T)[0].max() < 1e-9
    assert len(positions) == len(upright)


@pytest.mark.parametrize("low", [0.0, -0.5])
def test_a_channel_through_the_whole_period_has_only_side_walls(low: float) -> None:
    """Faces on the periodic bounds, or beyond them, carry no layers; the walls fill one period."""
    channel = boundary({"type": "box", "min": [low, 0.0], "max": [1.0 - low, 0.5]})
    positions = wall(channel, period={0: (0.0, 1.0)})
    assert len(positions) == 2 * 3 * 10
    assert positions[:, 0].min() == pytest.approx(0.05)
    assert positions[:, 0].max() == pytest.approx(0.95)
    assert np.all((positions[:, 1] < 0.0) | (positions[:, 1] > 0.5))


def test_a_hollow_slab_through_the_whole_period_is_hollow_to_its_ends() -> None:
    slab = boundary({"type": "box", "min": [0.0, 0.0], "max": [1.0, 1.0]}, "inside")
    assert len(wall(slab, period={0: (0.0, 1.0)})) == 10 * (3 + 3)


def test_a_round_pipe_along_a_periodic_axis_fits_its_image() -> None:
    pipe = {"type": "cylinder", "start": [0.0, 0.0, 0.0], "end": [1.0, 0.0, 0.0], "radius": 0.5}
    positions = wall(boundary(pipe), 3, period={0: (0.0, 1.0)})
    images = np.concatenate([positions, np.add(positions, [1.0, 0.0, 0.0])])
    assert np.unique(positions[:, 0].round(9)) == pytest.approx(np.arange(10) / 10 + 0.05)
    assert cKDTree(images).query(images, 2)[0][:, 1].min() > 0.9 * SPACING


@pytest.mark.parametrize(("side", "sign"), [("inside", -1.0), ("outside", 1.0)])
@pytest.mark.parametrize("normal", [[0.0, 1.0], [0.0, -1.0], [-0.4, 1.0]])
def test_plane_layers_lie_on_their_side_within_the_bounds(
    side: str, sign: float, normal: list[float]
) -> None:
    bounds = {"min": [0.0, -1.0], "max": [1.0, 1.0]}
    plane = boundary({"type": "plane", "point": [0.0, 0.0], "normal": normal, "bounds": bounds}, side)
    positions = wall(plane)
    distance = signed_distance(plane.shape, positions)
    foot = positions - np.outer(distance, np.array(normal) / np.linalg.norm(normal))
    length = np.hypot(1.0, normal[0] / normal[1])
    assert np.unique((sign * distance / SPACING).round(6)) == pytest.approx([0.5, 1.5, 2.5])
    assert np.all((foot[:, 0] > -1e-9) & (foot[:, 0] < 1.0 + 1e-9))
    assert len(positions) == pytest.approx(3 * length / SPACING, abs=3)


@pytest.mark.parametrize("dimension", [2, 3])
def test_layers_of_a_ball_have_the_density_of_the_lattice(dimension: int) -> None:
    ball = boundary({"type": "sphere", "center": [0.0] * dimension, "radius": 1.0})
    measure = {2: lambda r: np.pi * r**2, 3: lambda r: 4.0 / 3.0 * np.pi * r**3}[dimension]
    shell = measure(1.3) - measure(1.0)
    assert len(wall(ball, dimension)) * SPACING**dimension == pytest.approx(shell, rel=0.02)


def test_a_solid_ball_is_full() -> None:
    ball = boundary({"type": "sphere", "center": [0.0, 0.0, 0.0], "radius": 0.73}, "solid")
    positions = wall(ball, 3)
    inner = np.random.default_rng(1).uniform(-0.73, 0.73, (20000, 3))
    inner = inner[np.linalg.norm(inner, axis=1) < 0.7]
    assert cKDTree(positions).query(inner)[0].max() < 1.1 * SPACING
    assert np.linalg.norm(positions, axis=1).max() <= 0.73 - 0.5 * SPACING + 1e-9


def test_a_polygon_may_be_open_at_the_faces_of_the_box_around_it():
    """A vessel that widens: wall above and below along the oblique sides, none at the ends."""
    corners = [[0.0, 0.4], [1.0, 0.2], [2.0, 0.0], [2.0, 1.2], [0.0, 0.8]]
    vessel = boundary({"type": "polygon", "points": corners}, open=["x_min", "x_max"])
    points = wall(vessel)
    assert points[:, 0].min() > -SPACING / 2
    assert points[:, 0].max() < 2.0 + SPACING / 2
    depth = signed_distance(vessel.shape, points)
    assert depth.min() == pytest.approx(0.5 * SPACING, abs=0.2 * SPACING)
    assert depth.max() < 3.0 * SPACING
