"""Fluids and structures meant to break the coupling: plates in, behind and before water."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from warpsph.scene.schema import Scene
from warpsph.solver.simulation import Simulation
from warpsph.validation.hard.measures import rows
from warpsph.validation.hard.shapes import GRAVITY, box, elastic, tank

DP = 0.02
"""Particle spacing of all of them [m]."""
Body = tuple[Sequence[float], Sequence[float], Mapping[str, Any]]
"""Two corners [m] and what more there is to say of a structure."""


def tank_of_water(
    bodies: Mapping[str, Body],
    width: float = 0.6,
    depth: float = 0.4,
    sound_speed: float = 25.0,
    **changes: Any,
) -> Scene:
    """A closed tank of still water, without the water that bodies displace at the start."""
    shapes = {name: box(low, high) for name, (low, high, _) in bodies.items()}
    water = {"type": "difference", "base": box((0.0, 0.0), (width, depth)), "subtract": list(shapes.values())}
    return Scene(
        name="tank_of_water",
        dimension=2,
        spacing=DP,
        gravity=(0.0, -GRAVITY),
        time={"end": 2.0, "frame_rate": 10.0},
        numerics={"sound_speed": sound_speed},
        fluids={"water": {"shape": water, "density": 1000.0, "pressure": {"type": "hydrostatic"}}},
        boundaries={"tank": tank(width, 3.0 * depth)},
        structures={name: {"shape": shapes[name], **more} for name, (_, _, more) in bodies.items()},
        **changes,
    )


def plate_in_still_water(young: float, density: float = 2000.0) -> Scene:
    """A clamped plate, three particles thick, in a tank with water of equal depth on both sides."""
    foot = {"foot": {"region": box((0.0, -1.0), (1.0, 0.04))}}
    plate = {"material": elastic(density, young), "clamps": foot}
    return tank_of_water({"plate": ((0.28, 0.0), (0.34, 0.2), plate)}, width=0.62, depth=0.3)


def held_back(density: float, young: float, cells: int, depth: float = 0.24, end: float = 0.6) -> Scene:
    """Water on the left of a plate of so many particles, clamped to the floor; the tank is dry behind it."""
    half, thick = 0.4, cells * DP
    plate = box((half, -4 * DP), (half + thick, 2.0 * depth - 4 * DP))
    foot = box((half, -4 * DP), (half + thick, 0.0))
    water = box((0.0, 0.0), (half, depth))
    return Scene(
        name="held_back",
        dimension=2,
        spacing=DP,
        gravity=(0.0, -GRAVITY),
        time={"end": end, "frame_rate": 20.0},
        numerics={"sound_speed": 20.0},
        fluids={"water": {"shape": water, "density": 1000.0, "pressure": {"type": "hydrostatic"}}},
        boundaries={"tank": tank(2 * half + thick, 2.0 * depth, lid=False)},
        structures={
            "plate": {
                "shape": plate,
                "material": elastic(density, young),
                "clamps": {"foot": {"region": foot}},
            }
        },
    )


def jet_at_a_plate(young: float, cells: int, speed: float = 10.0) -> Scene:
    """Water without gravity flies at a plate that is clamped at both ends and closes the tank behind it."""
    plate = box((-cells * DP, -4 * DP), (0.0, 0.6 + 4 * DP))
    ends = {"low": box((-1.0, -1.0), (1.0, 0.0)), "high": box((-1.0, 0.6), (1.0, 1.0))}
    water = {"shape": box((DP, 0.24), (0.5, 0.36)), "density": 1000.0, "velocity": (-speed, 0.0)}
    return Scene(
        name="jet_at_a_plate",
        dimension=2,
        spacing=DP,
        time={"end": 1.0, "frame_rate": 10.0},
        numerics={"sound_speed": 10.0 * speed},
        fluids={"water": water},
        boundaries={"tank": {"shape": box((-0.4, 0.0), (0.6, 0.6)), "side": "outside"}},
        structures={
            "plate": {
                "shape": plate,
                "material": elastic(1100.0, young),
                "clamps": {name: {"region": region} for name, region in ends.items()},
            }
        },
    )


def behind_plate(simulation: Simulation, cells: int) -> int:
    """Count particles of water behind the far surface of the plate of so many particles that a jet strikes."""
    plate, water = rows(simulation, "plate"), rows(simulation, "water")
    back = np.arange(len(plate)).reshape(-1, cells)[:, 0]
    surface = np.interp(water[:, 1], plate[back, 1], plate[back, 0])
    return int((water[:, 0] <= surface).sum())
