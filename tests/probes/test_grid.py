"""Fields on a grid are those of point probes, and averages over time those of statistics."""

import numpy as np
import pytest
from particles import SPACING, fluid, frame_of, lattice, probe_of, scene_with, tank_walls, wall

from warpsph.probes.flow_statistics import FlowStatistics
from warpsph.probes.grid import Grid, GridInterpolation
from warpsph.scene.recordings import FlowStatistics as Spec

SCENE = scene_with({"type": "energy"})


def disordered(velocity=None, pressure=None):
    """Water that is not on a lattice, in a corner of the tank."""
    position = lattice([0.0, 0.0], [1.0, 1.0])
    position = position + 0.1 * SPACING * np.random.default_rng(0).normal(size=position.shape)
    fields = {}
    if velocity is not None:
        fields["velocity"] = velocity(position)
    if pressure is not None:
        fields["pressure"] = pressure(position)
    return frame_of(fluid(position, **fields), wall(tank_walls([0.0, 0.0], [4.0, 2.0])))


def test_every_point_of_the_grid_has_what_a_point_probe_says():
    frame = disordered(lambda x: np.sin(5.0 * x), lambda x: x[:, 0] ** 2)
    grid = Grid.between([-0.1, -0.1], [1.2, 1.2], 0.13)
    values = GridInterpolation(grid, SCENE).evaluate(frame, ("velocity", "pressure"))
    points = np.stack(np.meshgrid(*grid.axes(), indexing="ij"), axis=-1).reshape(-1, 2)
    expected = [
        probe_of(
            scene_with({"type": "point", "at": list(map(float, x)), "fields": ["velocity", "pressure"]})
        ).evaluate(frame)
        for x in points
    ]
    np.testing.assert_allclose(values, expected, rtol=1e-6, atol=1e-9)
    assert 0 < np.isfinite(values).all(axis=1).sum() < len(values)


def test_periodic_axis_is_closed():
    scene = scene_with({"type": "energy"}, domain={"periodic": {"x": [0.0, 1.2]}}, boundaries={})
    frame = frame_of(fluid(lattice([0.0, 0.0], [1.2, 1.0]), velocity=np.ones((120, 2))))
    grid = Grid.between([0.0, 0.5], [1.2, 0.5], 0.3)
    values = GridInterpolation(grid, scene).evaluate(frame, ("velocity",))
    np.testing.assert_allclose(values, 1.0, rtol=1e-12)


def test_averages_and_stresses_of_an_oscillation():
    """v = (1 + a_k, -a_k / 2) and p = 3 a_k with a_k = sin: means (1, 0, 0), covariances those of the samples."""
    statistics = FlowStatistics(Spec(min=(0.4, 0.4), max=(0.6, 0.5), spacing=0.1, start=0.35), SCENE)
    swing = np.sin(np.arange(10))
    for k, a in enumerate(swing):
        velocity = [1.0 + a, -0.5 * a]
        frame = disordered(
            lambda x, v=velocity: np.tile(v, (len(x), 1)), lambda x, p=3.0 * a: np.full(len(x), p)
        )
        object.__setattr__(frame, "time", 0.1 * k)
        statistics.note(frame)
    counted = swing[4:]
    fields = statistics.fields()
    assert fields["samples"].shape == (3, 2)
    assert (fields["samples"] == 6).all()
    assert statistics.times == pytest.approx((0.4, 0.9))
    np.testing.assert_allclose(
        fields["velocity"][1, 1], [1.0 + counted.mean(), -0.5 * counted.mean()], rtol=1e-6
    )
    np.testing.assert_allclose(fields["velocity_covariance"][..., 0, 1], -0.5 * counted.var(), rtol=1e-6)
    np.testing.assert_allclose(fields["pressure_variance"], 9.0 * counted.var(), rtol=1e-6)


def test_statistics_go_on_from_what_was_saved():
    spec = Spec(min=(0.4, 0.4), max=(0.6, 0.5))
    whole, first, second = (FlowStatistics(spec, SCENE) for _ in range(3))
    frames = [disordered(lambda x, k=k: k * x) for k in range(4)]
    for frame in frames:
        whole.note(frame)
    for frame in frames[:2]:
        first.note(frame)
    second.load(first.save())
    for frame in frames[2:]:
        second.note(frame)
    for name, values in whole.fields().items():
        np.testing.assert_array_equal(second.fields()[name], values)


def test_a_point_in_the_air_has_no_average():
    statistics = FlowStatistics(Spec(min=(0.5, 1.5), max=(0.5, 1.5)), SCENE)
    statistics.note(disordered())
    assert np.isnan(statistics.fields()["velocity"]).all()
    assert statistics.fields()["samples"] == 0
