"""What sampling hands on: particles by set."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

SetKind = Literal["fluid", "boundary", "structure"]


@dataclass(frozen=True)
class SampledSet:
    """The particles of a fluid, boundary or structure at time zero.

    position: (n, dimension) [m]; velocity: (n, dimension) [m/s]; pressure: (n,) [Pa], zero in boundaries;
    volume: of each particle, m^dimension.
    """

    name: str
    kind: SetKind
    position: np.ndarray
    velocity: np.ndarray
    pressure: np.ndarray
    volume: float
