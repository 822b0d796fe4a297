"""A scene in other units of length, time and mass is the same scene: there is no number with a unit in the scheme.

With powers of two as the factors not even rounding differs, because a product, quotient or sum of scaled numbers is the
scaled one to the last bit; roots are taken of nothing but even powers. So is the whole way from the shapes to the state
at the end, with hydrostatic pressure, `auto` sound speed, walls, clamps, damping and sub-steps.
"""

import numpy as np
import pytest

from warpsph.physics.material import smoothing_length
from warpsph.scene.schema import Scene
from warpsph.solver.simulation import Simulation

DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])
KINDS = pytest.mark.parametrize("kind", ["fluid", "structure", "coupled"])
PRECISIONS = pytest.mark.parametrize("precision", ["single", "double"])

DP, END, MAX_STEP = 0.05, 0.01, 5.0e-4
"""Spacing, end of the run and longest step, before they are scaled. Beside structures steps are rounded down to a power
of 1.05 in seconds, and then so that equal ones land on the end."""
DENSITY, SOUND_SPEED = 1000.0, 30.0
"""Of the water [1]; the sound speed, which the scene chooses itself, is about that, and that of the plate 20."""
MICROMETRE, TEN_KILOMETRES = 1.0e-6, 1.0e4


def basin(kind, dimension, precision, length=1.0, time=1.0, mass=1.0):
    """Water, 0.3 deep, that moves towards a plate clamped to the floor, or the plate alone, in units of so many
    metres, seconds and kilograms."""
    density, speed, across = DENSITY * mass / length**dimension, length / time, (0.6,) * (dimension - 2)

    def box(low, high):
        lengths = ((low[0], *(0.0 for _ in across), low[1]), (high[0], *across, high[1]))
        return {
            "type": "box",
            **{end: tuple(length * x for x in at) for end, at in zip(("min", "max"), lengths, strict=True)},
        }

    water = {
        "shape": box((0.0, 0.0), (0.35, 0.3)),
        "density": density,
        "kinematic_viscosity": 1.0e-3 * length * speed,
        "pressure": {"type": "hydrostatic"},
        "velocity": (0.3 * speed, *(0.0,) * (dimension - 1)),
    }
    up = "y_max" if dimension == 2 else "z_max"
    tank = {"shape": box((0.0, 0.0), (0.9, 0.6)), "side": "outside", "open": (up,)}
    rubber = {"density": 1.1 * density, "youngs_modulus": 400.0 * density * speed**2, "poisson_ratio": 0.3}
    plate = {
        "shape": box((0.35, -0.2), (0.55, 0.4)),
        "material": rubber,
        "clamps": {"foot": {"region": box((0.35, -0.2), (0.55, 0.0))}},
        "damping": 1.0 / time,
    }
    return Scene(
        name="basin",
        dimension=dimension,
        spacing=DP * length,
        gravity=(*(0.0,) * (dimension - 1), -9.81 * length / time**2),
        time={"end": END * time, "frame_rate": 100.0 / time, "max_step": MAX_STEP * time},
        numerics={"precision": precision},
        fluids={} if kind == "structure" else {"water": water},
        boundaries={} if kind == "structure" else {"tank": tank},
        structures={} if kind == "fluid" else {"plate": plate},
    )


def end_state(scene, length=1.0, time=1.0, mass=1.0):
    """Positions, velocities, densities and pressures at the end, in the units of the scene before it was scaled."""
    simulation = Simulation(scene, device="cpu", threads=1)
    simulation.advance(scene.time.end)
    dimension = scene.dimension
    units = {"position": length, "velocity": length / time}
    if scene.fluids:
        units |= {"density": mass / length**dimension, "pressure": mass / length ** (dimension - 2) / time**2}
    frames = simulation.frame(list(units)).sets
    return {
        (one.name, name): np.asarray(one.fields[name], dtype=np.float64) / unit
        for one in frames
        for name, unit in units.items()
        if name in one.fields
    }


@DIMENSIONS
@KINDS
@PRECISIONS
@pytest.mark.parametrize(
    "units",
    [
        {"length": 2.0**-10},
        {"length": 2.0**13},
        {"time": 2.0**-7},
        {"mass": 2.0**5},
        {"length": 2.0**-20, "time": 2.0**-20, "mass": 2.0**-60},
    ],
    ids=["millimetres", "8_kilometres", "milliseconds", "32_kilograms", "micro"],
)
def test_powers_of_two_do_not_change_a_bit(kind, dimension, precision, units):
    expected = end_state(basin(kind, dimension, precision))
    found = end_state(basin(kind, dimension, precision, **units), **units)
    assert found.keys() == expected.keys()
    for key, values in expected.items():
        assert np.array_equal(found[key], values), key


@DIMENSIONS
@KINDS
@PRECISIONS
@pytest.mark.parametrize("length", [MICROMETRE, TEN_KILOMETRES])
def test_the_same_material_at_another_scale_moves_alike(kind, dimension, precision, length):
    """At the same speeds and densities, under a gravity that grows as lengths shrink. The factors round every number of
    the scene, so that the tolerance is that of a run in other axes (test_invariance.py). Beside clamps there is more to
    it: the way to their surface is found by differences over a thousandth of a spacing."""
    units = {"length": length, "time": length, "mass": length**dimension}
    scene = basin(kind, dimension, precision)
    expected = end_state(scene)
    found = end_state(basin(kind, dimension, precision, **units), **units)
    eps = np.finfo(np.float32 if precision == "single" else np.float64).eps
    if kind != "fluid":
        eps = max(eps, 1.0e3 * np.finfo(np.float64).eps)
    speed = END / MAX_STEP * eps / smoothing_length(scene) * SOUND_SPEED
    scales = {
        "position": END * speed,
        "velocity": speed,
        "density": DENSITY * speed / SOUND_SPEED,
        "pressure": DENSITY * speed * SOUND_SPEED,
    }
    for (body, name), values in expected.items():
        np.testing.assert_allclose(
            found[body, name], values, rtol=0.0, atol=scales[name], err_msg=f"{body} {name}"
        )
