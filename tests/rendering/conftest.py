"""Runs to draw, written without running them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from warpsph.frame import Frame, SetFrame
from warpsph.output.usd import UsdStore
from warpsph.rendering.cache import RenderedSet
from warpsph.scene import Scene

SPACING = 0.1
FRAME_RATE = 10.0
FRAMES = 3


def lattice(low: list[float], high: list[float]) -> np.ndarray:
    """Cell centres (n, dimension) of a box."""
    axes = [np.arange(a + SPACING / 2, b, SPACING) for a, b in zip(low, high, strict=True)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(low))


def tank_walls(dimension: int) -> np.ndarray:
    """Three layers around the unit square or cube, open at the top."""
    outside = lattice([-0.3] * dimension, [1.3] * (dimension - 1) + [1.0])
    is_inside = np.all((outside > 0.0) & (outside < 1.0), axis=1)
    return outside[~is_inside]


def scene_of(dimension: int) -> Scene:
    """A block of water in a tank."""
    low, half, one = [0.0] * dimension, [0.5] * dimension, [1.0] * dimension
    return Scene.model_validate(
        {
            "name": "block",
            "dimension": dimension,
            "spacing": SPACING,
            "gravity": [0.0] * (dimension - 1) + [-9.81],
            "time": {"end": (FRAMES - 1) / FRAME_RATE, "frame_rate": FRAME_RATE},
            "fluids": {"water": {"shape": {"type": "box", "min": low, "max": half}, "density": 1000.0}},
            "boundaries": {
                "tank": {
                    "shape": {"type": "box", "min": low, "max": one},
                    "side": "outside",
                    "open": ["y_max" if dimension == 2 else "z_max"],
                }
            },
        }
    )


def set_frame(name: str, kind: str, position: np.ndarray, speed: float) -> SetFrame:
    """A set that moves along x; its pressure is 1000 x."""
    count, dimension = position.shape
    velocity = np.zeros((count, dimension))
    velocity[:, 0] = speed
    fields = {"id": np.arange(count), "position": position, "velocity": velocity}
    return SetFrame(
        name, kind, {**fields, "density": np.full(count, 1000.0), "pressure": 1000.0 * position[:, 0]}
    )


@pytest.fixture
def write_run(tmp_path: Path) -> Callable[..., Path]:
    """Write the frames of a block of water that slides along x at 1 m/s, and return the run directory."""

    def write(dimension: int, *, finish: bool = True) -> Path:
        store = UsdStore(tmp_path / "particles.usdc", scene_of(dimension))
        store.open()
        block = lattice([0.0] * dimension, [0.5] * dimension)
        for index in range(FRAMES):
            time = index / FRAME_RATE
            moved = block + np.eye(dimension)[0] * time
            sets = (
                set_frame("water", "fluid", moved, 1.0),
                set_frame("tank", "boundary", tank_walls(dimension), 0.0),
            )
            store.write(Frame(index, time, dimension, SPACING, sets))
        if finish:
            store.close()
        return tmp_path

    return write


@pytest.fixture
def make_scene() -> Callable[[int], Scene]:
    """What makes the scene of the runs, in two or three dimensions."""
    return scene_of


@pytest.fixture
def tank() -> RenderedSet:
    """The walls of the tank in space."""
    return RenderedSet("tank", "boundary", tank_walls(3), SPACING, None)


@pytest.fixture
def block() -> RenderedSet:
    """Water in the tank's corner, as fast as it is far along x."""
    position = lattice([0.0] * 3, [0.5] * 3)
    return RenderedSet("water", "fluid", position, SPACING, position[:, 0])
