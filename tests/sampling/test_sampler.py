"""Whole scenes: leak-tight, evenly spaced, of the right mass, complete."""

from collections.abc import Callable

import numpy as np
import pytest
from sampling.tank_scenes import TANKS, box, box_tank, box_tank_3d, make_scene, rolled_tank, sloping_bed
from scipy.spatial import cKDTree

from warpsph.sampling import SampledSet, sample, signed_distance
from warpsph.scene.schema import Boundary, Scene

HOLE_OF_LATTICE = {2: np.sqrt(2.0) / 2.0, 3: np.sqrt(3.0) / 2.0}

every_tank = pytest.mark.parametrize("make", TANKS.values(), ids=TANKS)
Make = Callable[[], Scene]


def of_kind(sets: tuple[SampledSet, ...], kind: str) -> np.ndarray:
    return np.concatenate([one.position for one in sets if one.kind == kind])


def behind(boundary: Boundary, points: np.ndarray) -> np.ndarray:
    """Distance of points behind the surface of a wall, negative on the fluid's side."""
    distance = signed_distance(boundary.shape, points)
    return distance if boundary.side == "outside" else -distance


def fine_grid(points: np.ndarray, step: float) -> np.ndarray:
    """A grid of points in the box around the given ones, off the planes where surfaces lie."""
    ends = zip(points.min(axis=0) - 3.0 * step, points.max(axis=0) + 3.0 * step, strict=True)
    axes = [np.arange(low, high, step) + 0.41 * step for low, high in ends]
    return np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, points.shape[1])


@every_tank
def test_no_two_particles_crowd(make: Make) -> None:
    scene = make()
    points = np.concatenate([one.position for one in sample(scene)])
    assert cKDTree(points).query(points, 2)[0][:, 1].min() > 0.69 * scene.spacing


@every_tank
def test_no_wall_particle_is_on_the_fluid_side(make: Make) -> None:
    """Wall particles are behind the surface: half a spacing, or what rounding to the lattice leaves of it."""
    scene = make()
    for one in sample(scene):
        if one.kind == "boundary":
            assert behind(scene.boundaries[one.name], one.position).min() > 0.4 * scene.spacing


@every_tank
def test_walls_close_the_support_of_every_fluid_particle(make: Make) -> None:
    """Wherever a fluid particle's support reaches into a wall, particles are as dense as a lattice there."""
    scene = make()
    sets = sample(scene)
    fluid, particles = of_kind(sets, "fluid"), cKDTree(np.concatenate([one.position for one in sets]))
    near = np.random.default_rng(0).uniform(-1.0, 1.0, (20, scene.dimension)) * scene.support_radius
    probes = (fluid[::3, None, :] + near[None]).reshape(-1, scene.dimension)
    for name, boundary in scene.boundaries.items():
        depth = behind(boundary, probes)
        within = (depth > 0.0) & (depth < scene.support_radius - 0.5 * scene.spacing)
        if boundary.open or name == "floor":
            within &= probes[:, -1] < fluid[:, -1].max() - 0.5 * scene.spacing
        hole = particles.query(probes[within])[0].max()
        assert hole < 1.2 * HOLE_OF_LATTICE[scene.dimension] * scene.spacing, name


@every_tank
def test_fluid_next_to_a_wall_is_about_a_spacing_from_it(make: Make) -> None:
    """Fluid whose cell touches the wall, found by a fine grid of points inside the walls."""
    scene = make()
    sets = sample(scene)
    fluid, walls = of_kind(sets, "fluid"), of_kind(sets, "boundary")
    grid = fine_grid(walls, scene.spacing / 3.0)
    in_walls = grid[cKDTree(walls).query(grid)[0] < 0.7 * scene.spacing]
    in_walls = in_walls[np.any([behind(one, in_walls) > 0.0 for one in scene.boundaries.values()], axis=0)]
    adjacent = fluid[cKDTree(in_walls).query(fluid)[0] < 0.6 * scene.spacing]
    distance = cKDTree(walls).query(adjacent)[0] / scene.spacing
    assert len(adjacent) > 10
    assert distance.min() > 0.69
    assert distance.max() < 1.3


@every_tank
def test_fluid_has_its_volume(make: Make) -> None:
    """Each surface cell counts or not by its centre: the error is far below a layer of half cells."""
    scene = make()
    (water,) = (one for one in sample(scene) if one.kind == "fluid")
    shape = scene.fluids["water"].shape
    fine = fine_grid(water.position, scene.spacing / 3.0)
    volume = np.sum(signed_distance(shape, fine) < 0.0) * (scene.spacing / 3.0) ** scene.dimension
    assert len(water.position) * water.volume == pytest.approx(volume, rel=0.04)


