"""Small scenes of fluids and structures that several tests run."""

from __future__ import annotations

from typing import Any

from warpsph.scene.schema import Scene

RUBBER = {"density": 1100.0, "youngs_modulus": 1.0e6, "poisson_ratio": 0.3}
GRAVITY = 9.81


def struck_water(dimension: int = 2, precision: str = "single", **changes: Any) -> Scene:
    """A free block of water without gravity that an elastic plate hits flat at 10 m/s; no walls."""
    dp = 0.02
    low, high = (0.0,) * dimension, ((0.4, 0.2) if dimension == 2 else (0.2, 0.2, 0.12))
    plate_low = [0.06] * (dimension - 1) + [high[-1] + dp]
    plate_high = [size - 0.06 for size in high[:-1]] + [high[-1] + 4 * dp]
    numerics = {"sound_speed": 100.0, "precision": precision} | changes.pop("numerics", {})
    plate = {
        "shape": {"type": "box", "min": plate_low, "max": plate_high},
        "material": RUBBER,
        "velocity": (0.0,) * (dimension - 1) + (-10.0,),
    } | changes.pop("plate", {})
    water = {"shape": {"type": "box", "min": low, "max": high}, "density": 1000.0} | changes.pop("water", {})
    return Scene(
        name="struck_water",
        dimension=dimension,
        spacing=dp,
        time={"end": 0.02, "frame_rate": 100.0},
        numerics=numerics,
        fluids={"water": water},
        structures={"plate": plate},
        **changes,
    )


def divided_tank(left: float, right: float, cells: int = 3, dp: float = 0.02, **changes: Any) -> Scene:
    """Water of two depths [m] on the sides of a stiff plate of `cells` particles that is clamped to the floor."""
    half, thickness = 0.2, cells * dp
    far = 2.0 * half + thickness
    depths = {"left": (0.0, half, left), "right": (half + thickness, far, right)}
    bodies = {
        name: {"shape": {"type": "box", "min": (x0, 0.0), "max": (x1, depth)}, "density": 1000.0}
        for name, (x0, x1, depth) in depths.items()
        if depth > 0.0
    }
    steel = {"density": 2000.0, "youngs_modulus": 1.0e8, "poisson_ratio": 0.3}
    foot = {"type": "box", "min": (half, -4 * dp), "max": (half + thickness, 0.0)}
    plate = {
        "shape": {"type": "box", "min": (half, -4 * dp), "max": (half + thickness, 0.4)},
        "material": steel,
        "clamps": {"foot": {"region": foot}},
        "damping": 20.0,
    } | changes.pop("plate", {})
    tank = {
        "shape": {"type": "box", "min": (0.0, 0.0), "max": (far, 0.5)},
        "side": "outside",
        "open": ("y_max",),
    }
    time = {"end": 1.0, "frame_rate": 20.0} | changes.pop("time", {})
    return Scene(
        name="divided_tank",
        dimension=2,
        spacing=dp,
        gravity=(0.0, -GRAVITY),
        time=time,
        numerics={"sound_speed": 25.0} | changes.pop("numerics", {}),
        fluids=bodies,
        boundaries={"tank": tank},
        structures={"plate": plate},
        **changes,
    )
