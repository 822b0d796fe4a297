"""Energies are those of mechanics and of the equation of state."""

import numpy as np
import pytest
from particles import DENSITY, GRAVITY, SPACING, fluid, frame_of, lattice, probe_of, scene_with

SOUND_SPEED = 30.0


def energies(water, dimension=2):
    return probe_of(scene_with({"type": "energy"}, dimension)).evaluate(frame_of(water))


@pytest.mark.parametrize("dimension", [2, 3])
def test_kinetic_energy_of_a_block_in_translation(dimension):
    position = lattice([0.0] * dimension, [1.0] * dimension)
    velocity = np.tile([3.0, -4.0, 12.0][:dimension], (len(position), 1))
    kinetic, _, compression = energies(fluid(position, velocity=velocity), dimension)
    assert kinetic == pytest.approx(0.5 * DENSITY * np.sum(velocity[0] ** 2))
    assert compression == 0.0


def test_potential_energy_of_a_block_is_that_of_its_centre_of_mass():
    block = fluid(lattice([0.0, 1.0], [1.0, 3.0]))
    assert energies(block)[1] == pytest.approx(DENSITY * 2.0 * GRAVITY * 2.0)


def test_units_are_per_metre_of_depth_in_the_plane():
    columns = {n: probe_of(scene_with({"type": "energy"}, n)).columns for n in (2, 3)}
    assert columns[2] == ("probe.kinetic[J/m]", "probe.potential[J/m]", "probe.compression[J/m]")
    assert columns[3][0] == "probe.kinetic[J]"


def test_compression_energy_of_a_set_is_weighted_by_mass():
    position = lattice([0.0, 0.0], [1.0, 1.0])
    strain = 0.01
    pressure = DENSITY * SOUND_SPEED**2 / 7.0 * ((1.0 + strain) ** 7 - 1.0)
    n = len(position)
    water = fluid(position, density=np.full(n, DENSITY * (1 + strain)), pressure=np.full(n, pressure))
    # p / rho^2 integrated in powers of strain: c^2 strain^2 / 2 (1 + (gamma - 5) / 3 strain + ...)
    specific = 0.5 * SOUND_SPEED**2 * strain**2 * (1.0 + 2.0 / 3.0 * strain)
    expected = DENSITY * n * SPACING**2 * specific
    assert energies(water)[2] == pytest.approx(expected, rel=1e-3)


def test_fluid_at_the_tension_cutoff_stores_what_its_expansion_takes_from_that_pressure():
    """Below the cutoff p_c the integral of p / rho^2 is p_c (1/rho_0 - 1/rho), here 20 % expanded at -100 Pa."""
    cutoff, n = -100.0, 100
    density, pressure = np.full(n, DENSITY / 1.2), np.full(n, cutoff)
    water = fluid(lattice([0.0, 0.0], [1.0, 1.0]), density=density, pressure=pressure)
    scene = scene_with({"type": "energy"}, numerics={"tension_cutoff": cutoff})
    expected = DENSITY * n * SPACING**2 * cutoff * (1.0 / DENSITY - 1.2 / DENSITY)
    assert probe_of(scene).evaluate(frame_of(water))[2] == pytest.approx(expected)
