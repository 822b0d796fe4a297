"""What sampling hands on: particles by set."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

SetKind = Literal["fluid", "boundary", "structure"]


@dataclass(frozen=True)
class Evenness:
    """How even relaxed particles near a surface are.

    unevenness: root mean square of what the kernel sum lacks to that of a lattice, relative to it, with the cells
    beyond the surface, which have been relaxed with them [1]; closest: smallest distance from one of them to another
    particle; spread: standard deviation of the depths of the first layer, 0.29 on a lattice that a surface cuts
    obliquely; both over the spacing [1].
    """

    unevenness: float
    closest: float
    spread: float


@dataclass(frozen=True)
class Placed:
    """Positions (n, dimension) [m] in a shape, and how even they are where they have been relaxed."""

    position: np.ndarray
    evenness: Evenness | None = None


@dataclass(frozen=True)
class SampledSet:
    """The particles of a fluid, boundary or structure at time zero.

    position: (n, dimension) [m]; velocity: (n, dimension) [m/s]; pressure: (n,) [Pa], zero in boundaries;
    volume: of each particle, m^dimension; evenness: of relaxed particles.
    """

    name: str
    kind: SetKind
    position: np.ndarray
    velocity: np.ndarray
    pressure: np.ndarray
    volume: float
    evenness: Evenness | None = None