def test_sets_come_in_the_order_of_the_scene_fluids_first() -> None:
    scene = make_scene(
        0.1,
        {"oil": box([0.0, 0.0], [0.5, 0.5]), "air": box([0.5, 0.0], [1.0, 0.5])},
        {
            "tank": {"shape": box([0.0, 0.0], [2.0, 1.0]), "side": "outside"},
            "block": {"shape": box([1.5, 0.0], [1.8, 0.3]), "side": "solid"},
        },
        dimension=2,
    )
    sets = sample(scene)
    assert [(one.name, one.kind) for one in sets] == [
        ("oil", "fluid"),
        ("air", "fluid"),
        ("tank", "boundary"),
        ("block", "boundary"),
    ]
    for one in sets:
        assert one.position.shape == one.velocity.shape == (len(one.pressure), 2)
        assert one.position.dtype == one.velocity.dtype == one.pressure.dtype == np.float64
        assert one.volume == pytest.approx(0.01)


@pytest.mark.parametrize("spacing", [0.03, 0.035, 0.04, 0.07])
def test_lengths_off_the_lattice_leave_neither_gap_nor_overlap(spacing: float) -> None:
    """Fluid, tank and a second fluid above round their common faces alike."""
    scene = make_scene(
        spacing,
        {"lower": box([0.0, 0.0], [1.0, 0.5]), "upper": box([0.0, 0.5], [1.0, 0.8])},
        {"tank": {"shape": box([0.0, 0.0], [1.0, 1.0]), "side": "outside", "open": ["y_max"]}},
        dimension=2,
    )
    sets = sample(scene)
    points = np.concatenate([one.position for one in sets])
    neighbours = cKDTree(points).query(of_kind(sets, "fluid"), 4)[0]
    below_surface = of_kind(sets, "fluid")[:, 1] < 0.8 - 2.0 * spacing
    assert neighbours[:, 1].min() == pytest.approx(spacing)
    assert neighbours[below_surface, 3].max() == pytest.approx(spacing)


def test_fluid_and_walls_fill_exactly_one_period() -> None:
    scene = make_scene(
        0.1,
        {"water": box([0.0, 0.0], [2.0, 0.5])},
        {"channel": {"shape": box([0.0, 0.0], [2.0, 0.5]), "side": "outside"}},
        dimension=2,
        domain={"periodic": {"x": [0.0, 2.0]}},
    )
    points = np.concatenate([one.position for one in sample(scene)])
    assert len(points) == 20 * (5 + 6)
    images = np.concatenate([np.add(points, [shift, 0.0]) for shift in (-2.0, 0.0, 2.0)])
    assert cKDTree(images).query(points, 2)[0][:, 1] == pytest.approx(0.1)


def test_fluid_in_a_turned_tank_shares_its_lattice() -> None:
    scene = rolled_tank()
    filled = scene.model_copy(
        update={
            "fluids": {
                "water": scene.fluids["water"].model_copy(update={"shape": scene.boundaries["tank"].shape})
            }
        }
    )
    sets = sample(filled)
    points = np.concatenate([one.position for one in sets])
    assert cKDTree(points).query(of_kind(sets, "fluid"), 5)[0][:, 4] == pytest.approx(scene.spacing)


def test_walls_that_overlap_at_rest_are_thinned_and_those_that_part_are_not() -> None:
    def block(**more: object) -> int:
        boundaries = {
            "tank": {"shape": box([0.0, 0.0], [1.0, 1.0]), "side": "outside"},
            "block": {"shape": box([0.2, -0.2], [0.4, 0.2]), "side": "solid", **more},
        }
        sets = sample(make_scene(0.1, {"water": box([0.5, 0.0], [1.0, 0.5])}, boundaries, dimension=2))
        return len(sets[-1].position)

    assert block() == 4
    assert block(motion=[{"type": "linear", "velocity": [0.0, 1.0]}]) == 8


def test_moving_walls_have_their_velocity_at_once() -> None:
    scene = make_scene(
        0.1,
        {"water": box([0.0, 0.0], [1.0, 0.5])},
        {
            "paddle": {
                "shape": box([-0.3, 0.0], [0.0, 1.0]),
                "side": "solid",
                "motion": [{"type": "rotation", "rate": 90.0, "center": [0.0, 0.0]}],
            }
        },
        dimension=2,
    )
    paddle = sample(scene)[-1]
    x, y = paddle.position.T
    assert paddle.velocity == pytest.approx(0.5 * np.pi * np.stack([-y, x], axis=1))


@pytest.mark.parametrize("make", [box_tank, box_tank_3d, sloping_bed])
def test_pressure_of_still_water_balances_gravity(make: Make) -> None:
    water = sample(make())[0]
    surface = {"box_tank": 1.0, "box_tank_3d": 0.5, "sloping_bed": 0.9}[make.__name__]
    assert water.pressure == pytest.approx(1000.0 * 9.81 * (surface - water.position[:, -1]), abs=1e-6)
