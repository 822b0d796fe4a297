"""Hard cases of fluids and structures together."""

from __future__ import annotations

import numpy as np

from warpsph.validation.hard.case import Figure, Machine
from warpsph.validation.hard.coupled_scenes import (
    DP,
    behind_plate,
    held_back,
    jet_at_a_plate,
    plate_in_still_water,
    tank_of_water,
)
from warpsph.validation.hard.measures import beyond_plate, elastic_energy, leaked, mechanical_energy, rows
from warpsph.validation.hard.shapes import elastic


def jet_at_a_thin_soft_plate(machine: Machine) -> list[Figure]:
    """A jet of 10 m/s strikes a plate of three particles, which gives way by a third of its span."""
    return _jet(machine, young=1e6, cells=3)


def jet_at_a_thin_stiff_plate(machine: Machine) -> list[Figure]:
    """The same jet, and a plate of two particles that hardly moves."""
    return _jet(machine, young=1e8, cells=2)


def _jet(machine: Machine, young: float, cells: int) -> list[Figure]:
    """Waves of compression take energy out of these sums and bring it back: some per cent of it in an impact."""
    simulation = machine.simulate(jet_at_a_plate(young, cells))
    energies, through = [mechanical_energy(simulation)], 0
    for time in np.linspace(0.005, 0.06, 12):
        simulation.advance(float(time))
        energies.append(mechanical_energy(simulation))
        through = max(through, behind_plate(simulation, cells))
    return [
        Figure("particles through the plate", through, 0.0),
        Figure("energy gained", max(energies) / energies[0] - 1.0, 0.01),
    ]


def plate_a_tenth_as_dense_as_water(machine: Machine) -> list[Figure]:
    """A light plate of three particles holds water back: the coupling must not feed its vibrations.

    Where it does, their energy grows tenfold in half a second. The plate has passed its first swing early.
    """
    simulation = machine.simulate(held_back(100.0, 1e6, cells=3))
    early, late, through = [0.0], [0.0], 0
    for time in (*np.linspace(0.02, 0.2, 10), *np.linspace(0.42, 0.6, 10)):
        simulation.advance(float(time))
        through = max(through, beyond_plate(simulation))
        (early if time < 0.3 else late).append(elastic_energy(simulation))
    return [
        Figure("elastic energy, late over early", max(late) / max(early), 1.1),
        Figure("particles through the plate", through, 0.0),
    ]


def block_twenty_times_as_dense_as_water(machine: Machine) -> list[Figure]:
    """A heavy block falls through still water to the floor and comes to rest on it.

    The speed is that of its centre of mass: nothing damps the sound in the block after its impact.
    """
    block = {"material": elastic(20.0e3, 1e8)}
    scene = tank_of_water({"block": ((0.24, 0.1), (0.36, 0.22), block)}, contact={"friction": 0.3})
    simulation = machine.simulate(scene)
    outside = 0
    for time in np.linspace(0.1, 1.0, 10):
        simulation.advance(float(time))
        outside = max(outside, leaked(simulation))
    lowest = rows(simulation, "block")[:, 1].min() / DP - 0.5
    speed = np.abs(rows(simulation, "block", "velocity").mean(axis=0)).max()
    return [
        Figure("distance from its place on the floor", abs(float(lowest)), 0.15, "dp"),
        Figure("speed left", float(speed), 0.1, "m/s"),
        Figure("particles of water in it or outside", outside, 0.0),
    ]


def plate_of_jelly_in_water(machine: Machine) -> list[Figure]:
    """A plate of 10 kPa in water of equal depth on both sides stays where it is."""
    return _still_plate(machine, 1e4, 0.5)


def plate_of_steel_in_water(machine: Machine) -> list[Figure]:
    """A plate of 200 GPa in still water, at a fluid's time step that does not know of it."""
    return _still_plate(machine, 2e11, 0.005)


def _still_plate(machine: Machine, young: float, most: float) -> list[Figure]:
    simulation = machine.simulate(plate_in_still_water(young))
    outside = 0
    for time in np.linspace(0.02, 0.1, 5):
        simulation.advance(float(time))
        outside = max(outside, leaked(simulation))
    moved = np.abs(rows(simulation, "plate", "displacement")[:, 0]).max() / DP
    return [
        Figure("largest displacement", float(moved), most, "dp"),
        Figure("particles of water in it or outside", outside, 0.0),
        Figure("steps of the fluid", simulation.step_count, 250.0),
    ]


def plate_in_water_for_twenty_times_as_long(machine: Machine) -> list[Figure]:
    """A plate in still water of equal depth for 40 s: no vibration grows, and no water gets through."""
    scene = plate_in_still_water(1e6)
    simulation = machine.simulate(scene)
    energies, outside = [], 0
    for time in np.linspace(1.0, 20.0, 20) * scene.time.end:
        simulation.advance(float(time))
        outside = max(outside, leaked(simulation))
        energies.append(simulation.ledger().kinetic_energy)
    return [
        Figure("kinetic energy, last fifth over first", max(energies[-4:]) / max(energies[:4]), 1.0),
        Figure("particles of water in it or outside", outside, 0.0),
    ]


CASES = (
    jet_at_a_thin_soft_plate,
    jet_at_a_thin_stiff_plate,
    plate_a_tenth_as_dense_as_water,
    block_twenty_times_as_dense_as_water,
    plate_of_jelly_in_water,
    plate_of_steel_in_water,
    plate_in_water_for_twenty_times_as_long,
)
