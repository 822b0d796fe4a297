"""The step of structures: order, balances, clamps that move, and the same bits however a run is cut."""

from itertools import pairwise

import numpy as np
import pytest
from structure_builders import DENSITY, YOUNG, block, deform, reference_of, region, system_of

from warpsph.particles.state import host_view
from warpsph.solver.simulation import Simulation

HELD = {"root": {"region": region((0.0, 0.0), (0.1, 0.3))}}
"""The first column of a beam."""
BENT = {"velocity": ["0", "x**2"]}


def beam(end: float = 0.1, max_step: float | None = None, **changes):
    """A cantilever, 0.8 m long and three particles thick, that begins to swing upwards."""
    structure = BENT | {"clamps": HELD} | changes.pop("structure", {})
    time = {"end": end, "frame_rate": 1.0 / end, "max_step": max_step}
    return block((0.8, 0.3), structure=structure, time=time, **changes)


def total(ledger) -> float:
    """Energy of the body less what was done on it, plus what it has lost [J]."""
    e = ledger.energies
    return ledger.kinetic_energy + e["strain"] + e["hourglass"] - e["work"] + e["dissipated"]


def run(scene, until: float) -> Simulation:
    simulation = Simulation(scene, device="cpu", threads=1)
    simulation.advance(until)
    return simulation


def displacement(simulation) -> np.ndarray:
    return np.array(simulation.array("displacement").numpy())


STEPS = (4e-4, 2e-4, 1e-4)


def test_the_step_is_of_second_order():
    """Halving the step divides the distance to the limit by four; 4/3 of the last difference is that distance."""
    ends = [displacement(run(beam(max_step=dt), 0.1)) for dt in (*STEPS, 5e-5)]
    differences = [np.linalg.norm(a - b) for a, b in pairwise(ends)]
    orders = np.log2(np.array(differences[:-1]) / differences[1:])
    assert orders == pytest.approx(2.0, abs=0.1)


def test_energy_does_not_drift_in_twenty_periods():
    """Fundamental period 2 pi / (1.8751^2 sqrt(E' I / rho A) / L^2) of the thin beam, L = 0.7 m, t = 0.3 m."""
    bending = np.sqrt(YOUNG / (1 - 0.3**2) * 0.3**2 / 12 / DENSITY) / 0.7**2
    period = 2 * np.pi / (1.8751**2 * bending)
    simulation = Simulation(beam(end=20 * period), device="cpu", threads=1)
    start = total(simulation.ledger())
    after = []
    for k in range(1, 21):
        simulation.advance(k * period)
        after.append(total(simulation.ledger()) / start - 1.0)
    assert simulation.ledger().energies["strain"] > 1e-3 * start
    # The bound is 0.5 %. Verlet's energy error is bounded, of second order in the step, without a trend.
    assert np.abs(after).max() < 5e-3
    assert abs(np.mean(after[10:]) - np.mean(after[:10])) < 1e-3


def balance_error(dt: float, **structure) -> float:
    """Largest change of the total, in parts of the largest kinetic energy."""
    simulation = Simulation(beam(max_step=dt, structure=structure), device="cpu", threads=1)
    start, worst, largest = total(simulation.ledger()), 0.0, 0.0
    for k in range(1, 11):
        simulation.advance(0.01 * k)
        ledger = simulation.ledger()
        worst = max(worst, abs(total(ledger) - start))
        largest = max(largest, ledger.kinetic_energy)
    return worst / largest


LOAD = {"tip": {"type": "force", "region": region((0.7, 0.0), (0.8, 0.3)), "value": (0.0, 2000.0),
                "factor": "sin(100*t)"}}  # fmt: skip
SHAKEN = {"root": {"region": region((0.0, 0.0), (0.1, 0.3)),
                   "motion": [{"type": "sinusoid", "translation": (0.0, 0.02), "frequency": 20.0}]}}  # fmt: skip


@pytest.mark.parametrize(
    "structure",
    [{}, {"loads": LOAD}, {"damping": 30.0}, {"clamps": SHAKEN}],
    ids=["free", "loaded", "damped", "shaken"],
)
def test_every_joule_is_accounted_for(structure):
    """Kinetic, strain and hourglass energy less work plus dissipation: constant but for terms of second order."""
    coarse, fine = (balance_error(dt, **structure) for dt in (2e-4, 1e-4))
    assert coarse < 5e-3
    assert fine < 0.35 * coarse


