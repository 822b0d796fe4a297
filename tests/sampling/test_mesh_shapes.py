"""Particles of meshes and of sections from files and formulas."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import mesh_builders as build
import numpy as np
import pytest
import trimesh
from scipy.spatial import cKDTree

from warpsph.sampling import sample
from warpsph.sampling.sets import SampledSet
from warpsph.scene.errors import SceneError
from warpsph.scene.schema import Scene

Spec = dict[str, Any]


@pytest.fixture
def files(tmp_path: Path) -> dict[str, str]:
    """Meshes of a ball and a box of size one about the origin, by name."""
    bodies = {"ball": build.ball(0.5), "box": build.box((-0.5,) * 3, (0.5,) * 3)}
    for name, triangles in bodies.items():
        trimesh.Trimesh(*triangles).export(tmp_path / f"{name}.stl")
    return {name: str(tmp_path / f"{name}.stl") for name in bodies}


def sampled(spacing: float, dimension: int = 3, **sections: Spec) -> dict[str, SampledSet]:
    base = {"name": "t", "dimension": dimension, "spacing": spacing, "time": {"end": 1.0, "frame_rate": 1.0}}
    return {particles.name: particles for particles in sample(Scene.model_validate(base | sections))}


def water(shape: Spec) -> Spec:
    return {"water": {"shape": shape, "density": 1000.0}}


@pytest.mark.parametrize(("spacing", "error"), [(0.1, 0.06), (0.05, 0.01), (0.025, 0.002)])
def test_volume_of_a_ball_from_a_mesh(files: dict[str, str], spacing: float, error: float) -> None:
    """Cells cut by the surface count by their centres, so that most errors cancel: 5.4 %, 0.84 % and 0.12 % of pi / 6
    too much, as for a sphere in closed form."""
    particles = sampled(spacing, fluids=water({"type": "mesh", "file": files["ball"]}))["water"]
    assert len(particles.position) * particles.volume == pytest.approx(np.pi / 6.0, rel=error)


def test_box_from_a_mesh_has_the_particles_of_a_box(files: dict[str, str]) -> None:
    """Its faces lie half a cell off the lattice points, or on them: both count alike."""
    for spacing in (0.05, 1.0 / 9.5):
        box = {"type": "box", "min": [-0.5] * 3, "max": [0.5] * 3}
        mesh = {"type": "mesh", "file": files["box"]}
        expected, found = (sampled(spacing, fluids=water(shape))["water"].position for shape in (box, mesh))
        assert found == pytest.approx(expected, abs=1e-12)


def test_transforms_and_differences_of_meshes(files: dict[str, str]) -> None:
    """A box of 0.5 m, turned, with a ball of 0.25 m cut out: 0.125 - pi / 384 m3."""
    shape = {
        "type": "difference",
        "base": {
            "type": "transform",
            "scale": 0.5,
            "rotate": {"angle": 30.0, "axis": [1.0, 1.0, 0.0]},
            "shape": {"type": "mesh", "file": files["box"]},
        },
        "subtract": [{"type": "mesh", "file": files["ball"], "unit": 0.25}],
    }
    particles = sampled(0.0125, fluids=water(shape))["water"]
    assert len(particles.position) * particles.volume == pytest.approx(0.125 - np.pi / 384.0, rel=0.01)


@pytest.mark.parametrize("side", ["outside", "inside", "solid"])
def test_walls_of_meshes_continue_the_lattice(files: dict[str, str], side: str) -> None:
    """No two particles of fluid and wall come nearer than a cell, and no cell at the surface stays empty."""
    ball = {"type": "mesh", "file": files["ball"]}
    around = {"type": "box", "min": [-0.8] * 3, "max": [0.8] * 3}
    fluid = ball if side == "outside" else {"type": "difference", "base": around, "subtract": [ball]}
    wall = {"shape": ball, "side": side}
    sets = sampled(0.05, fluids=water(fluid), boundaries={"wall": wall})
    points = np.concatenate([particles.position for particles in sets.values()])
    distance = cKDTree(points).query(points, k=2)[0][:, 1]
    assert distance == pytest.approx(np.full(len(points), 0.05), abs=1e-9)
    close = sets["water"].position[np.abs(np.linalg.norm(sets["water"].position, axis=1) - 0.5) < 0.05]
    assert np.all(cKDTree(points).query_ball_point(close, 0.051, return_length=True) == 7)


def test_open_faces_of_a_tank_from_a_mesh_are_those_of_its_box(files: dict[str, str]) -> None:
    box = {"type": "box", "min": [-0.5] * 3, "max": [0.5] * 3}
    tanks = [
        sampled(
            0.1,
            fluids=water(box),
            boundaries={"tank": {"shape": shape, "side": "outside", "open": ["z_max"]}},
        )
        for shape in (box, {"type": "mesh", "file": files["box"]})
    ]
    expected, found = (sets["tank"].position for sets in tanks)
    assert expected[:, 2].max() < 0.5
    assert found == pytest.approx(expected, abs=1e-12)


def test_relaxed_particles_of_a_mesh(files: dict[str, str]) -> None:
    ball = {"type": "mesh", "file": files["ball"]}
    body = water(ball)
    body["water"]["placement"] = "relaxed"
    tank = {"shape": ball, "side": "outside", "layers": 2, "placement": "relaxed"}
    sets = sampled(0.1, fluids=body, boundaries={"tank": tank})
    for name, low, high in (("water", 0.0, 0.46), ("tank", 0.54, 0.66)):
        radius = np.linalg.norm(sets[name].position, axis=1)
        assert low <= radius.min()
        assert radius.max() <= high
        assert sets[name].evenness is not None
        assert sets[name].evenness.unevenness < 0.06


def test_wall_of_a_mesh_in_the_wrong_unit_is_refused(files: dict[str, str]) -> None:
    wall = {"shape": {"type": "mesh", "file": files["box"], "unit": 1000.0}, "side": "outside"}
    fluid = water({"type": "box", "min": [-0.5] * 3, "max": [0.5] * 3})
    with pytest.raises(SceneError, match="1000 x 1000 x 1000 m, has 1e\\+12 cells") as refused:
        sampled(0.1, fluids=fluid, boundaries={"wall": wall})
    assert "another unit of its file" in str(refused.value)


def test_structure_from_a_mesh(files: dict[str, str]) -> None:
    steel = {"density": 7800.0, "youngs_modulus": 2e11, "poisson_ratio": 0.3}
    body = {"shape": {"type": "mesh", "file": files["ball"]}, "material": steel}
    sphere = {"shape": {"type": "sphere", "center": [0.0] * 3, "radius": 0.5}, "material": steel}
    counts = [len(sampled(0.1, structures={"body": spec})["body"].position) for spec in (body, sphere)]
    assert counts[0] == counts[1]


def test_section_in_a_stream_has_layers_that_follow_it() -> None:
    section = {"type": "naca", "digits": "0012", "chord": 1.0, "position": [0.25, 0.0]}
    around = {"type": "box", "min": [-0.5, -0.5], "max": [1.5, 0.5]}
    shape = {"type": "difference", "base": around, "subtract": [section]}
    wall = {"shape": section, "side": "solid"}
    sets = sampled(0.01, 2, fluids=water(shape), boundaries={"foil": wall})
    area = len(sets["foil"].position) * sets["foil"].volume
    assert area == pytest.approx(0.6809 * 0.12, rel=0.03)
    assert cKDTree(sets["water"].position).query(sets["foil"].position)[0].min() > 0.6 * 0.01
