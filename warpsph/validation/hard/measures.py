"""What hard cases measure on a run: particles that leaked, energies, extremes."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from scipy.spatial import cKDTree

from warpsph.sampling.distance import signed_distance
from warpsph.solver.leaks import LeakFinder
from warpsph.solver.simulation import Simulation


def rows(simulation: Simulation, name: str, field: str = "position") -> np.ndarray:
    """A field of a set in the order of its ids, in double precision."""
    return np.asarray(simulation.frame((field,)).set_named(name).fields[field], dtype=float)


def water_of(simulation: Simulation) -> np.ndarray:
    """Positions [m] of all particles of fluid."""
    return np.concatenate([fluid.fields["position"] for fluid in simulation.frame(()).of_kind("fluid")])


def leaked(simulation: Simulation) -> int:
    """Count particles of fluid that are more than half a spacing inside a structure or outside the boundary `tank`."""
    water, finder = water_of(simulation), LeakFinder(simulation.scene)
    tank = simulation.scene.boundaries["tank"].shape
    count = int((signed_distance(tank, water) > 0.5 * simulation.scene.spacing).sum())
    frame = simulation.frame(finder.fields)
    return count + sum(
        len(finder.inside(frame.set_named(name), water)) for name in simulation.scene.structures
    )


def beyond_plate(simulation: Simulation) -> int:
    """Count particles of `water` on the dry side, to larger x, of the middle line of `plate`."""
    water, plate = rows(simulation, "water"), rows(simulation, "plate")
    _, nearest = cKDTree(plate[:, 1:]).query(water[:, 1:], k=6)
    return int((water[:, 0] > plate[nearest, 0].mean(axis=1)).sum())


def elastic_energy(simulation: Simulation) -> float:
    """Strain and hourglass energy of all structures [J]."""
    energies = simulation.ledger().energies
    return energies["strain"] + energies["hourglass"]


def mechanical_energy(simulation: Simulation) -> float:
    """Kinetic and potential energy of fluids and structures, and elastic energy of structures [J].

    The fluid's own elastic energy is left out: it is some per cent of the others in an impact, and comes back.
    """
    ledger = simulation.ledger()
    elastic = (ledger.energies.get(name, 0.0) for name in ("strain", "hourglass"))
    return ledger.kinetic_energy + ledger.potential_energy + sum(elastic)


def largest_extremes(simulation: Simulation, times: Iterable[float]) -> dict[str, float]:
    """Advance from time to time [s], and return the largest values of `Simulation.extremes` on the way."""
    largest: dict[str, float] = {}
    for time in times:
        for _ in simulation.steps_until(float(time)):
            for name, value in simulation.extremes.items():
                largest[name] = max(largest.get(name, 0.0), value)
    return largest
