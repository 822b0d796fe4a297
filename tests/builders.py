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


GAP, VISCOSITY = 1.0e-3, 1.0e-6
"""Distance of the channel's plates [m] and kinematic viscosity [m^2/s] of Morris, Fox & Zhu (1997)."""


def channel(
    particles_across: int = 20,
    drive: float = 0.0,
    lid_speed: float = 0.0,
    slip: str = "no_slip",
    **changes: Any,
) -> Scene:
    """Fluid between two plates, periodic along x, driven by a body force [m/s^2] or by the upper plate [m/s]."""
    spacing = GAP / particles_across
    length = 12 * spacing
    thickness = 6 * spacing
    lid_motion = [{"type": "linear", "velocity": (lid_speed, 0.0)}] if lid_speed else []

    def plate(low: float, high: float) -> dict[str, Any]:
        return {
            "shape": {"type": "box", "min": (0.0, low), "max": (length, high)},
            "side": "solid",
            "slip": slip,
        }

    fluid = {
        "shape": {"type": "box", "min": (0.0, 0.0), "max": (length, GAP)},
        "density": 1000.0,
        "kinematic_viscosity": VISCOSITY,
        "pressure": {"type": "uniform", "value": 0.0},
    }
    return _scene(
        changes,
        name="channel",
        dimension=2,
        spacing=spacing,
        gravity=(drive, 0.0),
        domain={"periodic": {"x": (0.0, length)}},
        fluids={"water": fluid},
        boundaries={
            "floor": plate(-thickness, 0.0),
            "lid": plate(GAP, GAP + thickness) | {"motion": lid_motion},
        },
        sound_speed=2.5e-4,
    )


def closed_vessel(
    velocity: tuple[float, float] = (0.0, 0.0),
    filling: float = 1.0,
    motion: list[dict[str, Any]] | None = None,
    gravity: tuple[float, float] = (0.0, 0.0),
    **changes: Any,
) -> Scene:
    """A box of 1 m x 0.5 m, closed on all sides, filled to a part of its height."""
    water = {
        "shape": {"type": "box", "min": (0.0, 0.0), "max": (1.0, 0.5 * filling)},
        "density": 1000.0,
        "velocity": velocity,
    }
    vessel = {
        "shape": {"type": "box", "min": (0.0, 0.0), "max": (1.0, 0.5)},
        "side": "outside",
        "motion": motion or [],
    }
    return _scene(
        changes,
        name="closed_vessel",
        dimension=2,
        spacing=0.025,
        gravity=gravity,
        fluids={"water": water},
        boundaries={"vessel": vessel},
        sound_speed=30.0,
    )
