"""Scenes of channels and pipes between open boundaries."""

from __future__ import annotations

from typing import Any

import numpy as np

from warpsph.scene import Scene

DP = 0.1


def channel(
    *,
    inlet: dict[str, Any] | None = None,
    outlet: dict[str, Any] | None = None,
    velocity: tuple[float, ...] = (1.0, 0.0),
    angle: float = 0.0,
    on_axes: bool = False,
    **changes: Any,
) -> Scene:
    """A plane channel of 2 m by 1 m, free-slip, with the inlet at x = 0; turned as a whole by `angle` [degrees] about
    the origin, where the fluid inside stands `on_axes` or on a lattice that is turned with it, as in the buffers."""
    turn = _rotation(angle)

    def patch(x: float, into: float) -> dict[str, Any]:
        center = turn @ np.array([x, 0.5])
        return {"center": tuple(center), "normal": tuple(turn @ (into, 0.0)), "width": 1.0}

    def placed(shape: dict[str, Any]) -> dict[str, Any]:
        return shape if angle == 0.0 else {"type": "transform", "shape": shape, "rotate": {"angle": angle}}

    long = 1.5

    def plate(low: float, high: float) -> dict[str, Any]:
        return {"type": "box", "min": (-long, low), "max": (2.0 + long, high)}

    data: dict[str, Any] = {
        "name": "channel",
        "dimension": 2,
        "spacing": DP,
        "time": {"end": 4.0, "frame_rate": 10.0},
        "numerics": {"sound_speed": 20.0, "wall": {"type": "extrapolated", "suction": True}},
        "fluids": {
            "water": {
                "shape": placed({"type": "box", "min": (0.0, 0.0), "max": (2.0, 1.0)}),
                "density": 1000.0,
                "velocity": tuple(turn @ np.array(velocity)),
                "pressure": {"type": "uniform", "value": 0.0},
            }
        },
        "boundaries": {
            "plates": {
                "shape": placed({"type": "union", "shapes": (plate(-0.4, 0.0), plate(1.0, 1.4))}),
                "side": "solid",
            }
        },
        "open_boundaries": {
            "inlet": {
                "shape": patch(0.0, 1.0),
                **(inlet or {"type": "velocity", "velocity": {"type": "uniform", "speed": 1.0}}),
            },
            "outlet": {"shape": patch(2.0, -1.0), **(outlet or {"type": "pressure", "pressure": 0.0})},
        },
    }
    if on_axes:
        corners = np.array([(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)]) @ turn.T
        shape = {"type": "polygon", "points": tuple(map(tuple, corners))}
        data["fluids"]["water"] |= {"shape": shape, "placement": "relaxed"}
    return Scene.model_validate(data | changes)


def pipe(*, is_round: bool = False, outlet: dict[str, Any] | None = None, **changes: Any) -> Scene:
    """A duct of 0.8 m by 0.8 m, or a pipe of that diameter, 1 m long along x, free-slip."""
    extent = {"radius": 0.4} if is_round else {"size": (0.8, 0.8)}
    if is_round:
        core = {"type": "cylinder", "start": (0.0, 0.0, 0.0), "end": (1.0, 0.0, 0.0), "radius": 0.4}
        wall = {"type": "cylinder", "start": (-0.8, 0.0, 0.0), "end": (1.8, 0.0, 0.0), "radius": 0.4}
        tube = {"type": "cylinder", "start": (-0.8, 0.0, 0.0), "end": (1.8, 0.0, 0.0), "radius": 0.8}
        sides = {
            "shape": {"type": "difference", "base": tube, "subtract": (_longer(wall),)},
            "side": "solid",
            "placement": "lattice",
        }
    else:
        core = {"type": "box", "min": (0.0, -0.4, -0.4), "max": (1.0, 0.4, 0.4)}
        wall = {"type": "box", "min": (-0.8, -0.4, -0.4), "max": (1.8, 0.4, 0.4)}
        sides = {"shape": wall, "side": "outside", "open": ("x_min", "x_max")}
    data: dict[str, Any] = {
        "name": "pipe",
        "dimension": 3,
        "spacing": DP,
        "time": {"end": 1.0, "frame_rate": 10.0},
        "numerics": {"sound_speed": 20.0, "wall": {"type": "extrapolated", "suction": True}},
        "fluids": {
            "water": {
                "shape": core,
                "density": 1000.0,
                "velocity": (1.0, 0.0, 0.0),
                "pressure": {"type": "uniform", "value": 0.0},
            }
        },
        "boundaries": {"sides": sides},
        "open_boundaries": {
            "inlet": {
                "type": "velocity",
                "shape": {"center": (0.0, 0.0, 0.0), "normal": (1.0, 0.0, 0.0), **extent},
                "velocity": {"type": "uniform", "speed": 1.0},
            },
            "outlet": {
                "shape": {"center": (1.0, 0.0, 0.0), "normal": (-1.0, 0.0, 0.0), **extent},
                **(outlet or {"type": "pressure", "pressure": 0.0}),
            },
        },
    }
    return Scene.model_validate(data | changes)


def _longer(cylinder: dict[str, Any]) -> dict[str, Any]:
    return cylinder | {"start": (-1.0, 0.0, 0.0), "end": (2.0, 0.0, 0.0)}


def _rotation(degrees: float) -> np.ndarray:
    angle = np.deg2rad(degrees)
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def stream(*, speed: float = 0.5, dimension: int = 2, **changes: Any) -> Scene:
    """Water 1 m deep and 2 m long, with a free surface, over a level bed, between open boundaries that hold its level;
    in three dimensions 0.4 m wide, between walls. Without `speed` both ends hold the level alone."""
    flat = () if dimension == 2 else (0.2,)
    shape = {"width": 1.5} if dimension == 2 else {"size": (1.5, 0.4), "along": (0.0, 1.0, 0.0)}
    zero = (0.0,) * (dimension - 2)

    def end(x: float, into: float, **law: Any) -> dict[str, Any]:
        return {
            "shape": {"center": (x, 0.75, *zero), "normal": (into, 0.0, *zero), **shape},
            "level": 1.0,
            **law,
        }

    driven = {"type": "velocity", "velocity": {"type": "uniform", "speed": speed}}
    sides = ("x_min", "x_max", "y_max")
    tank = {"type": "box", "min": (-1.5, 0.0, *(-w for w in flat)), "max": (3.5, 1.5, *flat)}
    water = {"type": "box", "min": (0.0, 0.0, *(-w for w in flat)), "max": (2.0, 1.0, *flat)}
    data: dict[str, Any] = {
        "name": "stream",
        "dimension": dimension,
        "spacing": DP,
        "gravity": (0.0, -9.81, *zero),
        "time": {"end": 5.0, "frame_rate": 10.0},
        "numerics": {"sound_speed": 30.0},
        "fluids": {"water": {"shape": water, "density": 1000.0, "velocity": (speed, 0.0, *zero)}},
        "boundaries": {"tank": {"shape": tank, "side": "outside", "open": sides}},
        "open_boundaries": {
            "inlet": end(0.0, 1.0, **(driven if speed else {"type": "pressure"})),
            "outlet": end(2.0, -1.0, type="pressure"),
        },
    }
    return Scene.model_validate(data | changes)
