"""Modified dynamic walls: linear fields go on into the wall exactly, and still water stays still."""

import numpy as np
import pytest
from builders import GRAVITY, channel, still_tank

from warpsph.scene.schema import Scene
from warpsph.solver.simulation import Simulation

MIRRORED = {"type": "modified_dynamic"}


def tank(dimension: int, **changes) -> Scene:
    return still_tank(dimension, numerics={"wall": MIRRORED, "precision": "double"}, **changes)


@pytest.mark.parametrize("dimension", [2, 3])
def test_hydrostatic_pressure_goes_on_below_the_floor_and_behind_the_walls(dimension):
    """The initial pressure is linear; whatever sees enough fluid extrapolates it to rounding.

    Mirror points above 0.3 m lie near the surface at 0.5 m, where the volumes are right and the support still full
    enough; those within a support radius of the walls see no less for it, because first-order consistency needs no
    full support. Volumes differ by the compression, which the matrix of moments takes out as well.
    """
    frame = Simulation(tank(dimension), device="cpu").frame(["pressure"])
    wall = frame.set_named("tank").fields
    height = wall["position"][:, -1]
    below = height < 0.3
    # The state turns the pressure into a density and back in double precision.
    assert wall["pressure"][below] == pytest.approx(1000.0 * GRAVITY * (0.5 - height[below]), rel=1e-6)


def test_velocity_at_the_wall_is_mirrored_exactly_for_a_linear_profile():
    """v_x = 0.01 y / GAP before a floor at rest: the wall particle at -y is seen with -v_x (y)."""
    scene = channel(20, numerics={"viscosity": {"type": "laminar"}, "wall": MIRRORED, "precision": "double"})
    water = scene.fluids["water"].model_dump() | {"velocity": ("1.0e-5*y/1.0e-3", "0*x")}
    fields = {name: getattr(scene, name) for name in type(scene).model_fields}
    sim = Simulation(Scene(**(fields | {"fluids": {"water": water}})), device="cpu")
    walls = sim.system.parts.walls
    reference = walls.motion.reference.numpy()
    height = reference[:, 1]
    floor = (height < 0.0) & (height > -3.0 * scene.spacing)
    seen = walls.model.walls.surface.friction.numpy()[floor]
    depth = reference[floor, 1]
    assert seen[:, 0] == pytest.approx(1.0e-5 * depth / 1.0e-3, rel=1e-9)
    assert seen[:, 1] == pytest.approx(np.zeros(len(depth)), abs=1e-17)


@pytest.mark.verification
@pytest.mark.parametrize("dimension", [2, 3])
def test_still_water_stays_still(dimension):
    """The kinetic energy stays below 1e-4 of m g H / 2; the walls carry the weight in the mean of a second.

    Sound that the start leaves behind runs up and down with a period of 4 H / c0 = 0.064 s and makes the load of a
    moment swing by more than a per cent.
    """
    sim = Simulation(tank(dimension), device="cpu")
    loads = []
    for time in np.linspace(0.5, 1.5, 64):
        sim.advance(float(time))
        loads.append(sim.frame(["force"]).set_named("tank").fields["force"][:, -1].sum())
    water = sim.frame(["velocity", "mass"]).of_kind("fluid")[0].fields
    weight = water["mass"].sum() * GRAVITY
    energy = 0.5 * np.sum(water["mass"][:, None] * water["velocity"] ** 2)
    assert energy < 1e-4 * weight * 0.5 / 2.0
    assert np.mean(loads) == pytest.approx(-weight, rel=0.01)


def test_dry_walls_have_no_pressure():
    wall = Simulation(tank(2), device="cpu").frame(["pressure"]).set_named("tank").fields
    dry = wall["position"][:, 1] > 0.5 + 3.5 * 0.05
    assert dry.any()
    assert not wall["pressure"][dry].any()
