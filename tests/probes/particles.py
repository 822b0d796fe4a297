"""Scenes and lattices of particles from which the tests of the probes build their frames."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from warpsph.frame import Frame, SetFrame
from warpsph.probes import Probe, make_probe
from warpsph.scene.schema import Scene

SPACING = 0.1
DENSITY = 1000.0
GRAVITY = 9.81


def scene_with(probe: dict[str, Any], dimension: int = 2, **changes: Any) -> Scene:
    """A tank of water 4 m wide with walls of three layers, and one probe."""
    one, origin = [1.0] * dimension, [0.0] * dimension
    tank = {"shape": {"type": "box", "min": origin, "max": [4.0] * dimension}, "side": "outside"}
    scene = {
        "name": "tank",
        "dimension": dimension,
        "spacing": SPACING,
        "gravity": [0.0] * (dimension - 1) + [-GRAVITY],
        "time": {"end": 1.0, "frame_rate": 10.0},
        "fluids": {"water": {"shape": {"type": "box", "min": origin, "max": one}, "density": DENSITY}},
        "boundaries": {"tank": tank},
        "probes": {"probe": probe},
    }
    return Scene.model_validate(scene | changes)


def probe_of(scene: Scene) -> Probe:
    """The scene's one probe."""
    return make_probe("probe", scene.probes["probe"], scene)


def lattice(low: Sequence[float], high: Sequence[float], spacing: float = SPACING) -> np.ndarray:
    """Centres of the cells of a box (n, dimension)."""
    axes = [a + spacing * (np.arange(round((b - a) / spacing)) + 0.5) for a, b in zip(low, high, strict=True)]
    return np.stack([x.ravel() for x in np.meshgrid(*axes, indexing="ij")], axis=1)


def tank_walls(low: Sequence[float], high: Sequence[float], spacing: float = SPACING) -> np.ndarray:
    """Three layers of particles around a box without its top."""
    thickness = 3 * spacing
    outer_low = [x - thickness for x in low]
    outer_high = [*(x + thickness for x in high[:-1]), high[-1]]
    cells = lattice(outer_low, outer_high, spacing)
    inside = np.all((cells > np.array(low)) & (cells < np.array(high)), axis=1)
    return cells[~inside]


def fluid(position: np.ndarray, spacing: float = SPACING, **fields: np.ndarray) -> SetFrame:
    """Water at rest and at its reference density, unless fields say otherwise."""
    n, dimension = position.shape
    given = {
        "id": np.arange(n),
        "position": position,
        "velocity": np.zeros((n, dimension)),
        "density": np.full(n, DENSITY),
        "pressure": np.zeros(n),
        "mass": np.full(n, DENSITY * spacing**dimension),
    }
    return SetFrame("water", "fluid", given | fields)


def wall(position: np.ndarray, spacing: float = SPACING, **fields: np.ndarray) -> SetFrame:
    """Particles of the wall `tank`."""
    n, dimension = position.shape
    given = {
        "id": np.arange(n) + 100_000,
        "position": position,
        "pressure": np.zeros(n),
        "volume": np.full(n, spacing**dimension),
        "force": np.zeros((n, dimension)),
    }
    return SetFrame("tank", "boundary", given | fields)


def frame_of(*sets: SetFrame, spacing: float = SPACING) -> Frame:
    """A frame of these sets."""
    return Frame(0, 0.0, sets[0].fields["position"].shape[1], spacing, sets)


def disordered(position: np.ndarray, fraction: float = 0.2, seed: int = 0) -> np.ndarray:
    """Particles moved at random by up to a fraction of the spacing."""
    shift = np.random.default_rng(seed).uniform(-fraction, fraction, position.shape)
    return position + SPACING * shift


def linear(gradient: Sequence[float], value: float) -> Callable[[np.ndarray], np.ndarray]:
    """A linear field of positions (n, dimension)."""
    return lambda position: value + position @ np.array(gradient)
