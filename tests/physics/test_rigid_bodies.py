"""Rigid bodies: flight, rotation, axes that are held or prescribed, contact, and the same bits however a run is cut."""

import numpy as np
import pytest
from contact_builders import body, centre, simulate, total, touching
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation
from scipy.special import ellipk
from structure_builders import DENSITY, block, reference_of, region

from warpsph.particles.state import host_view
from warpsph.scene.errors import SceneError
from warpsph.solver.simulation import Simulation

CUBOID = (0.6, 0.4, 0.2)


def rigid_block(size=(0.4, 0.4), rigid=None, end=1.0, max_step=None, **changes) -> Simulation:
    structure = {"rigid": rigid or {}} | changes.pop("structure", {})
    time = {"end": end, "frame_rate": 1.0 / end, "max_step": max_step}
    return simulate(block(size, structure=structure, time=time, **changes))


def motion(simulation, name="block") -> dict[str, np.ndarray]:
    """What the probe of a rigid body tells, by quantity (3,)."""
    rows = simulation.frame(("rigid_motion",)).set_named(name).fields["rigid_motion"][0]
    return dict(zip(("position", "velocity", "angle", "spin", "force", "torque"), rows, strict=True))


def positions(simulation) -> np.ndarray:
    return reference_of(simulation.system) + host_view(simulation.array("displacement"))


def test_free_fall_and_spin_in_the_plane_are_exact():
    """x = x0 + v t + g t^2/2 and theta = omega t: velocity Verlet has no error under a constant force."""
    spin, g = 3.0, -10.0
    simulation = rigid_block(gravity=(0.0, g), structure={"velocity": ["1 - 3*(y-0.2)", "2 + 3*(x-0.2)"]})
    simulation.advance(1.0)
    found = motion(simulation)
    assert found["position"][:2] == pytest.approx([0.2 + 1.0, 0.2 + 2.0 + 0.5 * g], abs=1e-13)
    assert found["velocity"][:2] == pytest.approx([1.0, 2.0 + g], abs=1e-13)
    assert found["angle"][2] == pytest.approx(spin, abs=1e-13)
    arm = reference_of(simulation.system) - 0.2
    turned = arm @ Rotation.from_rotvec([0, 0, spin]).as_matrix()[:2, :2].T
    assert positions(simulation) == pytest.approx(turned + found["position"][:2], abs=1e-13)
    # The deformation gradient is the rotation, and its stress nothing but rounding.
    gradient = host_view(simulation.system.parts.model.scratch.gradient)[0]
    assert gradient == pytest.approx(
        Rotation.from_rotvec([0, 0, spin]).as_matrix()[:2, :2] - np.eye(2), abs=1e-13
    )
    assert simulation.ledger().energies["strain"] < 1e-20


def test_a_step_lasts_as_long_as_nothing_limits_it():
    """Without contact, elastic waves and rotation a body flies to the frame in one step."""
    simulation = rigid_block(gravity=(0.0, -10.0))
    assert simulation.describe()["step_limits_s"] == {}
    simulation.advance(1.0)
    assert simulation.step_count == 1
    assert motion(simulation)["position"][1] == pytest.approx(0.2 - 5.0, abs=1e-13)


def cuboid_inertia() -> np.ndarray:
    """Principal moments (3,) of the particles of the cuboid at spacing 0.1, points of mass: m (n^2 - 1) dp^2 / 12."""
    squares = (np.rint(np.array(CUBOID) / 0.1) ** 2 - 1.0) * 0.1**2 / 12.0
    return DENSITY * np.prod(CUBOID) * (squares.sum() - squares)


def spinning(spin, end, max_step) -> Simulation:
    """The cuboid that turns about its centre with an angular velocity (3,) [rad/s]."""
    a, b, c = (float(w) for w in spin)
    x, y, z = "(x-0.3)", "(y-0.2)", "(z-0.1)"
    velocity = [f"{b}*{z} - {c}*{y}", f"{c}*{x} - {a}*{z}", f"{a}*{y} - {b}*{x}"]
    return rigid_block(CUBOID, end=end, max_step=max_step, structure={"velocity": velocity})


