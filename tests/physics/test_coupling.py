"""Fluids and structures together: what one loses the other receives, and a plate has two sides."""

import numpy as np
import pytest
from coupled_builders import GRAVITY, divided_tank, struck_water

from warpsph.scene.errors import SceneError
from warpsph.scene.schema import Scene
from warpsph.solver.simulation import Simulation

LAMINAR = {"kinematic_viscosity": 1.0e-3}


def momentum_after(scene, until=0.02):
    """Change of momentum and of angular momentum in parts of the momentum of the plate, and what it has given away."""
    sim = Simulation(scene, device="cpu")
    first = sim.ledger()
    scale = float(np.linalg.norm(first.momentum))
    sim.advance(until)
    last = sim.ledger()
    plate = sim.frame(["velocity", "mass"]).set_named("plate").fields
    kept = np.linalg.norm(plate["mass"] @ plate["velocity"]) / scale
    change = np.subtract(last.momentum, first.momentum) / scale
    turn = np.subtract(last.angular_momentum, first.angular_momentum) / scale
    return float(np.abs(change).max()), float(np.abs(turn).max()), kept


@pytest.mark.parametrize("wall", ["extrapolated", "dynamic", "modified_dynamic", "repulsive"])
def test_momentum_is_conserved_to_rounding_by_every_wall_method(wall):
    """In double precision: a few hundred steps with a relative rounding of 1e-16 each, over thousands of particles."""
    change, _, kept = momentum_after(struck_water(precision="double", numerics={"wall": {"type": wall}}))
    assert change < 1e-13
    assert kept < 0.7


@pytest.mark.parametrize(
    "options",
    [
        {"numerics": {"viscosity": {"type": "laminar"}}, "water": LAMINAR, "plate": {"slip": "no_slip"}},
        {
            "numerics": {"viscosity": {"type": "sub_particle_scale"}},
            "water": LAMINAR,
            "plate": {"slip": "no_slip"},
        },
        {"numerics": {"pressure_form": "riemann", "viscosity": {"type": "none"}}},
        {"coupling": {"sub_steps": 1}},
        {"coupling": {"velocity": "mean"}},
    ],
)
def test_momentum_is_conserved_to_rounding_by_every_force(options):
    change, _, kept = momentum_after(struck_water(precision="double", **options))
    assert change < 1e-13
    assert kept < 0.8


def test_momentum_is_conserved_in_space_and_in_single_precision():
    """Velocities are stored in single precision: each step rounds that of every particle by up to 6e-8 of itself, to
    either side, and 250 steps of 1200 particles add up to less than 1e-6 of the whole."""
    change, turn, kept = momentum_after(struck_water(dimension=3))
    assert change < 1e-6
    assert turn < 1e-6
    assert kept < 0.9


def test_sub_steps_serve_a_stiff_plate_and_change_its_motion_little():
    """The same plate at 100 times the stiffness, with many steps of its own and with shared steps."""
    stiff = {"material": {"density": 1100.0, "youngs_modulus": 1.0e9, "poisson_ratio": 0.3}}
    velocity, steps = [], []
    for coupling in ({"sub_steps": "auto"}, {"sub_steps": 1}):
        sim = Simulation(struck_water(plate=stiff, coupling=coupling), device="cpu")
        sim.advance(0.01)
        steps.append(sim.step_count)
        plate = sim.frame(["velocity", "mass"]).set_named("plate").fields
        velocity.append(plate["mass"] @ plate["velocity"][:, 1] / plate["mass"].sum())
    assert steps[1] > 4 * steps[0]
    # Both are of second order in the step of the fluid; between them lie a few parts in a thousand of 10 m/s.
    assert velocity[0] == pytest.approx(velocity[1], abs=0.05)


