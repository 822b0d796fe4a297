"""The artificial sound speed of a weakly compressible fluid."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from warpsph.sampling import SampledSet
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.schema import Scene

MACH_AT_EXPECTED_SPEED = 0.1
"""Density varies by about the square of this number, one per cent (Monaghan 1994)."""


def expected_speed(scene: Scene, sets: Sequence[SampledSet], wall_speed: float) -> float:
    """Return the largest speed [m/s] that the scene lets expect.

    It adds the largest initial speed of a fluid or a structure, the largest speed of a wall, and the speed
    sqrt(2 g H) of a fall from the highest fluid particle to the lowest particle, or sqrt(2 p / rho) of the initial
    pressure if that is more.
    """
    if scene.numerics.expected_speed is not None:
        return scene.numerics.expected_speed
    gravity = np.asarray(scene.gravity)
    fluids = [s for s in sets if s.kind == "fluid" and len(s.position)]
    height = max((float(np.max(-s.position @ gravity)) for s in fluids), default=0.0)
    depth = min((float(np.min(-s.position @ gravity)) for s in sets if len(s.position)), default=0.0)
    heads = [float(np.max(s.pressure)) / scene.fluids[s.name].density for s in fluids]
    moving = [s for s in sets if s.kind != "boundary" and len(s.position)]
    initial = max((float(np.max(np.linalg.norm(s.velocity, axis=1))) for s in moving), default=0.0)
    falling = math.sqrt(2.0 * max(height - depth, *heads, 0.0)) if fluids else 0.0
    return initial + wall_speed + falling


def choose_sound_speed(scene: Scene, sets: Sequence[SampledSet], wall_speed: float) -> float:
    """Return the sound speed of the scene, or ten times the largest expected speed [m/s].

    Raises:
        SceneError: if nothing in the scene says how fast it will get.
    """
    given = scene.numerics.sound_speed
    if given != "auto":
        return float(given)
    speed = expected_speed(scene, sets, wall_speed)
    if speed <= 0.0:
        raise SceneError(
            [
                Problem(
                    key="numerics.sound_speed",
                    value="auto",
                    message="nothing moves at the start and there is no gravity, so no speed can be expected",
                    allowed="a sound speed in m/s, or numerics.expected_speed",
                )
            ]
        )
    return speed / MACH_AT_EXPECTED_SPEED