def euler(spin, times) -> np.ndarray:
    """Attitudes (n, 3, 3) of the cuboid by Euler's equations in body axes and dR/dt = R [Omega]."""
    inertia = cuboid_inertia()

    def rate(_, state):
        omega, frame = state[:3], state[3:].reshape(3, 3)
        return np.concatenate([-np.cross(omega, inertia * omega) / inertia, np.cross(frame, omega).ravel()])

    begin = np.concatenate([spin, np.eye(3).ravel()])
    solution = solve_ivp(rate, (0.0, times[-1]), begin, "DOP853", times, rtol=1e-12, atol=1e-12)
    return solution.y[3:].T.reshape(-1, 3, 3)


def attitude(simulation) -> np.ndarray:
    """The rotation that takes the particles from where they rest to where they are (Kabsch)."""
    rest, now = reference_of(simulation.system), positions(simulation)
    return Rotation.align_vectors(now - now.mean(axis=0), rest - rest.mean(axis=0))[0].as_matrix()


TUMBLING = (0.3, 5.0, 0.0)
"""Almost about the middle axis, which is unstable: the body flips over and back."""


def test_a_tumbling_body_follows_eulers_equations_through_flips():
    """The error is of second order in the step; the attitude is compared over two flips."""
    times = np.linspace(0.0, 6.0, 13)
    exact = euler(TUMBLING, times)
    assert exact[:, 1, 1].min() < -0.9  # it does flip
    errors = []
    for step in (None, 4e-3, 2e-3):
        simulation = spinning(TUMBLING, 6.0, step)
        off = []
        for time, frame in zip(times[1:], exact[1:], strict=True):
            simulation.advance(time)
            off.append(np.abs(attitude(simulation) - frame).max())
        errors.append(max(off))
    assert errors[0] < 2e-3
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2.0, abs=0.2)


def test_a_tumbling_body_keeps_energy_and_angular_momentum():
    """L to rounding; the energy oscillates by (omega dt)^2/100 and has no trend in a hundred turns."""
    simulation = spinning(TUMBLING, 120.0, 0.02)
    start = simulation.ledger()
    off = []
    for k in range(1, 121):
        simulation.advance(float(k))
        ledger = simulation.ledger()
        off.append(ledger.kinetic_energy / start.kinetic_energy - 1.0)
        assert ledger.angular_momentum == pytest.approx(start.angular_momentum, abs=1e-11 * DENSITY)
    assert np.abs(off).max() < 1e-4
    assert abs(np.mean(off[60:]) - np.mean(off[:60])) < 2e-5


def test_a_pendulum_takes_its_exact_quarter_period():
    """A horizontal bar released about its end: T/4 = sqrt(I / m g d) K(sin^2 45 degrees), to second order."""
    bar, g = (0.8, 0.1), 10.0
    offset, mass = 0.4, DENSITY * 0.08
    inertia = mass * (0.1**2 * (8**2 - 1) / 12.0 + offset**2)
    quarter = np.sqrt(inertia / (mass * g * offset)) * ellipk(0.5)
    hinge = {"free": ["rz"], "pivot": [0.0, 0.05]}
    errors = []
    for steps in (40, 80):
        simulation = rigid_block(bar, hinge, end=quarter, max_step=quarter / steps, gravity=(0.0, -g))
        simulation.advance(quarter)
        errors.append(abs(motion(simulation)["angle"][2] + np.pi / 2.0))
    assert errors[0] < 1e-3
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)


def test_a_load_beside_a_fixed_axis_turns_the_body():
    """A force F along y at the arm r from the axis: I omega^2 / 2 = F r sin(theta), which is the work of the load."""
    loads = {"push": {"type": "force", "region": region((0.7, 0.0), (0.8, 0.1)), "value": (0.0, 150.0)}}
    simulation = rigid_block((0.8, 0.1), {"free": ["rz"], "pivot": [0.0, 0.05]}, end=0.6, max_step=1e-3,
                             structure={"loads": loads})  # fmt: skip
    inertia = DENSITY * 0.08 * (0.1**2 * (8**2 - 1) / 12.0 + 0.4**2)
    for time in (0.2, 0.4, 0.6):
        simulation.advance(time)
        found, ledger = motion(simulation), simulation.ledger()
        gained = 0.5 * inertia * found["spin"][2] ** 2
        # The error of Verlet's energy is of second order: (omega dt)^2 with omega up to 4 rad/s.
        assert gained == pytest.approx(150.0 * 0.75 * np.sin(found["angle"][2]), rel=1e-4)
        assert ledger.energies["work"] == pytest.approx(ledger.kinetic_energy, rel=1e-4)
    assert found["angle"][2] > 0.8


