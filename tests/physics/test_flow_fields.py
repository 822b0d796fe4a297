"""Vorticity and free surface as output fields, against states in which they are known."""

import numpy as np
import pytest
from builders import free_drop, still_tank

from warpsph.scene.schema import Scene
from warpsph.solver.simulation import Simulation


def spinning(dimension: int, velocity: list[str]) -> Scene:
    """The drop of the builders, with another velocity."""
    scene = free_drop(dimension)
    water = scene.fluids["water"].model_dump() | {"velocity": velocity}
    return free_drop(dimension, fluids={"water": water})


def fluid_field(scene: Scene, name: str) -> np.ndarray:
    return Simulation(scene, device="cpu").frame([name]).sets[0].fields[name]


# Linear velocities are differentiated exactly, so only single precision is left.
ROUNDING = {"rel": 1e-4, "abs": 1e-4}


def test_rigid_rotation_has_twice_its_rate_as_vorticity_up_to_the_surface():
    vorticity = fluid_field(spinning(2, ["-3*y", "3*x"]), "vorticity")
    assert vorticity == pytest.approx(np.full_like(vorticity, 6.0), **ROUNDING)


def test_vorticity_in_space_is_the_curl():
    """v = (2 z, 0, x + y): curl v = (1, 2 - 1, 0)."""
    vorticity = fluid_field(spinning(3, ["2*z", "0*x", "x + y"]), "vorticity")
    assert vorticity == pytest.approx(np.broadcast_to([1.0, 1.0, 0.0], vorticity.shape), **ROUNDING)


def test_a_stream_without_rotation_has_no_vorticity():
    vorticity = fluid_field(spinning(2, ["2*x - y", "-x - 2*y"]), "vorticity")
    assert vorticity == pytest.approx(np.zeros_like(vorticity), abs=1e-4)


@pytest.mark.parametrize("dimension", [2, 3])
def test_in_a_still_tank_the_uppermost_layer_is_the_surface(dimension):
    frame = Simulation(still_tank(dimension), device="cpu").frame(["free_surface"])
    water = frame.sets[0].fields
    height = water["position"][:, -1]
    assert np.array_equal(water["free_surface"] == 1.0, height > height.max() - 1e-9)


@pytest.mark.parametrize("dimension", [2, 3])
def test_all_faces_of_a_free_drop_are_surface(dimension):
    water = Simulation(free_drop(dimension), device="cpu").frame(["free_surface"]).sets[0].fields
    depth = np.min(np.minimum(water["position"], 1.0 - water["position"]), axis=1)
    assert np.array_equal(water["free_surface"] == 1.0, depth < 0.06)


def test_nothing_is_computed_unless_asked_for():
    sim = Simulation(free_drop(2), device="cpu")
    sim.frame()
    assert not {"vorticity", "free surface"} & sim.stages.keys()
    sim.frame(["vorticity"])
    assert "vorticity" in sim.stages
    assert "free surface" not in sim.stages
