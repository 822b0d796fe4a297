"""Small scenes that several tests run."""

from __future__ import annotations

from typing import Any

from warpsph.scene.schema import Scene

GRAVITY = 9.81


def still_tank(dimension: int = 2, spacing: float = 0.05, depth: float = 0.5, **changes: Any) -> Scene:
    """Water at rest in a tank, 0.5 m wide, under its hydrostatic pressure."""
    width = (0.5,) * (dimension - 1)
    low = (0.0,) * dimension
    up = "y_max" if dimension == 2 else "z_max"
    return _scene(
        changes,
        name="still_tank",
        dimension=dimension,
        spacing=spacing,
        gravity=(*(0.0,) * (dimension - 1), -GRAVITY),
        fluids={"water": {"shape": {"type": "box", "min": low, "max": (*width, depth)}, "density": 1000.0}},
        boundaries={
            "tank": {
                "shape": {"type": "box", "min": low, "max": (*width, depth + 0.25)},
                "side": "outside",
                "open": (up,),
            }
        },
    )


def free_drop(dimension: int = 2, spacing: float = 0.1, **changes: Any) -> Scene:
    """A square drop without gravity or walls that its initial velocity stretches along x."""
    spread = ["0.5 * (x - 0.5)", "-0.5 * (y - 0.5)", "0.0 * z"][:dimension]
    shape = {"type": "box", "min": (0.0,) * dimension, "max": (1.0,) * dimension}
    fluid = {
        "shape": shape,
        "density": 1000.0,
        "kinematic_viscosity": 0.01,
        "velocity": spread,
        "pressure": {"type": "uniform", "value": 0.0},
    }
    return _scene(
        changes,
        name="free_drop",
        dimension=dimension,
        spacing=spacing,
        fluids={"water": fluid},
        sound_speed=10.0,
    )


def _scene(changes: dict[str, Any], **base: Any) -> Scene:
    numerics = {"sound_speed": base.pop("sound_speed", "auto")} | changes.pop("numerics", {})
    time = {"end": 1.0, "frame_rate": 20.0} | changes.pop("time", {})
    return Scene(**(base | {"numerics": numerics, "time": time} | changes))