def test_a_body_moves_along_its_free_axis_alone():
    """A force across a heave-only body and its torque do nothing: y = F_y t^2 / 2 m, exactly."""
    loads = {"push": {"type": "force", "region": region((0.0, 0.0), (0.1, 0.4)), "value": (300.0, 80.0)}}
    simulation = rigid_block(rigid={"free": ["y"]}, structure={"loads": loads})
    simulation.advance(1.0)
    shift = host_view(simulation.array("displacement"))
    assert shift[:, 1] == pytest.approx(0.5 * 80.0 / (DENSITY * 0.16), abs=1e-14)
    assert np.abs(shift[:, 0]).max() == 0.0
    assert motion(simulation)["torque"][2] == pytest.approx(-80.0 * 0.15)


def test_a_body_about_two_axes_keeps_its_energy():
    """Held about z, free about x and y: the constraint does no work, and L about the free axes stays."""
    velocity = ["2.0*(z-0.1)", "-1.0*(z-0.1)", "1.0*(y-0.2) - 2.0*(x-0.3)"]
    simulation = rigid_block(CUBOID, {"free": ["rx", "ry"]}, end=20.0, max_step=0.02,
                             structure={"velocity": velocity})  # fmt: skip
    before, spin = simulation.ledger().kinetic_energy, motion(simulation)["spin"]
    simulation.advance(20.0)
    after = motion(simulation)["spin"]
    assert after[2] == 0.0
    assert np.abs(after - spin).max() > 0.1
    # (omega dt)^2 / 100 with omega = 2.2 rad/s
    assert simulation.ledger().kinetic_energy == pytest.approx(before, rel=1e-4)


def test_axes_that_are_not_free_follow_their_motion():
    """Swayed and turned as prescribed with the heave free: the laws to rounding, and every joule accounted for."""
    law = {
        "type": "sinusoid",
        "translation": (0.1, 0.3),
        "rotation": 20.0,
        "center": (0.2, 0.2),
        "frequency": 1.0,
    }
    errors = []
    for step in (4e-3, 2e-3):
        simulation = rigid_block(
            rigid={"free": ["y"], "motion": [law]}, end=0.3, max_step=step, gravity=(0.0, -10.0)
        )
        start, worst = total_of(simulation), 0.0
        for time in (0.1, 0.2, 0.3):
            simulation.advance(time)
            found, phase = motion(simulation), np.sin(2.0 * np.pi * time)
            assert found["position"][0] == pytest.approx(0.2 + 0.1 * phase, abs=1e-13)
            assert found["position"][1] == pytest.approx(0.2 - 5.0 * time**2, abs=1e-12)
            assert found["angle"][2] == pytest.approx(np.radians(20.0) * phase, abs=1e-13)
            worst = max(worst, abs(total_of(simulation) - start))
        errors.append(worst)
    assert errors[0] < 0.01 * simulation.ledger().kinetic_energy
    assert errors[1] < 0.3 * errors[0]


def total_of(simulation) -> float:
    ledger = simulation.ledger()
    return ledger.kinetic_energy + ledger.potential_energy - ledger.energies["work"]


def test_a_motion_turns_a_body_in_space():
    turn = {"type": "rotation", "center": (0.0, 0.0, 0.0), "axis": (1.0, 1.0, 0.0), "rate": 180.0}
    simulation = rigid_block(CUBOID, {"free": [], "motion": [turn]}, end=3.0, max_step=0.05)
    simulation.advance(3.0)
    expected = Rotation.from_rotvec(3.0 * np.pi * np.array([1.0, 1.0, 0.0]) / np.sqrt(2.0))
    assert positions(simulation) == pytest.approx(expected.apply(reference_of(simulation.system)), abs=1e-12)
    assert motion(simulation)["angle"] == pytest.approx(expected.as_rotvec() * 3.0, abs=1e-12)


def test_mass_inertia_and_centre_may_be_given():
    """A push F at an arm r about the given centre: v = F t / m and omega = F r t / I at first; weight acts there."""
    rigid = {"mass": 50.0, "inertia": [2.0], "center_of_mass": [0.1, 0.2], "free": ["x", "y", "rz"]}
    loads = {"push": {"type": "force", "region": region((0.3, 0.0), (0.4, 0.4)), "value": (0.0, 6.0)}}
    simulation = rigid_block(rigid=rigid, end=1e-3, gravity=(0.0, -10.0), structure={"loads": loads})
    assert simulation.ledger().mass == pytest.approx(50.0, rel=1e-12)
    simulation.advance(1e-3)
    found = motion(simulation)
    assert found["force"][:2] == pytest.approx([0.0, 6.0 - 500.0], abs=1e-10)
    assert found["torque"][2] == pytest.approx(6.0 * 0.25, rel=1e-4)
    assert found["velocity"][1] == pytest.approx((6.0 / 50.0 - 10.0) * 1e-3, rel=1e-9)
    assert found["spin"][2] == pytest.approx(6.0 * 0.25 / 2.0 * 1e-3, rel=1e-6)


