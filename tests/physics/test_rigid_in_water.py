"""Rigid bodies in water: periodic faces, a flap between two water levels, and which way up a box floats."""

import numpy as np
import pytest
from coupled_builders import GRAVITY, RUBBER, divided_tank
from structure_builders import region

from warpsph.scene.schema import Scene
from warpsph.solver.simulation import Simulation


def motion(simulation, name) -> dict[str, np.ndarray]:
    rows = simulation.frame(("rigid_motion",)).set_named(name).fields["rigid_motion"][0]
    return dict(zip(("position", "velocity", "angle", "spin", "force", "torque"), rows, strict=True))


def test_a_rigid_body_crosses_periodic_faces_with_its_fluid():
    """Nothing happens to a body that drifts with the water around it through the faces of the period.

    The barrier of its surface does not reach the water that begins a spacing off its corners.
    """
    box = region((0.16, 0.14), (0.24, 0.26))
    water = {"type": "difference", "base": region((0.0, 0.0), (0.4, 0.4)), "subtract": [box]}
    drift = (1.0, 0.5)
    scene = Scene(
        name="drift",
        dimension=2,
        spacing=0.02,
        domain={"periodic": {"x": (0.0, 0.4), "y": (0.0, 0.4)}},
        time={"end": 0.4, "frame_rate": 10.0},
        numerics={"sound_speed": 20.0},
        fluids={"water": {"shape": water, "density": 1000.0, "velocity": drift}},
        structures={"block": {"shape": box, "material": RUBBER, "velocity": drift, "rigid": {}}},
    )
    simulation = Simulation(scene, device="cpu", threads=1)
    simulation.advance(0.4)
    found = motion(simulation, "block")
    assert found["position"][:2] == pytest.approx((0.2 + 0.4, 0.2 + 0.2), abs=1e-6)
    assert found["velocity"][:2] == pytest.approx(drift, abs=1e-5)
    assert found["angle"][2] == pytest.approx(0.0, abs=1e-5)


FOOT = (0.23, 0.0)


def flap(left: float, right: float, **rigid) -> Simulation:
    """A flap three particles thick on the floor between two depths of water [m]; it turns about its foot or is held."""
    plate = {
        "shape": region((0.2, 0.0), (0.26, 0.4)),
        "material": RUBBER,
        "rigid": rigid,
        "clamps": {},
        "damping": 0.0,
    }
    return Simulation(divided_tank(left, right, plate=plate), device="cpu", threads=1)


def torque_about_foot(simulation) -> float:
    fields = simulation.frame(("force",)).set_named("plate").fields
    arm, force = fields["position"] - FOOT, fields["force"]
    return float(np.sum(arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]))


@pytest.mark.verification
@pytest.mark.parametrize(("left", "right"), [(0.3, 0.3), (0.3, 0.2)])
def test_water_turns_a_held_flap_about_its_foot(left, right):
    """A depth h turns it by rho g h^3 / 6, to the half spacing to which depths are known: 10 % of one side."""
    simulation = flap(left, right, free=[])
    found = []
    for time in np.linspace(0.6, 1.0, 41):
        simulation.advance(float(time))
        found.append(torque_about_foot(simulation))
    one_side = 1000.0 * GRAVITY * left**3 / 6.0
    assert np.mean(found) == pytest.approx(-one_side * (1.0 - (right / left) ** 3), abs=0.1 * one_side)


@pytest.mark.verification
def test_a_flap_on_a_hinge_falls_to_the_lower_water():
    """Levels that differ turn it over, away from the higher one; its foot stays where it is; no water gets into it."""
    simulation = flap(0.3, 0.1, free=["rz"], pivot=FOOT)
    simulation.advance(0.5)
    found = motion(simulation, "plate")
    angle, centre = found["angle"][2], found["position"][:2]
    assert angle < -0.5
    assert centre - FOOT == pytest.approx((-0.2 * np.sin(angle), 0.2 * np.cos(angle)), abs=1e-12)
    for fluid in simulation.frame(("velocity",)).of_kind("fluid"):
        away = fluid.fields["position"] - centre
        across = away @ (np.cos(angle), np.sin(angle))
        along = away @ (-np.sin(angle), np.cos(angle))
        assert not np.any((np.abs(across) < 0.02) & (np.abs(along) < 0.19))


def floating(width: float, height: float, tilt: float) -> Simulation:
    """A box of half the density of water in it, in the middle of the surface, tilted by an angle [degrees]."""
    box = {
        "type": "transform",
        "shape": region((-width / 2, -height / 2), (width / 2, height / 2)),
        "rotate": {"angle": tilt},
        "translate": (0.0, 0.3),
    }
    water = {"type": "difference", "base": region((-0.4, 0.0), (0.4, 0.3)), "subtract": [box]}
    scene = Scene(
        name="floating",
        dimension=2,
        spacing=0.02,
        gravity=(0.0, -GRAVITY),
        time={"end": 3.0, "frame_rate": 10.0},
        numerics={"sound_speed": 17.0},
        fluids={"water": {"shape": water, "density": 1000.0}},
        boundaries={
            "tank": {"shape": region((-0.4, 0.0), (0.4, 0.6)), "side": "outside", "open": ("y_max",)}
        },
        structures={"box": {"shape": box, "material": RUBBER | {"density": 500.0}, "rigid": {}}},
    )
    return Simulation(scene, device="cpu", threads=1)


@pytest.mark.verification
@pytest.mark.parametrize(("width", "height", "turns_over"), [(0.24, 0.12, False), (0.12, 0.24, True)])
def test_a_box_floats_upright_where_its_metacentre_says_so(width, height, turns_over):
    """b^2 / (12 d) + d / 2 - a / 2 with the draught d = a / 2 is positive for b / a > sqrt(3/2): Bouguer.

    From a tilt of 10 degrees the wide one comes back to within 5 degrees, and the narrow one lies down on its side.
    """
    simulation = floating(width, height, 10.0)
    angles = []
    for time in np.linspace(2.0, 3.0, 11):
        simulation.advance(float(time))
        angles.append(np.degrees(motion(simulation, "box")["angle"][2]) + 10.0)
    assert abs(np.mean(angles)) == pytest.approx(90.0 if turns_over else 0.0, abs=5.0)
