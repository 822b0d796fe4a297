"""Fields of the fluid that exist only when a frame asks for them: vorticity and the free surface."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
import warp as wp
from warpsph_kernels.flow_fields import make_flow_field_kernels

from warpsph.particles.neighbours import NeighbourRows
from warpsph.particles.state import host_view
from warpsph.physics.assembly import Assembly


class FlowFields:
    """Computes output fields from synchronised records; arrays and kernels are made at the first question."""

    def __init__(self, assembly: Assembly, rows: NeighbourRows) -> None:
        self._assembly = assembly
        self._rows = rows

    def vorticity(self) -> np.ndarray:
        """Curl of the velocity [1/s] of all particles, (n,) in 2D and (n, 3) in 3D; zero for walls."""
        return self._find(
            "vorticity", make_flow_field_kernels(self._assembly.options).find_vorticity, self._curl
        )

    def free_surface(self) -> np.ndarray:
        """1 for particles at the free surface and 0 for all others, (n,); zero for walls."""
        kernel = make_flow_field_kernels(self._assembly.options).find_free_surface
        return self._find("free surface", kernel, self._flag)

    @cached_property
    def _curl(self) -> wp.array:
        arithmetic = self._assembly.options.arithmetic
        return self._zeros(arithmetic.real if arithmetic.dimension == 2 else arithmetic.vector)

    @cached_property
    def _flag(self) -> wp.array:
        return self._zeros(self._assembly.options.arithmetic.real)

    def _zeros(self, dtype: Any) -> wp.array:
        return wp.zeros(self._assembly.layout.total, dtype=dtype, device=self._assembly.launcher.device)

    def _find(self, stage: str, kernel: Any, target: wp.array) -> np.ndarray:
        a, rows = self._assembly, self._rows
        records = (a.scratch.position_pressure, a.state.velocity_volume)
        a.launcher.bind(stage, kernel, a.constants, rows.index, rows.ends, *records, target).run(
            rows.targets.count
        )
        return host_view(target)
