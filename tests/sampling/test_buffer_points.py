"""Buffers: even layers, rings behind discs, and columns that bring in the flow rate that is asked for."""

from __future__ import annotations

import numpy as np
import pytest
from open_boundary_builders import DP, channel, pipe
from scipy.spatial import cKDTree

from warpsph.sampling.buffer_points import buffer_of, columns_of
from warpsph.sampling.buffers import inflow_warnings
from warpsph.sampling.patch_laws import patch_laws
from warpsph.sampling.patches import patches_of
from warpsph.scene import Scene


def relaxed_pipe(spacing: float = DP) -> Scene:
    data = pipe(is_round=True, spacing=spacing).model_dump()
    data["fluids"]["water"]["placement"] = "relaxed"
    return Scene.model_validate(data)


def with_parabola(scene: Scene, **velocity: float) -> Scene:
    data = scene.model_dump()
    data["open_boundaries"]["inlet"]["velocity"] = {"type": "parabolic", **velocity}
    return Scene.model_validate(data)


@pytest.mark.parametrize("spacing", [0.1, 0.08, 0.05])
def test_rings_share_a_disc_evenly(spacing: float) -> None:
    """Every particle has its volume to half a particle a ring, none is closer to another than 0.7 spacings, and the
    outermost stand half a ring's width from the wall."""
    scene = relaxed_pipe(spacing)
    patch = patches_of(scene)[0]
    points = buffer_of(scene, patch)
    layers = round(patch.length / spacing)
    assert len(points) % layers == 0
    assert len(points) / layers == pytest.approx(np.pi * 0.4**2 / spacing**2, abs=0.5)
    assert patch.behind(points, 0.0).all()
    assert cKDTree(points).query(points, k=2)[0][:, 1].min() > 0.7 * spacing
    radius = np.linalg.norm(patch.coordinates(points)[:, 1:], axis=1)
    assert 0.4 - radius.max() == pytest.approx(0.5 * spacing, rel=0.1)


def test_a_disc_of_fluid_on_a_lattice_is_continued_by_it() -> None:
    scene = pipe(is_round=True)
    across = columns_of(scene, patches_of(scene)[0])
    assert np.abs(across / DP - np.round(across / DP - 0.5) - 0.5).max() < 1e-6


CHANNELS = {
    "segment": (lambda: channel(spacing=0.1), 1.0),
    "segment in few spacings": (lambda: channel(spacing=0.25), 1.0),
    "segment that is turned": (lambda: channel(angle=30.0), 1.0),
    "rectangle": (pipe, 0.8**2),
    "disc on a lattice": (lambda: pipe(is_round=True), np.pi * 0.4**2),
    "disc on rings": (relaxed_pipe, np.pi * 0.4**2),
}


@pytest.mark.parametrize("case", CHANNELS)
@pytest.mark.parametrize("key", ["mean", "flow_rate"])
def test_the_columns_of_a_buffer_bring_in_the_flow_rate_of_a_parabola(case: str, key: str) -> None:
    """Each column stands for dp^(d-1). What the columns of a segment carry is summed here by hand; between stations
    speeds are taken linearly, so that on a disc the parabola itself is met to a few per cent only."""
    make, area = CHANNELS[case]
    asked = 2.0 if key == "mean" else 2.0 * area
    scene = with_parabola(make(), **{key: asked})
    patch, law = patches_of(scene)[0], patch_laws(scene)[0]
    speed = law(0.0)[:, :-1] @ patch.axes[:, 0]
    columns = columns_of(scene, patch)
    part = columns / patch.half
    exact = (
        4.0 * (1.0 - np.sum(part**2, axis=1))
        if patch.is_disc
        else 2.0 * np.prod(1.5 * (1.0 - part**2), axis=1)
    )
    carried = float(exact.sum()) * scene.spacing ** (scene.dimension - 1)
    if patch.is_disc:
        assert speed.max() == pytest.approx(4.0 * 2.0 * area / carried, rel=0.06)
    else:
        assert np.allclose(np.sort(patch.stations, axis=0), np.sort(columns, axis=0))
        assert float(speed.sum()) * scene.spacing ** (scene.dimension - 1) == pytest.approx(2.0 * area)
        assert speed.max() == pytest.approx(exact.max() * 2.0 * area / carried)


def test_the_speed_of_a_parabola_is_that_of_its_mean_within_the_error_of_the_middle_rule() -> None:
    """Over n columns the middle rule brings 1 / (2 n^2) too much, which is taken away."""
    scene = with_parabola(channel(), mean=1.0)
    speed = patch_laws(scene)[0](0.0)[:, 0]
    y = (np.arange(10) + 0.5) / 10
    assert speed == pytest.approx(6.0 * y * (1.0 - y) / (1.0 + 1.0 / 200.0))


def test_a_spacing_that_does_not_divide_an_inlet_is_warned_of() -> None:
    """Seven columns of 0.15 m stand for 1.05 of 1 m; ten of 0.1 m for all; a parabola is scaled."""
    (warning,) = inflow_warnings(channel(spacing=0.15))
    assert "open_boundaries.inlet" in warning
    assert "105.0%" in warning
    assert "0.1429 m" in warning
    assert inflow_warnings(channel()) == []
    assert inflow_warnings(with_parabola(channel(spacing=0.15), mean=1.0)) == []
    (warning,) = inflow_warnings(pipe(is_round=True))
    assert "placement: relaxed" in warning
    assert inflow_warnings(relaxed_pipe()) == []
