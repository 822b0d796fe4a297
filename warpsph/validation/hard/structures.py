"""Hard cases of structures alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from warpsph.sampling import sample
from warpsph.scene.schema import Scene
from warpsph.solver.ledger import Ledger
from warpsph.validation.hard.case import Figure, Machine
from warpsph.validation.hard.shapes import box, elastic

SOFT = {"law": "neo_hookean", **elastic(1000.0, 1.0e6)}


def total_energy(ledger: Ledger) -> float:
    """Kinetic, strain and hourglass energy [J]."""
    return ledger.kinetic_energy + ledger.energies["strain"] + ledger.energies["hourglass"]


def swinging_beam(end: float = 1.0) -> Scene:
    """A clamped beam, four particles thick, that starts with a speed growing along it; no gravity, no damping."""
    beam = {
        "shape": box((-0.05, 0.0), (0.4, 0.05)),
        "material": SOFT,
        "velocity": ("0", "where(x > 0, 5 * x, 0)"),
        "clamps": {"root": {"region": box((-1.0, -1.0), (0.0, 1.0))}},
    }
    return Scene(
        name="swinging_beam",
        dimension=2,
        spacing=0.0125,
        time={"end": end, "frame_rate": 10.0},
        structures={"beam": beam},
    )


def beam_for_twenty_times_as_long(machine: Machine) -> list[Figure]:
    """A beam that swings without damping for 20 s, some forty of its periods: its energy neither grows nor fades.

    A beam that swings far has no period to hold it against; its energy is conserved whatever it does.
    """
    simulation = machine.simulate(swinging_beam(20.0))
    start = total_energy(simulation.ledger())
    energies = []
    for time in range(1, 21):
        simulation.advance(float(time))
        energies.append(total_energy(simulation.ledger()) / start)
    return [Figure("largest change of the energy", max(abs(energy - 1.0) for energy in energies), 0.01)]


def scattered_block(machine: Machine) -> list[Figure]:
    """A free block whose particles are off their lattice by up to a fifth of a spacing is thrown, spins and stretches.

    It keeps its energy, and its momentum to rounding.
    """
    shape = box((0.0, 0.0), (0.8, 0.4))
    scene = Scene(
        name="scattered_block",
        dimension=2,
        spacing=0.05,
        time={"end": 1.0, "frame_rate": 10.0},
        structures={"block": {"shape": shape, "material": SOFT}},
    )
    (one,) = sample(scene)
    off = np.random.default_rng(3).uniform(-0.2, 0.2, one.position.shape) * scene.spacing
    place = one.position + off
    thrown = np.column_stack([-2.0 * place[:, 1], 4.0 * place[:, 0]])
    system = machine.system(scene, [replace(one, position=place, velocity=thrown)])
    start = system.ledger()
    made, end = 0, 0.5
    system.set_target(end)
    while system.time < end:
        made += system.step(made).count
    last = system.ledger()
    moved = np.abs(np.subtract(last.momentum, start.momentum)).max() / np.abs(start.momentum).max()
    return [
        Figure("change of the energy", abs(total_energy(last) / total_energy(start) - 1.0), 0.01),
        Figure("change of the momentum", float(moved), 1e-5),
    ]


CASES = (beam_for_twenty_times_as_long, scattered_block)
