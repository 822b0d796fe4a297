"""Laws of the fluid scheme on small scenes: conservation, order, equilibrium, determinism."""

import numpy as np
import pytest
from builders import GRAVITY, free_drop, still_tank

from warpsph.solver.errors import SimulationDiverged
from warpsph.solver.simulation import Simulation


def momentum(sim: Simulation) -> np.ndarray:
    water = sim.frame(["velocity", "mass"]).sets[0].fields
    return (water["mass"][:, None] * water["velocity"].astype(np.float64)).sum(axis=0)


def momentum_scale(sim: Simulation) -> float:
    water = sim.frame(["velocity", "mass"]).sets[0].fields
    return float((water["mass"] * np.linalg.norm(water["velocity"], axis=1)).sum())


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(("precision", "rounding"), [("single", 2e-6), ("double", 1e-14)])
@pytest.mark.parametrize(
    "viscosity", ["none", "artificial", "laminar", "viscous_stress", "sub_particle_scale"]
)
def test_momentum_of_a_free_drop_is_conserved_to_rounding(dimension, precision, rounding, viscosity):
    scene = free_drop(dimension, numerics={"precision": precision, "viscosity": {"type": viscosity}})
    sim = Simulation(scene, device="cpu")
    before = momentum(sim)
    for _ in range(20):
        sim.step()
    assert np.abs(momentum(sim) - before).max() < rounding * momentum_scale(sim)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(
    "numerics",
    [
        {"pressure_form": "riemann", "viscosity": {"type": "none"}},
        {"density_diffusion": {"type": "delta_sph"}},
        {"kernel": "quintic_spline", "h_over_dp": 1.0, "state": {"type": "linear"}},
    ],
    ids=["riemann", "delta_sph", "quintic_linear"],
)
def test_every_form_conserves_momentum_to_rounding(dimension, numerics):
    sim = Simulation(free_drop(dimension, numerics=numerics | {"precision": "double"}), device="cpu")
    before = momentum(sim)
    for _ in range(20):
        sim.step()
    assert np.abs(momentum(sim) - before).max() < 1e-14 * momentum_scale(sim)


def end_positions(max_step: float) -> np.ndarray:
    scene = free_drop(
        numerics={
            "precision": "double",
            "viscosity": {"type": "none"},
            "density_diffusion": {"type": "none"},
        },
        time={"end": 0.2, "max_step": max_step, "cfl": 1.0},
    )
    sim = Simulation(scene, device="cpu")
    sim.advance(0.2)
    return sim.frame(["velocity"]).sets[0].fields["position"]


@pytest.mark.verification
def test_time_integration_is_of_second_order():
    # Halving the step divides the error of a second-order scheme by four, its difference to the next by four too.
    coarse, middle, fine = (end_positions(0.2 / n) for n in (50, 100, 200))
    ratio = np.linalg.norm(coarse - middle) / np.linalg.norm(middle - fine)
    assert 3.5 < ratio < 4.5


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("wall", ["extrapolated", "dynamic"])
def test_force_on_a_tank_is_the_weight_of_the_water(dimension, wall):
    # At t = 0 the pressure is hydrostatic: the pair sum carries the weight to the accuracy of the quadrature.
    sim = Simulation(still_tank(dimension, numerics={"wall": {"type": wall}}), device="cpu")
    water, tank = sim.frame(["mass", "force"]).sets
    weight = water.fields["mass"].sum() * GRAVITY
    force = tank.fields["force"].sum(axis=0)
    assert force[-1] == pytest.approx(-weight, rel=0.05)
    assert np.abs(force[:-1]).max() < 1e-4 * weight


@pytest.mark.parametrize("form", [{}, {"pressure_form": "riemann", "viscosity": {"type": "none"}}])
def test_wall_force_is_the_opposite_of_what_the_fluid_receives(form):
    sim = Simulation(still_tank(numerics={"precision": "double"} | form), device="cpu")
    for _ in range(5):
        sim.step()
    parts = sim.system.parts
    water, tank = sim.frame(["mass", "force"], ordered=False).sets
    parts.fluid.accelerate()
    acceleration = parts.assembly.state.acceleration.numpy()[: len(water.fields["mass"])]
    received = (water.fields["mass"][:, None] * (acceleration - np.array([0.0, -GRAVITY]))).sum(axis=0)
    scale = np.abs(received).max()
    assert received == pytest.approx(-tank.fields["force"].sum(axis=0), abs=1e-12 * scale)


def test_a_step_advances_the_time_by_its_report():
    sim = Simulation(still_tank(), device="cpu")
    for target in (None, 0.01):
        if target:
            sim.advance(target)
        before = sim.time
        report = sim.step()
        assert report.dt > 0.0
        assert sim.time == before + report.dt


def test_advance_lands_exactly():
    sim = Simulation(still_tank(), device="cpu")
    for until in (0.01, 0.0123456789, 0.02):
        sim.advance(until)
        assert sim.time == until


