"""Fluids and structures meant to break the coupling: each survives and keeps its water out.

A particle has leaked where it is more than half a spacing behind a surface: inside a body as it is deformed, beyond the
plate that holds the water back, or out of the tank.
"""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from warpsph.scene.schema import Scene
from warpsph.validation.hard.case import Machine
from warpsph.validation.hard.coupled_scenes import (
    DP,
    behind_plate,
    held_back,
    jet_at_a_plate,
    plate_in_still_water,
    tank_of_water,
)
from warpsph.validation.hard.measures import beyond_plate, elastic_energy, leaked, mechanical_energy, rows
from warpsph.validation.hard.shapes import GRAVITY, box, elastic


def simulate(scene):
    return Machine("cpu", threads=1).simulate(scene)


def centre(simulation, name, field="position"):
    return rows(simulation, name, field).mean(axis=0)


def follow(simulation, times, check=leaked):
    """Advance from time to time and see that everything is finite and nothing has leaked."""
    for time in times:
        simulation.advance(float(time))
        for particles in simulation.frame(("velocity",)).sets:
            assert np.isfinite(particles.fields["velocity"]).all()
        assert check(simulation) == 0, simulation.time


@pytest.mark.parametrize(("density", "young"), [(100.0, 1e6), (100.0, 3e7), (300.0, 1e8), (1000.0, 1e6)])
def test_a_thin_plate_lighter_than_water_holds_it_back(density, young):
    """Three particles thick. Where the coupling feeds its vibrations, their energy grows tenfold in half a second.

    A light plate has passed its first swing early and should have no more energy later; a heavier one is still on it.
    """
    simulation = simulate(held_back(density, young, cells=3))
    early, late = [], []
    for times, energies in ((np.linspace(0.02, 0.2, 10), early), (np.linspace(0.42, 0.6, 10), late)):
        for time in times:
            follow(simulation, [time], beyond_plate)
            energies.append(elastic_energy(simulation))
    assert max(late) < max(early) * (1.1 if density < 1000.0 else 3.0)


def test_a_light_block_rises_and_floats():
    """A tenth as heavy as water, from near the floor: after a second it floats, and does not ring."""
    block = {"material": elastic(100.0, 1e6)}
    simulation = simulate(tank_of_water({"block": ((0.24, 0.1), (0.36, 0.22), block)}, width=0.6, depth=0.4))
    follow(simulation, np.linspace(0.1, 1.0, 10))
    assert centre(simulation, "block")[1] > 0.36
    assert elastic_energy(simulation) < 0.1


@pytest.mark.parametrize(("density", "young"), [(1100.0, 1e7), (300.0, 1e7), (100.0, 1e8), (100.0, 1e6)])
def test_a_plate_hits_water_at_ten_metres_a_second(density, young):
    """Three particles thick, flat on the water, from a gap of three spacings. What is left of its energy is less than
    it brought and its fall has added."""
    plate = {"material": elastic(density, young), "velocity": (0.0, -10.0)}
    simulation = simulate(
        tank_of_water({"plate": ((0.2, 0.3), (0.4, 0.36), plate)}, depth=0.24, sound_speed=150.0)
    )
    mass, high = density * 0.2 * 0.06, 0.33
    follow(simulation, np.linspace(0.005, 0.06, 12))
    velocity = rows(simulation, "plate", "velocity")
    kinetic = 0.5 * mass * np.square(velocity).sum(axis=1).mean()
    fall = mass * GRAVITY * (high - centre(simulation, "plate")[1])
    assert kinetic + elastic_energy(simulation) < 0.5 * mass * 10.0**2 + fall
    # Water brakes it: momentum is shared with what it takes along.
    assert -5.0 < centre(simulation, "plate", "velocity")[1] < 5.0


def test_a_block_leaves_the_water_and_falls_back():
    """Thrown up from below the surface, it jumps clear, farther than the fluid reaches, and comes back."""
    block = {"material": elastic(800.0, 1e6), "velocity": (0.0, 4.0)}
    simulation = simulate(tank_of_water({"block": ((0.24, 0.28), (0.36, 0.4), block)}, sound_speed=60.0))
    heights, distances = [], []
    for time in np.linspace(0.05, 1.0, 20):
        follow(simulation, [time])
        body, water = rows(simulation, "block"), rows(simulation, "water")
        heights.append(body[:, 1].mean())
        distances.append(cKDTree(water).query(body)[0].min())
    assert max(distances) > 3.0 * DP
    assert distances[-1] < 1.5 * DP
    # It is no denser than water and ends within it, with no more than its fall has given it.
    assert heights[-1] < max(heights)
    assert elastic_energy(simulation) < 2.0


@pytest.mark.parametrize("young", [1e6, pytest.param(1e8, marks=pytest.mark.verification)])
def test_two_structures_touch_under_water(young):
    """A heavy block sinks onto a lighter one and both to the floor; contact keeps them apart, and water out of them."""
    lower = {"material": elastic(1100.0, young), "velocity": (0.0, 1.0)}
    upper = {"material": elastic(2500.0, young), "velocity": (0.0, -1.0)}
    bodies = {"lower": ((0.16, 0.06), (0.36, 0.16), lower), "upper": ((0.26, 0.22), (0.4, 0.32), upper)}
    simulation = simulate(tank_of_water(bodies, depth=0.4, contact={"friction": 0.3}))
    nearest = []
    for time in np.linspace(0.05, 0.8, 16):
        follow(simulation, [time])
        one, other = rows(simulation, "lower"), rows(simulation, "upper")
        nearest.append(cKDTree(one).query(other)[0].min() / DP)
    # Surfaces touch at one spacing; as far as half a spacing deeper is what a run would warn of.
    assert 0.5 < min(nearest) < 1.3
    assert all(rows(simulation, name)[:, 1].min() > 0.0 for name in bodies)


