"""Interpolation at a point is exact for what the scheme can represent, and knows where there is no fluid."""

import math

import numpy as np
import pytest
from particles import disordered, fluid, frame_of, lattice, linear, probe_of, scene_with, tank_walls, wall

from warpsph.probes.point import interpolate


def point_probe(at, fields=("pressure",), **changes):
    spec = {"type": "point", "at": list(at), "fields": list(fields)}
    return probe_of(scene_with(spec, dimension=len(at), **changes))


@pytest.mark.parametrize("at", [(0.53, 0.48), (0.5, 0.97), (0.0, 0.3), (0.51, 0.47, 0.5), (0.0, 0.0, 0.4)])
def test_linear_fields_are_exact_on_disordered_particles(at):
    """First-order consistency, inside, at the free surface and at a wall: the error is rounding."""
    dimension = len(at)
    position = disordered(lattice([0.0] * dimension, [1.0] * dimension))
    pressure, speed = linear([3.0, -2.0, 5.0][:dimension], 7.0), linear([1.0, 4.0, -1.0][:dimension], -2.0)
    velocity = np.stack([speed(position) * (axis + 1) for axis in range(dimension)], axis=1)
    water = fluid(position, pressure=pressure(position), velocity=velocity)
    walls = wall(tank_walls([0.0] * dimension, [1.0] * (dimension - 1) + [2.0]))
    probe = point_probe(at, ("pressure", "velocity"))
    point = np.array(at)
    expected = [pressure(point), *(speed(point) * (axis + 1) for axis in range(dimension))]
    np.testing.assert_allclose(probe.evaluate(frame_of(water, walls)), expected, rtol=1e-11)


def test_columns_name_quantity_and_unit():
    probe = point_probe((0.5, 0.5), ("pressure", "velocity", "density"))
    assert probe.columns == (
        "probe.pressure[Pa]",
        "probe.velocity_x[m/s]",
        "probe.velocity_y[m/s]",
        "probe.density[kg/m3]",
    )


def test_smooth_field_converges_at_second_order():
    """A linear fit leaves an error of the order of the smoothing length squared."""
    errors = []
    for spacing in (0.1, 0.05):
        position = lattice([0.0, 0.0], [1.0, 1.0], spacing)
        water = fluid(position, spacing, pressure=np.sin(3.0 * position[:, 0]))
        probe = point_probe((0.52, 0.5), spacing=spacing)
        errors.append(abs(probe.evaluate(frame_of(water))[0] - math.sin(3.0 * 0.52)))
    assert math.log2(errors[0] / errors[1]) > 1.8


@pytest.mark.parametrize("at", [(0.5, 1.06), (0.5, 1.5), (2.0, 0.5), (-0.06, 1.06)])
def test_outside_the_fluid_there_is_no_value(at):
    water = fluid(lattice([0.0, 0.0], [1.0, 1.0]), pressure=np.ones(100))
    walls = wall(tank_walls([0.0, 0.0], [1.0, 2.0]))
    assert math.isnan(point_probe(at).evaluate(frame_of(water, walls))[0])


def test_at_the_surface_and_in_a_corner_there_is_a_value():
    """Half filled is filled, and what walls take up does not count."""
    water = fluid(lattice([0.0, 0.0], [1.0, 1.0]), pressure=np.ones(100))
    walls = wall(tank_walls([0.0, 0.0], [1.0, 2.0]))
    for at in ((0.5, 0.99), (0.0, 0.99), (0.0, 0.0)):
        assert point_probe(at).evaluate(frame_of(water, walls))[0] == pytest.approx(1.0, rel=1e-12)


def test_no_fluid_at_all_is_no_value():
    assert math.isnan(point_probe((0.5, 0.5)).evaluate(frame_of(fluid(np.empty((0, 2)))))[0])


def test_particles_in_line_give_their_weighted_mean():
    """A line does not determine a gradient across it: Shepard's mean, here by symmetry the middle value."""
    offsets = np.array([[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0]])
    value = interpolate(offsets, np.array([0.25, 0.5, 0.25]), np.array([[1.0], [3.0], [5.0]]))
    assert value[0] == pytest.approx(3.0)


def test_neighbours_across_a_periodic_boundary_count():
    position = lattice([0.0, 0.0], [1.2, 1.0])
    water = fluid(position, pressure=position[:, 1])
    probe = point_probe((0.0, 0.5), domain={"periodic": {"x": [0.0, 1.2]}})
    assert probe.evaluate(frame_of(water))[0] == pytest.approx(0.5, rel=1e-12)
    assert math.isnan(point_probe((-0.06, 0.5)).evaluate(frame_of(water))[0])


def test_a_line_is_a_row_of_points():
    line = {"type": "line", "start": [0.2, 0.5], "end": [0.8, 0.5], "points": 3, "fields": ["velocity"]}
    probe = probe_of(scene_with(line))
    position = lattice([0.0, 0.0], [1.0, 1.0])
    frame = frame_of(fluid(position, velocity=position * [2.0, 3.0]))
    assert probe.columns[2] == "probe.velocity_x_1[m/s]"
    assert probe.evaluate(frame) == pytest.approx([0.4, 1.5, 1.0, 1.5, 1.6, 1.5])
