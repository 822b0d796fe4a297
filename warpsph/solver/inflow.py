"""What passes the open boundaries of a run."""

from __future__ import annotations

from warpsph_kernels.exchange import ENTERED, LEFT, REMOVED_BEHIND, RETURNED

from warpsph.frame import Inflow
from warpsph.particles.state import host_view
from warpsph.solver.assemble import Parts

_ENTERED, _LEFT, _REMOVED = (ENTERED,), (LEFT, RETURNED), (REMOVED_BEHIND, RETURNED)


def inflows(parts: Parts) -> dict[str, Inflow]:
    """What has passed each open boundary, by name."""
    opened = parts.open_boundaries
    if opened is None:
        return {}
    flux, mass = host_view(opened.model.passing.flux), host_view(opened.model.passing.mass)
    particle = float(parts.assembly.constants.mass)
    found = {}
    for k, patch in enumerate(opened.model.patches):
        events = opened.exchange.counts[k]
        counts = [int(events[list(kinds)].sum()) for kinds in (_ENTERED, _LEFT, _REMOVED)]
        counted = particle * (counts[0] - counts[1])
        found[patch.name] = Inflow(float(flux[k]), float(mass[k]), counted, *counts)
    return found