@pytest.mark.parametrize(
    "more",
    [
        {"material": elastic(2500.0, 1e6)},
        pytest.param({"material": elastic(2500.0, 1e8)}, marks=pytest.mark.verification),
        pytest.param({"material": elastic(2500.0, 1e7), "rigid": {}}, marks=pytest.mark.verification),
    ],
    ids=["soft", "stiff", "rigid"],
)
def test_a_block_sinks_to_the_floor_and_rests(more):
    """Where the cells of its lowest row stand on the floor: no water is caught beneath, and it does not go through."""
    simulation = simulate(
        tank_of_water({"block": ((0.24, 0.14), (0.36, 0.26), more)}, contact={"friction": 0.3})
    )
    follow(simulation, np.linspace(0.1, 1.2, 12))
    place = rows(simulation, "block")
    assert place[:, 1].min() == pytest.approx(0.5 * DP, abs=0.15 * DP)
    assert np.abs(centre(simulation, "block", "velocity")).max() < 0.1


@pytest.mark.parametrize("young", [1e4, 1e6, 1e8, 1e10, 2e11])
def test_from_jelly_to_steel(young):
    """One plate in still water of equal depth on both sides, over seven decades of stiffness: it stays where it is.

    The fluid's steps are its own at any stiffness.
    """
    simulation = simulate(plate_in_still_water(young))
    follow(simulation, np.linspace(0.02, 0.1, 5))
    # Its weight in water over its stiffness, and the waves that the water makes as it settles: p = rho g h / 20.
    most = 0.5 * DP if young < 1e5 else 1e-4
    assert np.abs(rows(simulation, "plate", "displacement")[:, 0]).max() < most
    assert simulation.step_count < 250


@pytest.mark.parametrize(("young", "cells"), [(1e6, 3), (1e7, 3), (1e8, 2), (1e9, 3)])
def test_a_jet_at_a_thin_plate(young, cells):
    """From a plate that gives way by a third of its span to one that hardly moves: no water comes through.

    What strikes it gives away its momentum, once if it is turned along the plate, twice if it is thrown back; the
    clamps rest and do no work, so that motion and strain together never have more energy than the jet brought along.
    """
    simulation = simulate(jet_at_a_plate(young, cells))
    energies = [mechanical_energy(simulation)]
    for time in np.linspace(0.005, 0.06, 12):
        simulation.advance(time)
        energies.append(mechanical_energy(simulation))
        assert behind_plate(simulation, cells) == 0
    left = centre(simulation, "water", "velocity")[0] / -10.0
    assert -1.0 < left < 0.0
    # Waves of compression take energy out of these sums and bring it back: some per cent of it in an impact.
    assert (np.diff(energies) < 0.01 * energies[0]).all()
    assert energies[-1] < energies[0]


def test_forty_plates_with_eighty_clamps_stand_in_still_water():
    """A comb on the floor of a tank, every plate held by two clamps: each stays where its own feet are."""
    pitch, count = 8 * DP, 40
    plates, displaced = {}, []
    for k in range(count):
        left, middle, right = k * pitch, (k + 0.5) * pitch, (k + 1) * pitch
        shape = box((middle - 2 * DP, -4 * DP), (middle + 2 * DP, 8 * DP))
        halves = {
            "left": {"region": box((left, -1.0), (middle, 0.0))},
            "right": {"region": box((middle, -1.0), (right, 0.0))},
        }
        plates[f"plate_{k}"] = {"shape": shape, "material": elastic(1500.0, 1e6), "clamps": halves}
        displaced.append(shape)
    width = count * pitch
    water = {"type": "difference", "base": box((0.0, 0.0), (width, 0.24)), "subtract": displaced}
    scene = Scene(
        name="comb",
        dimension=2,
        spacing=DP,
        gravity=(0.0, -GRAVITY),
        time={"end": 0.1, "frame_rate": 20.0},
        numerics={"sound_speed": 25.0},
        fluids={"water": {"shape": water, "density": 1000.0, "pressure": {"type": "hydrostatic"}}},
        boundaries={"tank": {"shape": box((0.0, 0.0), (width, 0.4)), "side": "outside", "open": ("y_max",)}},
        structures=plates,
    )
    simulation = simulate(scene)
    follow(simulation, [0.05, 0.1])
    for k, name in enumerate(plates):
        place, way = rows(simulation, name), rows(simulation, name, "displacement")
        assert np.array_equal(way[place[:, 1] < 0.0], np.zeros_like(way[place[:, 1] < 0.0]))
        assert place[:, 0].mean() == pytest.approx((k + 0.5) * pitch, abs=0.1 * DP)
        assert np.abs(way).max() < 0.1 * DP