def states_equal(a: Simulation, b: Simulation) -> bool:
    first, second = a.save_state(), b.save_state()
    return all(np.array_equal(first[name], second[name]) for name in first)


def test_any_number_of_threads_gives_the_same_bits():
    sims = [Simulation(still_tank(spacing=0.025), device="cpu", threads=n) for n in (1, 2, 3)]
    for sim in sims:
        for _ in range(30):
            sim.step()
    assert states_equal(sims[0], sims[1])
    assert states_equal(sims[0], sims[2])


@pytest.mark.parametrize("wall", ["extrapolated", "dynamic"])
def test_a_restored_state_goes_on_with_the_same_bits(wall):
    # A fast drop, so that lists are renewed before and after the restart.
    scene = still_tank(numerics={"wall": {"type": wall}}, time={"end": 0.4})
    scene = scene.model_copy(update={"gravity": (3.0, -9.0)})
    whole = Simulation(scene, device="cpu")
    whole.advance(0.1)
    for _ in range(7):
        whole.step()
    saved = whole.save_state()
    resumed = Simulation(scene, device="cpu")
    resumed.load_state(saved)
    for sim in (whole, resumed):
        sim.advance(0.4)
    assert whole.list_builds > 5
    assert states_equal(whole, resumed)


def test_single_and_double_agree_to_single_precision():
    ends = []
    for precision in ("single", "double"):
        sim = Simulation(still_tank(numerics={"precision": precision}), device="cpu")
        for _ in range(50):
            sim.step()
        ends.append(sim.frame(["velocity"]).sets[0].fields["position"])
    # 50 steps of accelerations that carry rounding errors of 1e-7 c0^2 / h.
    assert np.abs(ends[0] - ends[1]).max() < 1e-6


def test_far_from_the_origin_nothing_is_lost():
    near = still_tank()
    far = near.model_dump()
    shift = 1.0e4
    for body in (far["fluids"]["water"], far["boundaries"]["tank"]):
        body["shape"]["min"] = tuple(x + shift for x in body["shape"]["min"])
        body["shape"]["max"] = tuple(x + shift for x in body["shape"]["max"])
    far["numerics"]["sound_speed"] = 30.0
    near = near.model_copy(update={"numerics": near.numerics.model_copy(update={"sound_speed": 30.0})})
    ends = []
    for scene in (near, type(near)(**far)):
        sim = Simulation(scene, device="cpu")
        for _ in range(50):
            sim.step()
        ends.append(sim.frame(["velocity"]).sets[0].fields["position"])
    assert np.abs(ends[1] - shift - ends[0]).max() < 1e-7


def test_kill_box_removes_and_counts():
    scene = free_drop(domain={"kill_box": {"min": (-0.2, -0.2), "max": (1.2, 1.2)}}, time={"end": 2.0})
    sim = Simulation(scene, device="cpu")
    sim.advance(2.0)
    (water,) = sim.frame(["velocity"]).sets
    assert sim.removed_count > 0
    assert water.count == 100 - sim.removed_count
    assert len(set(water.fields["id"])) == water.count


def test_a_kill_box_takes_fluid_and_leaves_walls():
    kill_box = {"min": (0.0, 0.0), "max": (0.5, 0.75)}
    sim = Simulation(still_tank(domain={"kill_box": kill_box}), device="cpu")
    sim.advance(0.1)
    assert sim.removed_count == 0
    assert sim.sets == Simulation(still_tank(), device="cpu").sets


def test_particles_that_left_do_not_limit_the_step():
    # One particle flies off at half the sound speed: the step is shorter while it is there, and only then.
    fast = {
        "shape": {"type": "box", "min": (3.0, 0.4), "max": (3.1, 0.5)},
        "density": 1000.0,
        "kinematic_viscosity": 0.01,
        "velocity": (5.0, 0.0),
        "pressure": {"type": "uniform", "value": 0.0},
    }
    scene = free_drop(domain={"kill_box": {"min": (-1.0, -1.0), "max": (3.2, 2.0)}})
    fluids = scene.model_dump()["fluids"] | {"bullet": fast}
    sim = Simulation(type(scene)(**(scene.model_dump() | {"fluids": fluids})), device="cpu")
    first = sim.step().dt
    while not sim.removed_count:
        sim.step()
    sim.step()
    assert sim.extremes["speed"] < 1.0
    assert sim.step().dt > 1.3 * first

    # Nor does a fault name one of them: the sound speed is 10 m/s, and it is the living particle that is too fast.
    velocity = sim.array("velocity_volume").numpy()
    velocity[-1, 0], velocity[0, 0] = 1000.0, 25.0
    with pytest.raises(SimulationDiverged) as failure:
        sim.advance(sim.time + 0.1)
    assert failure.value.set == "water"
    assert failure.value.value < 100.0
