"""Fields of walls that exist only when a frame asks for them: the viscous force and the wall shear stress."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
import warp as wp
from warpsph_kernels.wall_fields import make_wall_field_kernels

from warpsph.particles.state import host_view
from warpsph.physics.assembly import Assembly, WallRange
from warpsph.physics.boundary import Reaction


class WallFields:
    """Computes fields of a range of wall particles from synchronised records; made at the first question."""

    def __init__(self, assembly: Assembly, walls: WallRange, fluid_reaction: Reaction) -> None:
        self._assembly, self._walls, self._fluid_reaction = assembly, walls, fluid_reaction

    def viscous_force(self) -> np.ndarray:
        """Viscous part of the force of the fluid on each particle [N], (count, dimension)."""
        self._find("viscous force", self._kernels.find_viscous_force, (), self._force)
        if self._assembly.options.wall_friction:
            self._fluid_reaction(self._walls, self._force)
        return host_view(self._force)

    def shear_stress(self) -> np.ndarray:
        """Wall shear stress [Pa] at the surface of no-slip walls (count, dimension), elsewhere zero."""
        normal = (self._walls.surface.normal,)
        self._find("wall shear stress", self._kernels.find_shear_stress, normal, self._stress)
        return host_view(self._stress)

    @cached_property
    def _kernels(self) -> Any:
        return make_wall_field_kernels(self._assembly.options)

    @cached_property
    def _force(self) -> wp.array:
        return self._zeros()

    @cached_property
    def _stress(self) -> wp.array:
        return self._zeros()

    def _zeros(self) -> wp.array:
        vector = self._assembly.options.arithmetic.vector
        return wp.zeros(max(self._walls.count, 1), dtype=vector, device=self._assembly.launcher.device)

    def _find(self, stage: str, kernel: Any, more: tuple[wp.array, ...], target: wp.array) -> None:
        a, walls = self._assembly, self._walls
        rows, records = walls.rows, (a.scratch.position_pressure, a.state.velocity_volume)
        lists = (walls.first, rows.index, rows.ends, *records, walls.surface.friction)
        a.launcher.bind(stage, kernel, a.constants, *lists, *more, target).run(walls.count)
