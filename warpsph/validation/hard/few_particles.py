"""Hard cases of two particles, of one and of none."""

from __future__ import annotations

from typing import Any

import numpy as np

from warpsph.scene.schema import Scene
from warpsph.validation.hard.case import Figure, Machine
from warpsph.validation.hard.shapes import GRAVITY, box, elastic

DP, END = 0.1, 0.5
WATER = {"density": 1000.0, "pressure": {"type": "uniform", "value": 0.0}}
RUBBER = elastic(1000.0, 1.0e6)


def row(kind: str, dimension: int, count: int, velocity: float | str = 0.0, **changes: Any) -> Scene:
    """So many particles along x, whose velocity [m/s] along it is a number or an expression; gravity acts downwards."""
    shape = box((0.0,) * dimension, (count * DP, *(DP,) * (dimension - 1)))
    body = {"shape": shape, "velocity": (velocity, *(0.0,) * (dimension - 1))}
    what: dict[str, Any] = {"fluids": {"body": body | WATER}}
    if kind == "structure":
        what = {"structures": {"body": body | {"material": RUBBER}}}
    base = {
        "name": "row",
        "dimension": dimension,
        "spacing": DP,
        "gravity": (*(0.0,) * (dimension - 1), -GRAVITY),
        "time": {"end": END, "frame_rate": 10.0},
        "numerics": {"precision": "double", "sound_speed": 40.0},
    }
    return Scene(**(base | what | changes))


def two_particles_and_one_fall(machine: Machine) -> list[Figure]:
    """A single particle and a pair, of fluid and of structure, in the plane and in space, fall like a stone.

    Both steps are exact under a uniform acceleration, so that only some hundred roundings remain.
    """
    errors = [
        _error_of_fall(machine, row(kind, dimension, count))
        for kind in ("fluid", "structure")
        for dimension in (2, 3)
        for count in (1, 2)
    ]
    return [Figure("error of the way", max(errors), 1e-13)]


def _error_of_fall(machine: Machine, scene: Scene) -> float:
    simulation = machine.simulate(scene)
    (before,) = simulation.frame(()).sets
    simulation.advance(END)
    (after,) = simulation.frame(()).sets
    way = (after.fields["position"] - before.fields["position"]) / (-0.5 * GRAVITY * END**2)
    way[:, -1] -= 1.0
    return float(np.abs(way).max())


def no_particle_is_left(machine: Machine) -> list[Figure]:
    """All of the fluid leaves through the kill box; the run goes on without it."""
    kill = {"kill_box": {"min": (-1.0, -1.0), "max": (0.6, 0.6)}}
    wall = {"shape": box((-0.4, -0.4), (0.4, 0.0)), "side": "solid"}
    scene = row("fluid", 2, 3, velocity=5.0, domain=kill, boundaries={"wall": wall})
    simulation = machine.simulate(scene)
    simulation.advance(END)
    left = sum(len(fluid.fields["position"]) for fluid in simulation.frame(()).of_kind("fluid"))
    return [
        Figure("particles of fluid left", left, 0.0),
        Figure("simulated time", simulation.time, END, "s", at_least=True),
    ]


CASES = (two_particles_and_one_fall, no_particle_is_left)
