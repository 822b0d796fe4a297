"""The mass that passes open boundaries."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import warp as wp
from warpsph_kernels.patch_flux import make_patch_flux_kernels

from warpsph.particles.neighbours import NeighbourSearch
from warpsph.physics.assembly import Assembly
from warpsph.sampling.patches import EDGE_MARGIN, FLUX_DEPTH, Patch


class PatchFluxModel:
    """The passes that tally what passes patches.

    flux, mass: (patches,) mass that enters a second [kg/s] and its integral [kg]; in 2D per metre of depth.

    Args:
        patch_of: (stations,) index of the patch of each station.
    """

    def __init__(
        self,
        assembly: Assembly,
        search: NeighbourSearch,
        patches: Sequence[Patch],
        device_patches: wp.array,
        patch_of: wp.array,
        spacing: float,
    ) -> None:
        device, bind = assembly.launcher.device, assembly.launcher.bind
        real, kernels = assembly.options.arithmetic.real, make_patch_flux_kernels(assembly.options)
        self._patches, self._stations = len(patches), patch_of.shape[0]
        self.flux = wp.zeros(self._patches, dtype=wp.float64, device=device)
        self.mass = wp.zeros(self._patches, dtype=wp.float64, device=device)
        share = wp.zeros(self._stations, dtype=wp.float64, device=device)
        places = np.concatenate([patch.points(patch.stations) for patch in patches])
        self._gather = bind(
            "flux",
            kernels.gather_flux,
            assembly.constants,
            real(FLUX_DEPTH * spacing),
            real(EDGE_MARGIN * spacing),
            search.grid,
            search.tables[0].start,
            device_patches,
            patch_of,
            assembly.vectors(places - assembly.space.origin),
            assembly.scratch.position_pressure,
            assembly.state.velocity_volume,
            share,
        )
        self._tally = bind(
            "flux", kernels.tally_flux, assembly.clock, device_patches, share, self.flux, self.mass
        )

    def tally(self) -> None:
        """Add what passes in a step."""
        self._gather.run(self._stations)
        self._tally.run(self._patches)