def dropped_disc(precision="double", **changes) -> Simulation:
    """A disc that falls on a floor from a height of 0.2 m, and turns."""
    disc = {"shape": {"type": "sphere", "center": (0.0, 0.0), "radius": 0.5},
            "material": {"density": DENSITY, "youngs_modulus": 1e6, "poisson_ratio": 0.3},
            "rigid": {}, "velocity": ["-1.0*y", "1.0*x"]}  # fmt: skip
    floor = {"shape": region((-2.0, -0.8), (2.0, -0.7)), "side": "solid"}
    return simulate(touching({"disc": disc}, boundaries={"floor": floor}, gravity=(0.0, -9.81),
                             numerics={"precision": precision}, **changes))  # fmt: skip


@pytest.mark.parametrize("precision", ["single", "double"])
def test_a_disc_bounces_without_loss(precision):
    """Kinetic, potential and contact energy over several bounces, in parts of what the fall sets free (m g h)."""
    simulation = dropped_disc(precision)
    start = total(simulation)
    fallen, off, lowest, highest = simulation.ledger().mass * 9.81 * 0.2, [], np.inf, -np.inf
    for k in range(1, 101):
        simulation.advance(0.02 * k)
        off.append(abs(total(simulation) - start) / fallen)
        height = centre(simulation, "disc")[1]
        lowest, highest = min(lowest, height), max(highest, height if k > 40 else -np.inf)
    assert lowest < -0.19  # it touches
    assert highest > -0.05  # and comes up again
    assert max(off) < 5e-3


@pytest.mark.parametrize("dimension", [2, 3])
def test_rigid_bodies_collide_like_others(dimension):
    """Off the middle, so that they turn: momentum and angular momentum to rounding, energy within 1 %."""
    low, high, rest = (0.0,) * (dimension - 1), (0.4,) * (dimension - 1), [0.0] * (dimension - 1)
    raised = (0.42, 0.2, *low[1:]), (0.82, 0.6, *high[1:])
    left = body((0.0, *low), (0.4, *high), velocity=[1.0, *rest], rigid={})
    right = body(*raised, velocity=[-1.0, *rest], rigid={})
    simulation = simulate(
        touching({"left": left, "right": right}, dimension=dimension, time={"end": 0.2, "frame_rate": 5.0})
    )
    before, energy = simulation.ledger(), total(simulation)
    simulation.advance(0.2)
    after, momentum = simulation.ledger(), DENSITY * 0.4**dimension
    assert np.subtract(after.momentum, before.momentum) == pytest.approx(0.0, abs=1e-12 * momentum)
    assert np.subtract(after.angular_momentum, before.angular_momentum) == pytest.approx(
        0.0, abs=1e-11 * momentum
    )
    assert total(simulation) == pytest.approx(energy, rel=0.01)
    assert abs(motion(simulation, "left")["spin"][2]) > 0.5
    assert motion(simulation, "left")["velocity"][0] < 0.7


def test_a_flexible_body_bounces_off_a_rigid_one():
    """Both step together: momentum to rounding, energy within 1 %."""
    soft = body((0.0, 0.0), (0.4, 0.4), velocity=[1.0, 0.0])
    hard = body((0.42, 0.1), (0.82, 0.5), velocity=[-1.0, 0.0], rigid={})
    simulation = simulate(touching({"soft": soft, "hard": hard}, time={"end": 0.1, "frame_rate": 10.0}))
    before, energy = simulation.ledger(), total(simulation)
    simulation.advance(0.1)
    after = simulation.ledger()
    assert motion(simulation, "hard")["velocity"][0] > 0.0
    assert np.subtract(after.momentum, before.momentum) == pytest.approx(0.0, abs=1e-12 * 160.0)
    assert total(simulation) == pytest.approx(energy, rel=0.01)


