"""Parts of hard scenes, as a scene file would have them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

GRAVITY = 9.81
"""[m/s2]"""


def box(low: Iterable[float], high: Iterable[float]) -> dict[str, Any]:
    """A box between two corners [m]."""
    return {"type": "box", "min": tuple(map(float, low)), "max": tuple(map(float, high))}


def elastic(density: float, young: float) -> dict[str, float]:
    """A material of a density [kg/m^3] and Young's modulus [Pa]."""
    return {"density": density, "youngs_modulus": young, "poisson_ratio": 0.3}


def tank(width: float, height: float, *, lid: bool = True) -> dict[str, Any]:
    """A tank from the origin to a width and a height [m], in the plane, with a lid or open at the top."""
    return {
        "shape": box((0.0, 0.0), (width, height)),
        "side": "outside",
        **({} if lid else {"open": ("y_max",)}),
    }
