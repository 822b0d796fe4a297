"""Planes of symmetry: half of a symmetric flow is the half of the whole one, to rounding."""

from typing import Any

import numpy as np
import pytest
from builders import GRAVITY

from warpsph.scene.schema import Scene
from warpsph.solver.simulation import Simulation

H = 0.05


def drop(low: tuple[float, ...], symmetry: dict[str, float], velocity: list[str], **changes: Any) -> Scene:
    """A block of viscous fluid from `low` to 0.4 m along every axis."""
    dimension = len(low)
    fluid = {
        "shape": {"type": "box", "min": low, "max": (0.4,) * dimension},
        "density": 1000.0,
        "velocity": velocity,
        "pressure": {"type": "uniform", "value": 100.0},
    }
    base = {
        "name": "drop",
        "dimension": dimension,
        "spacing": H,
        "time": {"end": 1.0, "frame_rate": 10.0, "max_step": 1e-3},
        "numerics": {
            "sound_speed": 10.0,
            "precision": "double",
            "viscosity": {"type": "artificial", "alpha": 0.1},
        },
        "domain": {"symmetry": symmetry},
        "fluids": {"water": fluid},
    }
    return Scene.model_validate(base | changes)


def state(scene: Scene, time: float) -> dict[str, np.ndarray]:
    sim = Simulation(scene, device="cpu")
    sim.advance(time)
    return dict(sim.frame(["velocity", "density", "pressure"]).sets[0].fields)


def sorted_by_place(fields: dict[str, np.ndarray]) -> np.ndarray:
    columns = np.column_stack([fields["position"], fields["velocity"], fields["density"], fields["pressure"]])
    return columns[np.lexsort(np.round(columns[:, : fields["position"].shape[1]], 6).T)]


@pytest.mark.parametrize(
    ("dimension", "symmetry", "velocity"),
    [
        (2, {"x_min": 0.0}, ["-x", "0.5*y + x*x"]),
        (2, {"x_min": 0.0, "y_min": 0.0}, ["-x", "y"]),
        (3, {"x_min": 0.0, "z_min": 0.0}, ["-x", "0.2*y + x*x", "z"]),
    ],
)
def test_a_part_moves_as_it_does_in_the_whole(dimension, symmetry, velocity):
    """With two planes the corner has a third image. Sums run in another order, so doubles agree to rounding only."""
    mirrored = ["xyz".index(face[0]) for face in symmetry]
    low_part = tuple(0.0 if k in mirrored else -0.2 for k in range(dimension))
    low_whole = tuple(-0.4 if k in mirrored else -0.2 for k in range(dimension))
    part = state(drop(low_part, symmetry, velocity), 0.03)
    whole = state(drop(low_whole, {}, velocity), 0.03)
    inside = np.all(whole["position"][:, mirrored] > 0.0, axis=1)
    own = {name: values[inside] for name, values in whole.items()}
    assert sorted_by_place(part) == pytest.approx(sorted_by_place(own), rel=1e-9, abs=1e-9)


def test_a_plane_at_the_high_end_mirrors_too():
    left = state(drop((-0.2, -0.2), {"x_max": 0.4}, ["0.1*y", "-0.2*x"]), 0.02)
    scene = drop((-0.2, -0.2), {"x_min": -0.4}, ["-0.1*y", "0.2*x"])
    shape = {"type": "box", "min": (-0.4, -0.2), "max": (0.2, 0.4)}
    water = scene.fluids["water"].model_dump() | {"shape": shape}
    right = state(scene.model_validate(scene.model_dump() | {"fluids": {"water": water}}), 0.02)
    turned = {name: values * ([-1.0, 1.0] if values.ndim == 2 else 1.0) for name, values in left.items()}
    assert sorted_by_place(turned) == pytest.approx(sorted_by_place(right), rel=1e-9, abs=1e-9)


def test_fluid_that_hits_the_plane_does_not_pass():
    """A block that hits its mirror image spreads along the plane; the plane takes no momentum along itself."""
    scene = drop((0.1, -0.2), {"x_min": 0.0}, ["-2.0", "0.3"])
    after = state(scene, 0.2)
    assert after["position"][:, 0].min() > 0.0
    assert np.ptp(after["position"][:, 1]) > 0.7
    assert after["velocity"][:, 1].mean() == pytest.approx(0.3, rel=1e-9)


def tank(low: float, wall_low: float, symmetry: dict[str, float]) -> Scene:
    """Water in a tank of which the left half may be left out; the floor goes on beyond the plane."""
    water = {"shape": {"type": "box", "min": (low, 0.0), "max": (0.5, 0.4)}, "density": 1000.0}
    wall = {"shape": {"type": "box", "min": (wall_low, 0.0), "max": (0.5, 0.6)}, "side": "outside"}
    return Scene.model_validate(
        {
            "name": "tank",
            "dimension": 2,
            "spacing": H,
            "gravity": (0.0, -GRAVITY),
            "time": {"end": 1.0, "frame_rate": 10.0},
            "domain": {"symmetry": symmetry},
            "fluids": {"water": water},
            "boundaries": {"tank": wall | {"open": ("y_max", "x_min") if symmetry else ("y_max",)}},
        }
    )


def test_still_water_stays_still_at_a_plane():
    """The kinetic energy stays below 1e-4 of rho g H^2 B / 2, the gate of the hydrostatic tanks."""
    fields = state(tank(0.0, -0.3, {"x_min": 0.0}), 1.0)
    energy = 0.5 * 1000.0 * H**2 * np.sum(fields["velocity"] ** 2)
    assert energy < 1e-4 * 0.5 * 1000.0 * GRAVITY * 0.4**2 * 0.5
    depth = 0.4 - fields["position"][:, 1]
    assert fields["pressure"] == pytest.approx(1000.0 * GRAVITY * depth, abs=0.03 * 1000.0 * GRAVITY * 0.4)


@pytest.mark.parametrize(
    ("symmetry", "message"),
    [
        ({"z_min": 0.0}, "domain.symmetry.z_min"),
        ({"x_min": 0.1}, "beyond the plane"),
        ({"x_max": 0.4, "x_min": 0.3}, "too close to x_min"),
    ],
)
def test_planes_that_mean_nothing_are_refused(symmetry, message):
    with pytest.raises(ValueError, match=message):
        drop((0.0, 0.0), symmetry, ["0", "0"])


def test_models_that_need_more_of_an_image_than_it_carries_are_refused():
    base = tank(0.0, -0.3, {"x_min": 0.0}).model_dump()
    with pytest.raises(ValueError, match=r"numerics\.wall: at planes of symmetry"):
        Scene.model_validate(base | {"numerics": {"wall": {"type": "modified_dynamic"}}})
