"""The age of fluid between open boundaries is the time since it came in."""

import numpy as np
import pytest

from warpsph.scene.schema import Scene
from warpsph.solver.simulation import Simulation

SPEED, LENGTH = 0.5, 1.0


def stream(**output) -> Scene:
    """A uniform stream between free-slip plates from an inlet to an outlet."""
    along = [{"center": [x, 0.2], "normal": [n, 0.0], "width": 0.4} for x, n in ((0.0, 1.0), (LENGTH, -1.0))]
    return Scene(
        name="stream",
        dimension=2,
        spacing=0.05,
        time={"end": 2.0, "frame_rate": 10.0},
        numerics={"sound_speed": 10.0},
        fluids={
            "water": {
                "shape": {"type": "box", "min": [0.0, 0.0], "max": [LENGTH, 0.4]},
                "density": 1000.0,
                "velocity": [SPEED, 0.0],
                "pressure": {"type": "uniform", "value": 0.0},
            }
        },
        boundaries={
            "plates": {
                "shape": {"type": "box", "min": [-1.0, 0.0], "max": [2.0, 0.4]},
                "side": "outside",
                "open": ["x_min", "x_max"],
            }
        },
        open_boundaries={
            "inlet": {
                "type": "velocity",
                "shape": along[0],
                "velocity": {"type": "uniform", "speed": SPEED},
            },
            "outlet": {"type": "pressure", "shape": along[1], "pressure": 0.0},
        },
        output={"fields": ["velocity", "age"]} | output,
    )


def ages(sim: Simulation) -> tuple[np.ndarray, np.ndarray]:
    water = sim.frame(["age"]).set_named("water").fields
    return water["position"][:, 0], water["age"]


def test_age_is_the_way_from_the_inlet_over_the_speed():
    """After one and a half flow-throughs all fluid has come in, which is noticed up to half a skin late."""
    scene = stream()
    sim = Simulation(scene, device="cpu")
    sim.advance(1.5 * LENGTH / SPEED)
    x, age = ages(sim)
    inside = (x > 0.0) & (x < LENGTH)
    late = scene.numerics.list_skin * scene.support_radius / SPEED
    np.testing.assert_allclose(age[inside], x[inside] / SPEED, atol=late)
    assert not age[x < -0.01 * scene.spacing].any()
    assert age.max() > 0.9 * LENGTH / SPEED


def test_fluid_of_the_start_is_as_old_as_the_run():
    sim = Simulation(stream(), device="cpu")
    sim.advance(0.5)
    x, age = ages(sim)
    began_inside = (x > SPEED * 0.5 + 0.05) & (x < LENGTH - 0.05)
    assert began_inside.any()
    np.testing.assert_allclose(age[began_inside], 0.5, rtol=1e-12)


def test_age_survives_a_checkpoint():
    first, second = (Simulation(stream(), device="cpu") for _ in range(2))
    first.advance(0.4)
    second.load_state(first.save_state())
    for sim in (first, second):
        sim.advance(0.8)
    assert np.array_equal(ages(first)[1], ages(second)[1])


def test_no_age_is_kept_unless_asked_for():
    sim = Simulation(stream(fields=["velocity"]), device="cpu")
    with pytest.raises(KeyError, match="no field 'age'"):
        sim.frame(["age"])
