"""Scenes and frames for the writers."""

import numpy as np

from warpsph.frame import Frame, SetFrame
from warpsph.scene.schema import Scene

FRAME_RATE = 50.0
SPACING = 0.1


def tank_scene(dimension: int, **output: object) -> Scene:
    """A block of water in a fixed tank, beside a wall that slides."""
    one, two = [1.0] * dimension, [2.0] * dimension
    origin = [0.0] * dimension
    far = [5.0] * dimension
    gravity = [0.0] * (dimension - 1) + [-9.81]
    slide = {"type": "linear", "velocity": one}
    return Scene.model_validate(
        {
            "name": "tank_scene",
            "dimension": dimension,
            "spacing": SPACING,
            "gravity": gravity,
            "time": {"end": 1.0, "frame_rate": FRAME_RATE},
            "fluids": {"water": {"shape": {"type": "box", "min": origin, "max": one}, "density": 1000.0}},
            "boundaries": {
                "tank": {"shape": {"type": "box", "min": origin, "max": two}, "side": "outside"},
                "paddle": {
                    "shape": {"type": "box", "min": [4.0] * dimension, "max": far},
                    "side": "solid",
                    "motion": [slide],
                },
            },
            "output": output,
        }
    )


def particle_set(name: str, kind: str, count: int, dimension: int, seed: int) -> SetFrame:
    """Random particles with every field that a simulation hands out."""
    random = np.random.default_rng(seed)
    return SetFrame(
        name,
        kind,
        {
            "id": np.arange(count, dtype=np.int64) + 1000,
            "position": random.normal(size=(count, dimension)),
            "velocity": random.normal(size=(count, dimension)).astype(np.float32),
            "density": random.normal(1000.0, 1.0, count),
            "pressure": random.normal(size=count).astype(np.float32),
            "mass": np.ones(count),
        },
    )


def frame_of(scene: Scene, index: int, fluid_count: int = 40) -> Frame:
    """Frame of a run whose fluid and paddle move while the tank stands still; the same for the same index."""
    dimension = scene.dimension
    sets = (
        particle_set("water", "fluid", fluid_count, dimension, seed=index),
        particle_set("tank", "boundary", 25, dimension, seed=999),
        particle_set("paddle", "boundary", 10, dimension, seed=500 + index),
    )
    return Frame(index, index / FRAME_RATE, dimension, SPACING, sets)
