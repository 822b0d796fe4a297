"""Hard cases of the time step: how far beyond the default a run stays what it is."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from warpsph.scene.schema import Scene
from warpsph.solver.errors import SimulationDiverged
from warpsph.validation.hard.case import Figure, Machine
from warpsph.validation.hard.coupled_scenes import held_back
from warpsph.validation.hard.fluids import falling_column, set_free, still_water
from warpsph.validation.hard.measures import beyond_plate, elastic_energy, leaked, mechanical_energy
from warpsph.validation.hard.structures import swinging_beam, total_energy

RATIO = 1.05
"""Between two Courant numbers of a sweep."""
LONGEST = 4.0
"""Times the default up to which a sweep goes."""


def edge_of_stability(stable: Callable[[float], bool]) -> float:
    """The largest factor of a sweep, 1, 1.05, 1.05^2 ..., with which a run is stable, found by bisection; 0 if none.

    Bisection takes for granted that what is stable with a factor is stable below it.
    """
    factors = RATIO ** np.arange(np.ceil(np.log(LONGEST) / np.log(RATIO)) + 1)
    low, high = -1, len(factors)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if stable(float(factors[middle])) else (low, middle)
    return float(factors[low]) if low >= 0 else 0.0


def edge_of_the_courant_number_of_fluids(machine: Machine) -> list[Figure]:
    """A falling column and still water at longer and longer steps, `time.cfl`: the last one with which all is well.

    Well is: no particle outside, no more energy than at the start (within 1 % of what the fall sets free), and water
    at rest, with less than 1e-3 of its potential energy in motion after half a second.
    """

    def stable(factor: float) -> bool:
        return _survives(lambda: _falls(machine, factor) and _rests(machine, factor))

    return _margin(edge_of_stability(stable), falling_column().time.cfl, 1.5)


def edge_of_the_courant_number_of_structures(machine: Machine) -> list[Figure]:
    """A swinging beam at longer and longer steps, `numerics.structure.cfl`: the last one that keeps its energy to 2 %.

    The limit of the scheme is 1, and the largest frequency is measured to a few per cent.
    """

    def stable(factor: float) -> bool:
        return _survives(lambda: _swings(machine, factor))

    return _margin(edge_of_stability(stable), swinging_beam().numerics.structure.cfl, 1.15)


def edge_of_the_courant_number_beside_structures(machine: Machine) -> list[Figure]:
    """Water held back by a plate at longer and longer steps of the fluid, `time.cfl`.

    Well is: no water through the plate, and no more elastic energy late than early.
    """

    def stable(factor: float) -> bool:
        return _survives(lambda: _holds_back(machine, factor))

    return _margin(edge_of_stability(stable), held_back(1000.0, 1e6, cells=3).time.cfl, 1.5)


def _margin(edge: float, default: float, margin: float) -> list[Figure]:
    return [Figure("edge", edge * default, margin * default, at_least=True)]


def _survives(run: Callable[[], bool]) -> bool:
    try:
        return run()
    except SimulationDiverged:
        return False


def with_fluid_cfl(scene: Scene, factor: float) -> Scene:
    """The scene with so many times its Courant number, beyond what a scene file may ask for."""
    time = scene.time.model_copy(update={"cfl": factor * scene.time.cfl})
    return scene.model_copy(update={"time": time})


def with_structure_cfl(scene: Scene, factor: float) -> Scene:
    """The same for that of structures."""
    own = scene.numerics.structure
    structure = own.model_copy(update={"cfl": factor * own.cfl})
    return scene.model_copy(update={"numerics": scene.numerics.model_copy(update={"structure": structure})})


def _falls(machine: Machine, factor: float) -> bool:
    scene = with_fluid_cfl(falling_column(), factor)
    simulation = machine.simulate(scene)
    most = mechanical_energy(simulation) + 0.01 * set_free(scene)
    for time in np.linspace(0.1, 0.7, 7):
        simulation.advance(float(time))
        if leaked(simulation) or not mechanical_energy(simulation) < most:
            return False
    return True


def _rests(machine: Machine, factor: float) -> bool:
    simulation = machine.simulate(with_fluid_cfl(still_water(), factor))
    simulation.advance(0.5)
    ledger = simulation.ledger()
    return leaked(simulation) == 0 and ledger.kinetic_energy < 1e-3 * ledger.potential_energy


def _swings(machine: Machine, factor: float) -> bool:
    simulation = machine.simulate(with_structure_cfl(swinging_beam(), factor))
    start = total_energy(simulation.ledger())
    simulation.advance(1.0)
    return abs(total_energy(simulation.ledger()) / start - 1.0) < 0.02


def _holds_back(machine: Machine, factor: float) -> bool:
    simulation = machine.simulate(with_fluid_cfl(held_back(300.0, 1e7, cells=3), factor))
    energies = []
    for time in np.linspace(0.03, 0.3, 10):
        simulation.advance(float(time))
        energies.append(elastic_energy(simulation))
        if beyond_plate(simulation):
            return False
    return max(energies[5:]) < 1.2 * max(energies[:5])


CASES = (
    edge_of_the_courant_number_of_fluids,
    edge_of_the_courant_number_of_structures,
    edge_of_the_courant_number_beside_structures,
)