def test_viscous_damping_slows_a_free_body_exponentially():
    """dv/dt = -c v: v = v0 exp(-c t), to the second order of the step: (c dt)^2 / 12 of c t."""
    scene = block(
        (0.4, 0.4), structure={"velocity": [2.0, 0.0], "damping": 30.0}, time={"end": 0.1, "max_step": 1e-3}
    )
    velocity = host_view(run(scene, 0.1).array("velocity"))
    assert velocity[:, 0] == pytest.approx(2.0 * np.exp(-3.0), rel=1.5 * 3.0 * 0.03**2 / 12.0)
    assert np.abs(velocity[:, 1]).max() < 1e-12


def test_momentum_of_a_free_body_stays_to_rounding():
    """The spin of a body that deforms changes with the strain it stores, its linear and angular momentum do not."""
    scene = block((0.5, 0.4), structure={"velocity": ["1.0 + 3.0*y", "-2.0*x"]}, time={"end": 0.1})
    simulation = Simulation(scene, device="cpu", threads=1)
    before = simulation.ledger()
    simulation.advance(0.1)
    after = simulation.ledger()
    assert simulation.step_count > 40
    scale = before.mass * 3.0
    assert np.subtract(after.momentum, before.momentum) == pytest.approx(0.0, abs=1e-13 * scale)
    assert np.subtract(after.angular_momentum, before.angular_momentum) == pytest.approx(
        0.0, abs=1e-12 * scale
    )


def test_a_clamp_that_moves_follows_its_law():
    """u = A sin(2 pi f t) at the clamp, and the velocity that belongs to it, to rounding."""
    simulation = run(beam(structure={"clamps": SHAKEN}), 0.037)
    held = reference_of(simulation.system)[:, 0] < 0.1
    phase = 2 * np.pi * 20.0 * 0.037
    assert displacement(simulation)[held, 1] == pytest.approx(0.02 * np.sin(phase), abs=1e-13)
    assert displacement(simulation)[held, 0] == pytest.approx(0.0, abs=1e-15)
    velocity = host_view(simulation.array("velocity"))[held, 1]
    assert velocity == pytest.approx(0.02 * 2 * np.pi * 20.0 * np.cos(phase), rel=1e-10)


def test_a_clamp_that_turns_carries_its_particles_round():
    turn = {"type": "rotation", "center": (0.0, 0.15), "rate": float(np.degrees(3.0))}
    clamps = {"root": HELD["root"] | {"motion": [turn]}}
    simulation = run(beam(structure={"clamps": clamps, "velocity": ["-3.0*(y-0.15)", "3.0*x"]}), 0.1)
    X = reference_of(simulation.system)
    held = X[:, 0] < 0.1
    c, s = np.cos(0.3), np.sin(0.3)
    arm = X[held] - [0.0, 0.15]
    expected = arm @ np.array([[c, s], [-s, c]]) - arm
    assert displacement(simulation)[held] == pytest.approx(expected, abs=1e-13)


def test_a_clamp_of_one_axis_lets_the_other_slide():
    """A block that falls along y and is held along x: free fall, exact in a scheme of second order."""
    rail = {"rail": {"region": region((0.0, 0.0), (0.1, 0.4)), "axes": ["x"]}}
    scene = block((0.4, 0.4), gravity=(0.0, -10.0), structure={"clamps": rail}, time={"end": 0.1})
    simulation = run(scene, 0.1)
    assert displacement(simulation)[:, 1] == pytest.approx(-0.5 * 10.0 * 0.1**2, rel=1e-9)
    assert np.abs(displacement(simulation)[:, 0]).max() < 1e-12


def test_a_moving_clamp_of_one_axis_pulls_along_it_alone():
    pull = [{"type": "linear", "velocity": (0.5, 0.0)}]
    rail = {"rail": {"region": region((0.0, 0.0), (0.1, 0.4)), "axes": ["x"], "motion": pull}}
    scene = block((0.4, 0.4), gravity=(0.0, -10.0), structure={"clamps": rail, "velocity": [0.5, 0.0]},
                  time={"end": 0.1})  # fmt: skip
    shift = displacement(run(scene, 0.1))
    assert shift[:, 0] == pytest.approx(0.05, abs=1e-12)
    assert shift[:, 1] == pytest.approx(-0.05, rel=1e-9)