@pytest.mark.verification
@pytest.mark.parametrize("cells", [3, 4])
@pytest.mark.parametrize(("left", "right"), [(0.3, 0.3), (0.3, 0.2), (0.3, 0.0)])
def test_a_plate_between_two_water_levels_feels_each_on_its_own_side(cells, left, right):
    """The force of still water a metre deep on a wall is rho g h^2 / 2: (h_left^2 - h_right^2) / 2 of both sides.

    Levels are sharp to half a spacing of 0.02 m, which is 7 per cent of a depth of 0.3 m in the force of one side, and
    cancels where they are equal.
    """
    sim = Simulation(divided_tank(left, right, cells), device="cpu")
    forces = []
    for time in np.linspace(0.6, 1.0, 41):
        sim.advance(float(time))
        plate = sim.frame(["force"]).set_named("plate").fields
        forces.append(plate["force"][:, 0].sum())
    expected = 0.5 * 1000.0 * GRAVITY * (left**2 - right**2)
    one_side = 0.5 * 1000.0 * GRAVITY * left**2
    assert np.mean(forces) == pytest.approx(expected, abs=0.05 * one_side)
    for fluid in sim.frame(["velocity"]).of_kind("fluid"):
        x = fluid.fields["position"][:, 0]
        assert np.all(x < 0.23) if fluid.name == "left" else np.all(x > 0.2 + 0.02 * cells - 0.03)


def test_fluid_feels_nothing_of_fluid_behind_a_thin_plate():
    """Bit for bit the same on the left, whether the water on the right is there or not, while the plate rests."""
    ends = []
    for right in (0.3, 0.1):
        stiff = {"density": 2000.0, "youngs_modulus": 1.0e8, "poisson_ratio": 0.3}
        held = {"type": "box", "min": (0.2, -0.08), "max": (0.26, 0.4)}
        shown = {"shape": held, "material": stiff, "clamps": {"all": {"region": held}}}
        sim = Simulation(divided_tank(0.3, right, plate=shown, time={"max_step": 2e-4}), device="cpu")
        for _ in range(50):
            sim.step()
        ends.append(sim.frame(["velocity", "pressure"]).set_named("left").fields)
    assert np.array_equal(ends[0]["position"], ends[1]["position"])
    assert np.array_equal(ends[0]["pressure"], ends[1]["pressure"])


def test_a_plate_too_thin_for_the_fluid_is_refused():
    with pytest.raises(SceneError, match="fluid on one side would act through it"):
        Simulation(divided_tank(0.3, 0.2, cells=1), device="cpu")


def test_a_run_goes_on_with_the_same_bits():
    scene = divided_tank(0.3, 0.1)
    whole = Simulation(scene, device="cpu")
    whole.advance(0.1)
    saved = whole.save_state()
    whole.advance(0.2)
    second = Simulation(scene, device="cpu")
    second.load_state(saved)
    second.advance(0.2)
    for one, other in zip(whole.frame().sets, second.frame().sets, strict=True):
        for name, values in one.fields.items():
            assert np.array_equal(values, other.fields[name]), (one.name, name)


def test_structures_cross_periodic_faces_with_their_fluid():
    """Nothing happens to a block that drifts with the water around it through the faces of the period.

    The barrier of its surface does not reach the water that begins a spacing off its corners.
    """
    box = {"type": "box", "min": (0.16, 0.14), "max": (0.24, 0.26)}
    water = {
        "type": "difference",
        "base": {"type": "box", "min": (0.0, 0.0), "max": (0.4, 0.4)},
        "subtract": [box],
    }
    scene = Scene(
        name="drift",
        dimension=2,
        spacing=0.02,
        domain={"periodic": {"x": (0.0, 0.4), "y": (0.0, 0.4)}},
        time={"end": 0.4, "frame_rate": 10.0},
        numerics={"sound_speed": 20.0},
        fluids={"water": {"shape": water, "density": 1000.0, "velocity": (1.0, 0.5)}},
        structures={
            "block": {
                "shape": box,
                "material": {"density": 1000.0, "youngs_modulus": 1e6, "poisson_ratio": 0.3},
                "velocity": (1.0, 0.5),
            }
        },
    )
    sim = Simulation(scene, device="cpu")
    sim.advance(0.4)
    block = sim.frame(["displacement", "velocity"]).set_named("block").fields
    assert block["displacement"] == pytest.approx(np.tile((0.4, 0.2), (24, 1)), abs=1e-6)
    assert block["velocity"] == pytest.approx(np.tile((1.0, 0.5), (24, 1)), abs=1e-5)
