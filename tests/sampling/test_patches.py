"""Patches: stations and their areas, the particles of buffers, and what is prescribed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from open_boundary_builders import DP, channel, pipe

from warpsph.sampling import sample
from warpsph.sampling.patch_laws import PatchLaw, expected_inflow, patch_laws
from warpsph.sampling.patches import patches_of
from warpsph.scene import Scene


def law(
    velocity: dict[str, Any], scene: Scene | None = None, directory: Path = Path(), **keys: Any
) -> PatchLaw:
    """The law of the inlet of a channel with a velocity prescribed."""
    base = scene or channel()
    data = base.model_dump()
    data["open_boundaries"]["inlet"] |= {"velocity": velocity, **keys}
    changed = Scene.model_validate(data).read_from(directory)
    return patch_laws(changed)[0]


@pytest.mark.parametrize("is_round", [False, True])
def test_the_stations_of_a_patch_share_its_area(is_round: bool) -> None:
    patch = patches_of(pipe(is_round=is_round))[0]
    area = np.pi * 0.4**2 if is_round else 0.8**2
    assert patch.weights.sum() == pytest.approx(area)
    assert np.all(patch.weights >= 0.0)


def test_velocities_turn_with_the_patch() -> None:
    values = law({"type": "uniform", "speed": 1.0}, channel(angle=30.0))(0.0)
    assert values[:, :2] == pytest.approx(np.tile([np.cos(np.pi / 6), 0.5], (10, 1)))


def test_a_ramp_multiplies_a_history() -> None:
    """10 s^3 - 15 s^4 + 6 s^5 is one half in the middle."""
    driven = law({"type": "uniform", "speed": 2.0}, history="1 + t", ramp=1.0)
    assert driven(0.0)[0, 0] == 0.0
    assert driven(0.5)[0, 0] == pytest.approx(2.0 * 1.5 * 0.5)
    assert driven(3.0)[0, 0] == pytest.approx(2.0 * 4.0)


def test_a_cycle_from_a_file_repeats(tmp_path: Path) -> None:
    (tmp_path / "cycle.csv").write_text("time,value\n0,1\n0.5,3\n1,1\n")
    once = law({"type": "uniform", "speed": 1.0}, None, tmp_path, history={"file": "cycle.csv"})
    again = law(
        {"type": "uniform", "speed": 1.0}, None, tmp_path, history={"file": "cycle.csv", "repeat": True}
    )
    assert once(2.25)[0, 0] == pytest.approx(1.0)
    assert again(2.25)[0, 0] == pytest.approx(2.0)


def test_a_profile_from_a_file_is_interpolated(tmp_path: Path) -> None:
    (tmp_path / "profile.csv").write_text("x,y,speed\n0,0,0\n0,1,2\n")
    values = law({"type": "table", "file": "profile.csv"}, None, tmp_path)(0.0)
    scene = channel()
    y = patches_of(scene)[0].points(patches_of(scene)[0].stations)[:, 1]
    assert values[:, 0] == pytest.approx(2.0 * y)


def test_the_expected_speed_knows_the_peak_of_a_history() -> None:
    data = channel().model_dump()
    data["open_boundaries"]["inlet"]["history"] = "3*sin(2*pi*t)"
    assert expected_inflow(Scene.model_validate(data)) == pytest.approx(3.0, rel=0.01)


@pytest.mark.parametrize("angle", [0.0, 30.0])
def test_a_buffer_continues_the_lattice_of_its_fluid(angle: float) -> None:
    scene = channel(angle=angle)
    points = next(s for s in sample(scene) if s.kind == "fluid").position
    for patch in patches_of(scene):
        behind = points[patch.behind(points, 0.0)]
        assert len(behind) == 10 * round(patch.length / DP)
    lattice = np.linalg.norm(points[:, None] - points[None], axis=2)
    np.fill_diagonal(lattice, np.inf)
    assert lattice.min() == pytest.approx(DP)
    assert np.sum(lattice < 1.01 * DP, axis=1).min() >= 2


@pytest.mark.parametrize("depth", [0.1, 0.25])
def test_shares_inside_of_a_patch_rise_by_the_hat_of_the_flux(depth: float) -> None:
    """Nought and one at its ends, one half on the patch, and a slope of (1 - |d| / D) / D between; one beside it, and
    nought in the buffer however far behind."""
    patch = patches_of(channel())[0]
    d = np.linspace(-1.2 * depth, 1.2 * depth, 2401)
    points = np.column_stack([d, np.full_like(d, 0.5)])
    share = patch.share_inside(points, np.zeros(len(d), dtype=bool), depth, 0.0)
    hat = np.clip(1.0 - np.abs(d) / depth, 0.0, None) / depth
    assert np.gradient(share, d) == pytest.approx(hat, abs=2e-3 / depth)
    assert share[[0, 1200, -1]] == pytest.approx([0.0, 0.5, 1.0])
    beside, far = np.array([[0.0, 1.3]]), np.array([[-patch.length - 0.01, 0.5]])
    outside, inside = np.array([False]), np.array([True])
    assert patch.share_inside(beside, outside, depth, 0.05) == 1.0
    assert patch.share_inside(far, outside, depth, 0.05) == 1.0
    assert patch.share_inside(far, inside, depth, 0.05) == 0.0
