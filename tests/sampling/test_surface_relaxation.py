"""Relaxed particles: even along surfaces, half a spacing off them, and on the lattice where that fits already."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import pytest
from pydantic import TypeAdapter
from sampling.tank_scenes import box, make_scene, sphere, turned, without
from scipy.spatial import cKDTree

from warpsph.sampling import sample
from warpsph.sampling.distance import signed_distance
from warpsph.sampling.lattice import Lattice, cells_inside
from warpsph.sampling.sets import Placed
from warpsph.sampling.surface_relaxation import relaxed
from warpsph.scene.bounds import dimension_of
from warpsph.scene.shapes import Shape

Spec = dict[str, Any]

CURVED = {
    "disc": (sphere([0.003, 0.001], 0.5), 0.025),
    "oblique box": (turned(box([0.0, 0.0], [1.0, 1.0]), 30.0), 0.05),
    "ball": (sphere([0.003, 0.001, 0.002], 0.5), 0.0625),
    "section in a box": (
        without(box([-1.0, -1.0], [1.0, 1.0]), {"type": "naca", "digits": "2412", "chord": 1.0}),
        0.025,
    ),
}


def before_and_after(spec: Spec, spacing: float) -> tuple[Shape, np.ndarray, Placed]:
    """The shape, its particles on the lattice, and the same relaxed."""
    shape: Shape = TypeAdapter(Shape).validate_python(spec)
    dimension = dimension_of(shape)
    lattice = Lattice(spacing, np.zeros(dimension), np.eye(dimension))
    points = cells_inside(lattice, shape).positions()
    return shape, points, relaxed(points, partial(signed_distance, shape), lattice)


def closest(points: np.ndarray, spacing: float) -> float:
    return float(cKDTree(points).query(points, k=2)[0][:, 1].min() / spacing)


@pytest.mark.parametrize("name", CURVED)
def test_particles_near_a_surface_become_even(name: str) -> None:
    """Where a surface cuts the lattice at random, the depths of the first layer deviate by 1 / sqrt(12) = 0.29."""
    spec, spacing = CURVED[name]
    shape, lattice, placed = before_and_after(spec, spacing)
    assert placed.evenness is not None
    before, after = (-signed_distance(shape, points) / spacing for points in (lattice, placed.position))
    assert np.std(after[after < 1.0]) == pytest.approx(placed.evenness.spread, abs=1e-9)
    assert placed.evenness.spread < 0.45 * np.std(before[before < 1.0])
    assert placed.evenness.unevenness < 0.035
    assert placed.evenness.closest > 0.65
    assert closest(placed.position, spacing) > placed.evenness.closest - 1e-9


@pytest.mark.parametrize("name", CURVED)
def test_first_layer_is_half_a_spacing_off_the_surface(name: str) -> None:
    spec, spacing = CURVED[name]
    shape, _, placed = before_and_after(spec, spacing)
    depth = -signed_distance(shape, placed.position) / spacing
    assert depth.min() > 0.5 - 0.13  # what counts as off the surface, see `pushed_inside`
    first = depth[depth < 1.0]
    assert np.mean(first) == pytest.approx(0.5, abs=0.05)


def test_deep_inside_particles_stay() -> None:
    shape, lattice, placed = before_and_after(*CURVED["disc"])
    deep = signed_distance(shape, lattice) < -4.0 * 0.025 - 1e-9
    assert deep.any()
    assert placed.position[deep] == pytest.approx(lattice[deep], abs=1e-15)


def test_lattice_along_its_faces_stays() -> None:
    _, lattice, placed = before_and_after(box([0.0, 0.0], [1.0, 1.0]), 0.05)
    assert placed.position == pytest.approx(lattice, abs=1e-6)


def test_narrow_tip_keeps_its_particles_apart() -> None:
    """Only one of them has room half a spacing off both surfaces."""
    shape, lattice, placed = before_and_after({"type": "naca", "digits": "0012", "chord": 1.0}, 0.01)
    assert len(placed.position) == len(lattice)
    assert np.all(signed_distance(shape, placed.position) < 0.0)
    assert closest(placed.position, 0.01) > 0.5


@pytest.mark.parametrize("side", ["inside", "solid"])
def test_fluid_and_wall_meet_evenly_at_a_relaxed_surface(side: str) -> None:
    """Both keep half a spacing to the surface, so that no two are much nearer than a spacing."""
    ball = sphere([0.5, 0.5], 0.2)
    wall = {"shape": ball, "side": side, "placement": "relaxed"}
    scene = make_scene(
        0.02, {"water": without(box([0.0, 0.0], [1.0, 1.0]), ball)}, {"wall": wall}, dimension=2
    )
    fluid = scene.fluids["water"].model_copy(update={"placement": "relaxed"})
    water, obstacle = sample(scene.model_copy(update={"fluids": {"water": fluid}}))
    nearest, _ = cKDTree(obstacle.position).query(water.position)
    assert 0.9 < nearest.min() / 0.02 < 1.1
    radius = np.linalg.norm(obstacle.position - 0.5, axis=1)
    assert radius.max() == pytest.approx(0.2 - 0.01, abs=1e-3)


def tank_round_a_disc(placement: str) -> np.ndarray:
    """Four layers of walls round a disc of radius 0.5."""
    tank = {"shape": sphere([0.0, 0.0], 0.5), "side": "outside", "layers": 4, "placement": placement}
    _, wall = sample(make_scene(0.02, {"water": sphere([0.0, 0.0], 0.5)}, {"tank": tank}, dimension=2))
    return wall.position


def test_relaxed_wall_has_the_thickness_and_the_volume_of_its_layers() -> None:
    wall = tank_round_a_disc("relaxed")
    radius = np.linalg.norm(wall, axis=1)
    assert (radius.min(), radius.max()) == (pytest.approx(0.51, abs=1e-3), pytest.approx(0.57, abs=1e-3))
    assert len(wall) * 0.02**2 == pytest.approx(np.pi * (0.58**2 - 0.5**2), rel=0.02)


def test_wall_on_the_lattice_has_whole_cells_between_its_particles() -> None:
    wall = tank_round_a_disc("lattice")
    cells = (wall - wall[0]) / 0.02
    assert cells == pytest.approx(np.round(cells), abs=1e-9)
    assert np.linalg.norm(wall, axis=1).min() > 0.5


def test_relaxed_wall_ends_at_the_period() -> None:
    tank = {"shape": box([0.0, 0.0], [1.0, 0.5]), "side": "outside", "placement": "relaxed"}
    bump = {"shape": sphere([0.5, 0.0], 0.1), "side": "inside", "placement": "relaxed"}
    periodic = {"domain": {"periodic": {"x": [0.0, 1.0]}}}
    fluid = without(box([0.0, 0.0], [1.0, 0.5]), sphere([0.5, 0.0], 0.1))
    sets = sample(make_scene(0.02, {"water": fluid}, {"tank": tank, "bump": bump}, dimension=2, **periodic))
    points = np.concatenate([particles.position for particles in sets])
    across = np.concatenate([points, points + np.array([1.0, 0.0])])
    assert points[:, 0].min() >= 0.0
    assert points[:, 0].max() < 1.0
    seam = np.abs(across[:, 0] - 1.0) < 0.05
    assert cKDTree(across[seam]).query(across[seam], k=2)[0][:, 1].min() > 0.9 * 0.02
