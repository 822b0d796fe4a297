"""The ledger of a run: mass, energy and momentum of its fluids."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from warpsph.solver.simulation import Simulation


@dataclass(frozen=True)
class Ledger:
    """Totals over all fluid particles in SI units; in 2D per metre of depth. `momentum` has one entry an axis."""

    time_s: float
    mass: float
    kinetic_energy: float
    potential_energy: float
    momentum: list[float]


def measure_ledger(sim: Simulation) -> Ledger:
    """Return the totals of the present state; potential energy is zero at the origin of coordinates."""
    gravity = np.asarray(sim.scene.gravity)
    mass, kinetic, potential, momentum = 0.0, 0.0, 0.0, np.zeros(sim.scene.dimension)
    for particles in sim.frame(("velocity", "mass"), ordered=False).sets:
        if particles.kind != "fluid":
            continue
        m, v, x = (particles.fields[name].astype(np.float64) for name in ("mass", "velocity", "position"))
        mass += float(m.sum())
        kinetic += 0.5 * float(m @ np.einsum("ij,ij->i", v, v))
        potential -= float(m @ (x @ gravity))
        momentum += m @ v
    return Ledger(sim.time, mass, kinetic, potential, [float(p) for p in momentum])
