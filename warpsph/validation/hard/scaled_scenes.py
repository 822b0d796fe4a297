"""A scene in units of other lengths, times and masses, which is the same scene: no number of the scheme has a unit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Literal

import numpy as np

from warpsph.physics.material import smoothing_length
from warpsph.scene.schema import Scene
from warpsph.validation.hard.case import Machine
from warpsph.validation.hard.shapes import GRAVITY, box

Kind = Literal["fluid", "structure", "coupled"]
Fields = Mapping[tuple[str, str], np.ndarray]
"""Values by the names of a set and of a field."""

DP, END, MAX_STEP = 0.05, 0.01, 5.0e-4
"""Spacing, end of the run and longest step, before they are scaled. Beside structures steps are rounded down to a power
of 1.05 in seconds, and then so that equal ones land on the end."""
DENSITY, SOUND_SPEED = 1000.0, 30.0
"""Of the water [1]; the sound speed, which the scene chooses itself, is about that, and that of the plate 20."""


@dataclass(frozen=True)
class Units:
    """Units of length [m], time [s] and mass [kg]."""

    length: float = 1.0
    time: float = 1.0
    mass: float = 1.0


def at_scale(length: float, dimension: int) -> Units:
    """Units in which the same material moves at the same speeds at another scale [m]."""
    return Units(length, length, length**dimension)


def basin(kind: Kind, dimension: int, precision: str, units: Units | None = None) -> Scene:
    """Water, 0.3 deep, that moves towards a plate clamped to the floor, or the plate alone, in some units."""
    unit = units or Units()
    length, time = unit.length, unit.time
    density, speed, across = DENSITY * unit.mass / length**dimension, length / time, (0.6,) * (dimension - 2)
    still, up = (0.0,) * (dimension - 1), "y_max" if dimension == 2 else "z_max"

    def scaled(low: tuple[float, float], high: tuple[float, float]) -> dict[str, object]:
        ends = (low[0], *(0.0 for _ in across), low[1]), (high[0], *across, high[1])
        return box(*(tuple(length * x for x in end) for end in ends))

    water = {
        "shape": scaled((0.0, 0.0), (0.35, 0.3)),
        "density": density,
        "kinematic_viscosity": 1.0e-3 * length * speed,
        "pressure": {"type": "hydrostatic"},
        "velocity": (0.3 * speed, *still),
    }
    rubber = {"density": 1.1 * density, "youngs_modulus": 400.0 * density * speed**2, "poisson_ratio": 0.3}
    plate = {
        "shape": scaled((0.35, -0.2), (0.55, 0.4)),
        "material": rubber,
        "clamps": {"foot": {"region": scaled((0.35, -0.2), (0.55, 0.0))}},
        "damping": 1.0 / time,
    }
    walls = {"shape": scaled((0.0, 0.0), (0.9, 0.6)), "side": "outside", "open": (up,)}
    return Scene(
        name="basin",
        dimension=dimension,
        spacing=DP * length,
        gravity=(*still, -GRAVITY * length / time**2),
        time={"end": END * time, "frame_rate": 100.0 / time, "max_step": MAX_STEP * time},
        numerics={"precision": precision},
        fluids={} if kind == "structure" else {"water": water},
        boundaries={} if kind == "structure" else {"tank": walls},
        structures={} if kind == "fluid" else {"plate": plate},
    )


def end_fields(scene: Scene, machine: Machine, units: Units | None = None) -> Fields:
    """Positions, velocities, densities and pressures at the end, in the units of the scene before it was scaled."""
    length, time, mass = asdict(units or Units()).values()
    simulation = machine.simulate(scene)
    simulation.advance(scene.time.end)
    dimension = scene.dimension
    scale = {"position": length, "velocity": length / time}
    if scene.fluids:
        scale |= {"density": mass / length**dimension, "pressure": mass / length ** (dimension - 2) / time**2}
    return {
        (one.name, name): np.asarray(one.fields[name], dtype=np.float64) / unit
        for one in simulation.frame(list(scale)).sets
        for name, unit in scale.items()
        if name in one.fields
    }


def rounding(found: Fields, expected: Fields, scene: Scene) -> float:
    """By how much the fields of a scene and of a scaled one differ at most, in units of what rounding explains.

    The factors round every number of the scene, so that it is that of a run in other axes (see `random_scenes`).
    Beside clamps there is more to it: the way to their surface is found by differences over a thousandth of a spacing.
    """
    eps = np.finfo(np.float32 if scene.numerics.precision == "single" else np.float64).eps
    if scene.structures:
        eps = max(eps, 1.0e3 * np.finfo(np.float64).eps)
    speed = END / MAX_STEP * eps / smoothing_length(scene) * SOUND_SPEED
    scales = {
        "position": END * speed,
        "velocity": speed,
        "density": DENSITY * speed / SOUND_SPEED,
        "pressure": DENSITY * speed * SOUND_SPEED,
    }
    return max(float(np.abs(found[key] - expected[key]).max() / scales[key[1]]) for key in expected)
