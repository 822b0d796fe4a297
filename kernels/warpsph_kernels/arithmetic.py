"""Number and vector types of a run, and the conversions between what is stored and what is computed with.

Positions are integrated in double precision and everything else in the precision of the scene. Pair loops read
packed records: a vector and one scalar side by side, because a pair always needs both.
"""

from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import warp as wp

PARAMETERS = 4
"""Numbers that a formula may take from the scene."""

PRECISIONS = {"single": wp.float32, "double": wp.float64}


@dataclass(frozen=True)
class Arithmetic:
    """Types that a kernel is specialised for: the dimension (2 or 3) and the precision (single or double)."""

    dimension: int
    precision: str

    @property
    def real(self) -> Any:
        """Scalar of the pair loops."""
        return PRECISIONS[self.precision]

    @cached_property
    def vector(self) -> Any:
        """A vector of the pair loops, `dimension` components."""
        return wp.types.vector(self.dimension, self.real)

    @cached_property
    def record(self) -> Any:
        """A vector with one scalar behind it, read together by the pair loops."""
        return wp.types.vector(self.dimension + 1, self.real)

    @cached_property
    def matrix(self) -> Any:
        """A tensor of the pair loops, `dimension` rows and columns."""
        return wp.types.matrix((self.dimension, self.dimension), self.real)

    @cached_property
    def parameters(self) -> Any:
        """The numbers that a formula takes from the scene, with zeros behind them."""
        return wp.types.vector(PARAMETERS, self.real)

    @cached_property
    def point(self) -> Any:
        """A position, always in double precision."""
        return wp.types.vector(self.dimension, wp.float64)

    @cached_property
    def integers(self) -> Any:
        """Integer coordinates of a grid cell."""
        return wp.types.vector(self.dimension, wp.int32)

    @property
    def label(self) -> str:
        return f"{self.dimension}d_{self.precision}"


@cache
def make_packing(arithmetic: Arithmetic) -> tuple[Any, Any]:
    """Return the device functions `pack(vector, scalar) -> record` and `unpack(record) -> vector`."""
    dim = arithmetic.dimension
    real, vector, record = arithmetic.real, arithmetic.vector, arithmetic.record

    def pack(v: vector, s: real):
        out = record()
        for k in range(wp.static(dim)):
            out[k] = v[k]
        out[wp.static(dim)] = s
        return out

    def unpack(r: record):
        out = vector()
        for k in range(wp.static(dim)):
            out[k] = r[k]
        return out

    return wp.func(pack), wp.func(unpack)


@cache
def make_narrow(arithmetic: Arithmetic) -> Any:
    """Return the device function `narrow(point, origin) -> vector`: a position relative to the run's origin.

    The subtraction happens in double precision, so that a scene far from zero loses nothing.
    """
    dim = arithmetic.dimension
    real, vector, point = arithmetic.real, arithmetic.vector, arithmetic.point

    def narrow(x: point, origin: point):
        out = vector()
        for k in range(wp.static(dim)):
            out[k] = real(x[k] - origin[k])
        return out

    return wp.func(narrow)


@cache
def make_widen(arithmetic: Arithmetic) -> Any:
    """Return the device function `widen(vector) -> point`: a vector in double precision."""
    dim = arithmetic.dimension
    vector, point = arithmetic.vector, arithmetic.point

    def widen(v: vector):
        out = point()
        for k in range(wp.static(dim)):
            out[k] = wp.float64(v[k])
        return out

    return wp.func(widen)


@cache
def make_separation(arithmetic: Arithmetic, periodic: tuple[bool, ...]) -> Any:
    """Return the device function `separation(x_a, x_b, period) -> vector`, x_a - x_b to the nearest image.

    `periodic` holds one flag an axis. Axes that are not periodic cost nothing.
    """
    dim = arithmetic.dimension
    vector = arithmetic.vector

    def separation(x_a: vector, x_b: vector, period: vector):
        x_ab = x_a - x_b
        for k in range(wp.static(dim)):
            if wp.static(periodic[k]):
                x_ab[k] = x_ab[k] - period[k] * wp.rint(x_ab[k] / period[k])
        return x_ab

    return wp.func(separation)
