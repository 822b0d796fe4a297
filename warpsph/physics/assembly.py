"""What the models of one run share: options, constants, arrays, lists and the launcher."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp
from warpsph_kernels.options import FluidOptions

from warpsph.laws.states import StateLaw
from warpsph.particles.launch import Launcher
from warpsph.particles.neighbours import NeighbourRows, SearchSpace
from warpsph.particles.state import Layout, Scratch, State


@dataclass(frozen=True)
class Assembly:
    """The parts from which a model builds its passes. `clock` is described in `warpsph_kernels.clock`."""

    launcher: Launcher
    options: FluidOptions
    constants: Any
    space: SearchSpace
    layout: Layout
    state: State
    scratch: Scratch
    clock: wp.array
    state_law: StateLaw

    def density_deviation(self, pressure: np.ndarray) -> np.ndarray:
        """Return rho - rho0 [kg/m^dim] of the fluid at pressures [Pa]."""
        c = self.constants
        density = float(c.rest_density)
        numbers = [float(x) for x in c.state_parameters][: len(self.state_law.parameters)]
        return self.state_law.deviation(
            pressure, density, density * float(c.sound_speed) ** 2, tuple(numbers)
        )

    def vectors(self, values: np.ndarray) -> wp.array:
        """Vectors (n, dim) on the device, at least one."""
        rows = values if len(values) else np.zeros((1, self.options.arithmetic.dimension))
        return wp.array(
            np.ascontiguousarray(rows), dtype=self.options.arithmetic.vector, device=self.launcher.device
        )

    @property
    def origin(self) -> Any:
        """Origin of the single-precision coordinates as a device value."""
        return self.options.arithmetic.point(*self.space.origin)


@dataclass(frozen=True)
class WallSurface:
    """What the fluid needs of each wall particle beside its pressure; arrays of shape (walls,), or (1,) without any.

    friction: records (velocity that viscosity sees [m/s], 1 where the wall is no-slip else 0); normal: unit vectors
    out of the wall at its surface, zero behind it.
    """

    friction: wp.array
    normal: wp.array

    def part(self, first: int, count: int) -> WallSurface:
        """A view of `count` wall particles from the `first` on."""
        return WallSurface(self.friction[first : first + count], self.normal[first : first + count])


@dataclass(frozen=True)
class WallRange:
    """A contiguous range of wall particles: its place in the index space, its neighbour rows, and its surface."""

    first: int
    count: int
    rows: NeighbourRows
    surface: WallSurface
