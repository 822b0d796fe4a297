"""The arrays of a run: evolving state and scratch, in one index space of fluid, walls and faces of structures."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic

UNITS = {
    "position": "m",
    "velocity_volume": "m/s, m^dim",
    "density_deviation": "kg/m^dim",
    "density_rate": "kg/m^dim/s",
    "acceleration": "m/s^2",
    "id": "1",
    "set_index": "1",
    "patch": "1",
    "position_pressure": "m, Pa",
    "position_density": "m, kg/m^dim",
    "carried_viscosity": "Pa s",
    "viscosity": "Pa s",
    "wall_friction": "m/s, 1",
    "wall_mirror": "m",
    "wall_reference": "m",
    "wall_normal": "1",
    "wall_surface_normal": "1",
    "wall_force": "N",
    "stress": "Pa",
    "shift": "m/s",
    "next_shift": "m/s",
    "closing": "1/s",
    "coverage": "1",
    "gradient_excess": "1",
    "density_gradient": "kg/m^(dim+1)",
}


@dataclass(frozen=True)
class Layout:
    """Places for particles of each kind; fluid has the indices 0 .. fluids - 1, walls those behind, then faces.

    The last `images` places of the fluid are for its mirror images at planes of symmetry, and the `spare` places before
    them for fluid that is to come. `faces` are wall particles that move with structures.
    """

    fluids: int
    walls: int
    images: int = 0
    faces: int = 0
    spare: int = 0

    @property
    def first_image(self) -> int:
        """Index of the first image, which is the number of places for fluid particles."""
        return self.fluids - self.images

    @property
    def fluids_at_start(self) -> int:
        """Number of fluid particles at the start."""
        return self.first_image - self.spare

    @property
    def solids(self) -> int:
        """Number of particles that act on the fluid as walls."""
        return self.walls + self.faces

    @property
    def first_face(self) -> int:
        """Index of the first face of a structure."""
        return self.fluids + self.walls

    @property
    def total(self) -> int:
        return self.fluids + self.solids


@dataclass(frozen=True)
class State:
    """What evolves, and what a checkpoint keeps; every array has shape (n,).

    position: double vectors [m]; velocity_volume: records (v [m/s], V [m^dim]); density_deviation: rho - rho0
    [kg/m^dim]; density_rate: its rate at the end of the last step; acceleration [m/s^2]; id: never used twice;
    set_index: place of the particle's set among all sets.
    """

    position: wp.array
    velocity_volume: wp.array
    density_deviation: wp.array
    density_rate: wp.array
    acceleration: wp.array
    id: wp.array
    set_index: wp.array


@dataclass(frozen=True)
class Scratch:
    """What a step computes anew: the records that pair loops read, (x, p) and (x, rho - rho0)."""

    position_pressure: wp.array
    position_density: wp.array


def arrays_of(group: State | Scratch) -> Iterator[tuple[str, wp.array]]:
    """Yield name and array of each member of a group."""
    for member in fields(group):
        yield member.name, getattr(group, member.name)


def allocate_state(arithmetic: Arithmetic, layout: Layout, device: Any) -> State:
    """Return zeroed state arrays for all particles."""

    def zeros(dtype: Any) -> wp.array:
        return wp.zeros(layout.total, dtype=dtype, device=device)

    return State(
        position=zeros(arithmetic.point),
        velocity_volume=zeros(arithmetic.record),
        density_deviation=zeros(arithmetic.real),
        density_rate=zeros(arithmetic.real),
        acceleration=zeros(arithmetic.vector),
        id=zeros(wp.int64),
        set_index=zeros(wp.int32),
    )


def allocate_scratch(arithmetic: Arithmetic, layout: Layout, device: Any) -> Scratch:
    """Return zeroed scratch arrays for all particles."""
    return Scratch(
        position_pressure=wp.zeros(layout.total, dtype=arithmetic.record, device=device),
        position_density=wp.zeros(layout.total, dtype=arithmetic.record, device=device),
    )


def host_view(array: wp.array) -> np.ndarray:
    """Return an array as NumPy, without a copy where the device shares memory with the host."""
    return np.asarray(array.numpy())


def write_array(target: wp.array, values: np.ndarray) -> None:
    """Overwrite the first entries of an array from the host, keeping the array's identity."""
    if target.device.is_cpu:
        host_view(target)[: len(values)] = values
    elif len(values):
        source = wp.array(np.ascontiguousarray(values), dtype=target.dtype, device=target.device)
        wp.copy(target, source, count=len(values))


class HostTable:
    """An array that the host writes and kernels read: `values` is its memory where the device shares that of the host,
    else a copy that `send` hands over."""

    def __init__(self, array: wp.array) -> None:
        self._array = array
        self.values = host_view(array) if array.device.is_cpu else np.array(host_view(array))

    def send(self) -> None:
        """Let kernels see the values."""
        if not self._array.device.is_cpu:
            write_array(self._array, self.values)
