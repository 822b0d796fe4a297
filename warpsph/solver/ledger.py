"""The ledger of a run: mass, energy and momentum of its particles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from warpsph.frame import SetFrame
from warpsph.probes.mechanics import cross


@dataclass(frozen=True)
class Ledger:
    """Totals in SI units; in 2D per metre of depth. `momentum` has one entry an axis.

    `energies` holds what a system has beside kinetic and potential energy, by name [J].
    """

    time_s: float
    mass: float
    kinetic_energy: float
    potential_energy: float
    momentum: list[float]
    angular_momentum: list[float]
    energies: dict[str, float]

    def as_record(self) -> dict[str, Any]:
        """Plain values for the summary."""
        return dict(vars(self))


def sum_up(
    time: float,
    sets: tuple[SetFrame, ...],
    gravity: np.ndarray,
    energies: dict[str, float] | None = None,
) -> Ledger:
    """Totals over sets that carry velocity and mass; potential energy is zero at the origin of coordinates."""
    dim = len(gravity)
    mass, kinetic, potential = 0.0, 0.0, 0.0
    momentum, spin = np.zeros(dim), np.zeros(1 if dim == 2 else 3)
    for particles in sets:
        m, v, x = (particles.fields[name].astype(np.float64) for name in ("mass", "velocity", "position"))
        mass += float(m.sum())
        kinetic += 0.5 * float(m @ np.einsum("ij,ij->i", v, v))
        potential -= float(m @ (x @ gravity))
        momentum += m @ v
        spin += m @ cross(x, v)
    totals = ([float(p) for p in momentum], [float(p) for p in spin])
    return Ledger(time, mass, kinetic, potential, *totals, energies or {})
