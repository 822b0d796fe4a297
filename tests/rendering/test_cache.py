"""Frames read back from a USD stage."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from pxr import Usd, UsdGeom

from warpsph.rendering.cache import ParticleCache
from warpsph.rendering.errors import RenderError


@pytest.mark.parametrize("dimension", [2, 3])
def test_frames_come_back_with_kinds_times_and_places(write_run: Callable[..., Path], dimension: int) -> None:
    cache = ParticleCache(write_run(dimension))
    assert (len(cache.codes), cache.frame_rate, cache.is_plane) == (3, 10.0, dimension == 2)
    assert cache.up_axis == dimension - 1
    frame = cache.frame(2, "velocity")
    assert frame.time == pytest.approx(0.2)
    (water,), (tank,) = frame.of_kind("fluid"), frame.of_kind("boundary")
    assert (water.name, tank.name) == ("water", "tank")
    assert water.diameter == pytest.approx(0.1)
    np.testing.assert_allclose(water.position[:, 0].min(), 0.25, rtol=1e-6)
    np.testing.assert_allclose(water.value, 1.0)


def test_frames_of_a_run_that_was_killed_can_be_read(write_run: Callable[..., Path]) -> None:
    cache = ParticleCache(write_run(3, finish=False))
    assert len(cache.codes) == 3
    positions = [cache.frame(index, "velocity").of_kind("fluid")[0].position for index in range(3)]
    assert [position[:, 0].min() for position in positions] == pytest.approx([0.05, 0.15, 0.25])


def test_scalar_field_comes_back_with_its_unit(write_run: Callable[..., Path]) -> None:
    cache = ParticleCache(write_run(2))
    assert {"velocity", "density", "pressure"} <= set(cache.fields)
    assert cache.unit("pressure") == "Pa"
    (water,) = cache.frame(0, "pressure").of_kind("fluid")
    assert water.value is not None
    np.testing.assert_allclose(water.value, 1000.0 * water.position[:, 0], rtol=1e-6)


def test_particles_that_are_nowhere_are_left_out(write_run: Callable[..., Path]) -> None:
    path = write_run(2) / "particles.usdc"
    stage = Usd.Stage.Open(str(path))
    points = UsdGeom.Points(stage.GetPrimAtPath("/block/water")).GetPointsAttr()
    positions = np.array(points.Get(0.0))
    positions[3] = np.nan
    points.Set(positions, 0.0)
    stage.Save()
    (water,) = ParticleCache(path).frame(0, "velocity").of_kind("fluid")
    assert len(water.position) == len(positions) - 1


def test_directory_without_a_stage_is_named(tmp_path: Path) -> None:
    with pytest.raises(RenderError, match=r"particles\.usdc: there is no such file"):
        ParticleCache(tmp_path)


def test_file_that_is_no_stage_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "frames.usda"
    path.write_text("these are no frames")
    with pytest.raises(RenderError, match="no USD stage that can be read"):
        ParticleCache(path)


def test_stage_without_particles_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "empty.usda"
    Usd.Stage.CreateNew(str(path)).Save()
    with pytest.raises(RenderError, match="no frames of particles"):
        ParticleCache(path)