def busy_scene():
    """Friction, a load with a time law, a prescribed axis and single precision: all that a state has to remember."""
    sway = [{"type": "sinusoid", "translation": (0.05, 0.0), "frequency": 5.0}]
    loads = {"push": {"type": "force", "region": region((0.0, 0.0), (0.1, 0.3)), "value": (0.0, -400.0),
                      "factor": "1+sin(40*t)"}}  # fmt: skip
    return touching(
        {"shaken": body((0.0, 0.0), (0.6, 0.3), rigid={"free": ["y", "rz"], "motion": sway}, loads=loads),
         "soft": body((0.7, 0.0), (1.0, 0.3), velocity=[-1.0, 0.0])},
        contact={"friction": 0.3}, gravity=(0.0, -9.81), numerics={"precision": "single"},
        boundaries={"floor": {"shape": region((-0.5, -0.1), (3.0, 0.0)), "side": "solid"}},
    )  # fmt: skip


def test_a_run_that_is_interrupted_ends_with_the_same_bits():
    whole = simulate(busy_scene())
    whole.advance(0.03)
    saved = {name: np.array(value) for name, value in whole.save_state().items()}
    whole.advance(0.1)
    resumed = simulate(busy_scene())
    resumed.load_state(saved)
    resumed.advance(0.1)
    assert resumed.step_count == whole.step_count
    for name, value in whole.save_state().items():
        assert np.array_equal(value, resumed.save_state()[name]), name


def test_steps_that_are_taken_back_leave_nothing_behind():
    """After a return to the state that was kept, the same steps lead to the same bits."""
    simulation = simulate(busy_scene())
    simulation.advance(0.02)
    stepper = simulation.system.stepper
    ends = []
    kept = stepper.keep_state()
    for _ in range(2):
        stepper.return_to(kept)
        stepper.find_forces_again()
        stepper.begin(1e-4, 5)
        for _ in range(5):
            stepper.sub_step()
        ends.append(
            {name: np.array(value) for name, value in stepper.rigid_motion().items()} | stepper.save()
        )
        ends[-1]["displacement"] = np.array(host_view(simulation.array("displacement")))
    for name, value in ends[0].items():
        assert np.array_equal(value, ends[1][name]), name


@pytest.mark.parametrize(
    ("velocity", "rigid"),
    [(["x", "0"], {}), (["1", "0"], {"free": ["y"]}), (["-y", "x"], {"free": ["x", "y"]})],
    ids=["strain", "held axis", "held rotation"],
)
def test_a_velocity_that_the_body_cannot_have_is_refused(velocity, rigid):
    with pytest.raises(SceneError, match=r"structures\.block\.velocity"):
        rigid_block(rigid=rigid, structure={"velocity": velocity})


def test_a_row_of_particles_does_not_turn_about_itself():
    with pytest.raises(SceneError, match=r"structures\.block\.rigid\.inertia"):
        rigid_block((0.4, 0.1, 0.1))


def immersed(precision) -> Simulation:
    """A light box that moves and turns inside a block of water, both without gravity and walls."""
    box = region((0.4, 0.3), (0.6, 0.5))
    water = {"type": "difference", "base": region((0.0, 0.0), (1.0, 0.8)), "subtract": [box]}
    velocity = ["1 - 5*(y-0.4)", "0.5 + 5*(x-0.5)"]
    float_ = body((0.4, 0.3), (0.6, 0.5), velocity=velocity, rigid={"mass": 20.0})
    return simulate(
        touching(
            {"float": float_},
            spacing=0.025,
            contact=None,
            fluids={"water": {"shape": water, "density": 1000.0}},
            numerics={"precision": precision},
        )
    )


@pytest.mark.parametrize(("precision", "rounding"), [("single", 1e-6), ("double", 1e-14)])
def test_what_water_loses_a_rigid_body_gains(precision, rounding):
    """Momentum of both together to rounding, while the body gives most of its own to the water."""
    simulation = immersed(precision)
    before = np.array(simulation.ledger().momentum)
    simulation.advance(0.1)
    assert motion(simulation, "float")["velocity"][0] < 0.5
    assert simulation.ledger().momentum == pytest.approx(before, abs=rounding * np.linalg.norm(before))


def test_a_coupled_run_that_is_interrupted_ends_with_the_same_bits():
    whole = immersed("single")
    whole.advance(0.02)
    saved = {name: np.array(value) for name, value in whole.save_state().items()}
    whole.advance(0.04)
    resumed = immersed("single")
    resumed.load_state(saved)
    resumed.advance(0.04)
    for name, value in whole.save_state().items():
        assert np.array_equal(value, resumed.save_state()[name]), name
