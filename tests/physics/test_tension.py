"""Fluid under tension: it parts at the cutoff and holds without; a background pressure spreads particles."""

import numpy as np
import pytest
from builders import free_drop

from warpsph.laws.smoothing import SMOOTHING_LAWS
from warpsph.scene.schema import Scene
from warpsph.solver.simulation import Simulation

SPEED, SOUND_SPEED, DENSITY, END = 0.2, 10.0, 1000.0, 1.0
TENSION = DENSITY * SOUND_SPEED * SPEED
"""Of two halves that are pulled apart at twice the speed, 2000 Pa (Joukowsky 1898)."""


def torn_drop(cutoff: float | None, dimension: int = 2, spacing: float = 0.05) -> Scene:
    """A square drop whose halves fly apart, each at SPEED."""
    scene = free_drop(dimension, spacing).model_dump()
    outwards = f"{2 * SPEED} * (x > 0.5) - {SPEED}"
    scene["fluids"]["water"]["velocity"] = (outwards, *(0.0,) * (dimension - 1))
    scene["numerics"]["tension_cutoff"] = cutoff
    return Scene(**scene)


def run(scene: Scene) -> tuple[float, float]:
    """Widest gap along x at the end [m], and the lowest pressure until then [Pa]."""
    sim = Simulation(scene, device="cpu")
    lowest = 0.0
    for time in np.linspace(0.0, END, 21)[1:]:
        sim.advance(time)
        fields = sim.frame(["pressure"]).sets[0].fields
        lowest = min(lowest, float(fields["pressure"].min()))
    return float(np.diff(np.sort(fields["position"][:, 0])).max()), lowest


@pytest.mark.parametrize(("dimension", "spacing"), [(2, 0.05), (3, 0.125)])
def test_a_gap_opens_as_fast_as_the_halves_part(dimension, spacing):
    # Nothing holds the halves: the gap is 2 U t, and a spacing lies between neighbours as it is.
    gap, lowest = run(torn_drop(0.0, dimension, spacing))
    assert gap == pytest.approx(2.0 * SPEED * END + spacing, abs=spacing)
    assert lowest == 0.0


def test_without_a_cutoff_the_fluid_holds_the_tension():
    gap, lowest = run(torn_drop(None))
    assert gap < 0.1
    assert lowest < -0.5 * TENSION


def test_tension_up_to_the_cutoff_is_held():
    gap, lowest = run(torn_drop(-2.0 * TENSION))
    assert (gap, lowest) == pytest.approx(run(torn_drop(None)))
    gap, lowest = run(torn_drop(-0.1 * TENSION))
    assert lowest == pytest.approx(-0.1 * TENSION)
    assert gap > 0.2


def test_the_cutoff_holds_for_walls_with_suction():
    """A piston that leaves a full cylinder at 1 m/s: the wall may pull as hard as the fluid holds, and not harder."""
    cutoff = -500.0
    scene = free_drop(numerics={"tension_cutoff": cutoff, "wall": {"type": "extrapolated", "suction": True}})
    scene = scene.model_dump()
    scene["fluids"]["water"]["velocity"] = None
    scene["boundaries"] = {
        "piston": {
            "shape": {"type": "box", "min": (1.0, 0.0), "max": (1.5, 1.0)},
            "side": "solid",
            "motion": [{"type": "linear", "velocity": (1.0, 0.0)}],
        }
    }
    sim = Simulation(Scene(**scene), device="cpu")
    sim.advance(0.05)
    pressures = [s.fields["pressure"].min() for s in sim.frame(["pressure"]).sets]
    assert pressures == pytest.approx([cutoff, cutoff])


def test_background_pressure_acts_as_its_sum():
    """dv/dt = -2 p_b V / m sum_b V grad W_ab, on particles at random places."""
    background = 50.0
    accelerations = []
    for p_b in (0.0, background):
        scene = free_drop(numerics={"precision": "double", "background_pressure": p_b})
        sim = Simulation(scene, device="cpu")
        sim.array("position").numpy()[:] += np.random.default_rng(3).uniform(-0.02, 0.02, (100, 2))
        sim.step()
        order = np.argsort(sim.array("id").numpy())
        accelerations.append(sim.array("acceleration").numpy()[order])
        middle = sim.array("position").numpy()[order]
    difference = accelerations[1] - accelerations[0]
    law, h, step = SMOOTHING_LAWS[scene.numerics.kernel], 0.15, 1e-6
    middle = middle - 0.5 * sim.last_step.dt * sim.array("velocity_volume").numpy()[order][:, :2]
    x_ab = middle[:, None] - middle[None]
    r = np.linalg.norm(x_ab, axis=2)
    np.fill_diagonal(r, 1.0)
    slope = (law.value(r / h + step, 2) - law.value(r / h - step, 2)) / (2.0 * step * h**3)
    grad = (slope / r)[..., None] * x_ab
    expected = -2.0 * background / DENSITY * 0.01 * grad.sum(axis=1)
    assert np.abs(difference - expected).max() < 0.02 * np.abs(expected).max()


def test_background_pressure_moves_particles_apart():
    """In a periodic box at rest with disorder; the pressure of the state alone lets pairs stay close."""
    water = free_drop(spacing=0.05).model_dump()
    water["domain"]["periodic"] = {"x": (0.0, 1.0), "y": (0.0, 1.0)}
    water["fluids"]["water"]["velocity"] = None
    distances = []
    for p_b in (0.0, 1.0e4):
        water["numerics"]["background_pressure"] = p_b
        sim = Simulation(Scene(**water), device="cpu")
        sim.array("position").numpy()[:] += np.random.default_rng(5).uniform(-0.015, 0.015, (400, 2))
        sim.advance(0.2)
        position = np.mod(sim.frame().sets[0].fields["position"], 1.0)
        apart = np.abs(position[:, None] - position[None])
        r = np.linalg.norm(np.minimum(apart, 1.0 - apart), axis=2)
        np.fill_diagonal(r, 1.0)
        distances.append(r.min() / 0.05)
    assert distances[1] > distances[0] + 0.1