@pytest.mark.parametrize("precision", ["single", "double"])
def test_threads_do_not_change_a_bit(precision):
    ends = []
    for threads in (1, 2, 3):
        simulation = Simulation(beam(precision=precision), device="cpu", threads=threads)
        for part in passes_of(simulation):
            split(part)
        simulation.advance(0.02)
        ends.append(displacement(simulation))
    assert np.array_equal(ends[0], ends[1])
    assert np.array_equal(ends[0], ends[2])


def passes_of(simulation):
    model = simulation.system.parts.model
    return [model._drift, model._accelerate, *model._strain]


def split(one) -> None:
    """Cut a pass into chunks although it is too short for that to pay."""
    if one._launcher.threads > 1:
        one._trial, one._split, one._count = None, True, -1


def test_a_run_that_is_interrupted_ends_with_the_same_bits():
    """Loads, moving clamps and damping together: all that a state has to remember."""
    scene = beam(precision="single", structure={"clamps": SHAKEN, "loads": LOAD, "damping": 3.0})
    whole = Simulation(scene, device="cpu", threads=1)
    whole.advance(0.02)
    saved = whole.save_state()
    whole.advance(0.05)
    resumed = Simulation(scene, device="cpu", threads=1)
    resumed.load_state(saved)
    resumed.advance(0.05)
    assert resumed.step_count == whole.step_count
    for name, value in whole.save_state().items():
        assert np.array_equal(value, resumed.save_state()[name]), name


def test_a_periodic_bar_has_no_end():
    """Bonds reach across the period: a standing wave of one period stays odd under a shift by half of it.

    The linear law, because another one tells stretch from compression. The column at the edge is one like the others.
    """
    scene = block(
        (1.2, 0.3),
        material={"law": "linear_elastic"},
        domain={"periodic": {"x": (0.0, 1.2)}},
        time={"end": 0.05},
        structure={"displacement": ["1e-3*sin(2*pi*x/1.2)", "0"]},
    )
    simulation = run(scene, 0.02)
    X = reference_of(simulation.system)
    counts = simulation.system.parts.bonds.count
    middle_row = np.isclose(X[:, 1], 0.15)
    assert (counts[middle_row] == 8).all()
    u = displacement(simulation)
    order = np.lexsort((X[:, 0], X[:, 1]))
    rows = u[order].reshape(3, 12, 2)
    shifted = np.roll(rows, 6, axis=1)
    assert rows[..., 0] == pytest.approx(-shifted[..., 0], abs=1e-14)
    assert np.abs(rows[..., 0]).max() > 1e-4


def test_an_imposed_state_is_surveyed_at_once():
    """The smallest J of the state, and the largest stiffening of a stretched bar: E_11 stiffens with (3 s^2 - 1)/2."""
    one = system_of(block((0.9, 0.8)))
    deform(one, reference_of(one) * [0.2, 0.0])
    assert one.extremes["flattening"] == pytest.approx(-1.2, rel=1e-12)
    # dP/ds of the stretch P = s (lambda + 2 mu)(s^2 - 1)/2, over that at rest; the probe is a difference of 1e-3.
    assert one.extremes["stiffening"] == pytest.approx((3 * 1.2**2 - 1) / 2, rel=3e-3)


def test_steps_that_the_state_outgrows_are_repeated_with_care():
    """Pulled apart at half the speed of sound, a body stiffens to more than twice within a batch of 32 steps.

    Made again with a look after each, these are more and shorter steps to the same time.
    """
    one = system_of(block((0.6, 0.4), structure={"velocity": ["60*(x-0.3)", "0"]}))
    start = one.ledger().kinetic_energy
    report = one.step(0)
    assert report.count > 32
    assert one.time == 32 * report.dt
    ledger = one.ledger()
    stored = ledger.energies["strain"] + ledger.energies["hourglass"]
    assert ledger.kinetic_energy + stored == pytest.approx(start, rel=0.05)
