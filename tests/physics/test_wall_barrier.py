"""Walls keep disordered fluid in, do not pull it, and leave ordered fluid alone."""

from dataclasses import replace

import numpy as np
import pytest
from builders import still_tank

from warpsph.sampling import sample
from warpsph.solver import simulation
from warpsph.solver.simulation import Simulation


def jittered_tank(monkeypatch, dimension: int, wall: str) -> Simulation:
    """A tank whose water begins up to 0.4 spacings off its lattice."""

    def disturbed(scene):
        rng = np.random.default_rng(0)
        water, tank = sample(scene)
        shift = rng.uniform(-0.4, 0.4, water.position.shape) * scene.spacing
        return replace(water, position=water.position + shift), tank

    monkeypatch.setattr(simulation, "sample", disturbed)
    return Simulation(still_tank(dimension, numerics={"wall": {"type": wall}}), device="cpu")


def mechanical_energy(sim: Simulation) -> float:
    ledger = sim.ledger()
    return ledger.kinetic_energy + ledger.potential_energy


@pytest.mark.verification
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("wall", ["extrapolated", "dynamic", "modified_dynamic", "repulsive"])
def test_disordered_water_stays_in_and_gains_no_energy(monkeypatch, dimension, wall):
    """What its disorder has let go as sound is gone after 0.1 s; from then on the water only settles."""
    sim = jittered_tank(monkeypatch, dimension, wall)
    energies = []
    for time in (0.1, 0.3, 0.6, 1.0, 1.5):
        sim.advance(time)
        energies.append(mechanical_energy(sim))
    water = sim.frame(["velocity"]).sets[0].fields["position"]
    width, half_spacing = 0.5, 0.025
    inside = np.column_stack([water[:, :-1], width - water[:, :-1], water[:, -1:]])
    assert inside.min() > -half_spacing
    assert np.all(np.diff(energies) < 0.0)


@pytest.mark.parametrize("dimension", [2, 3])
def test_normals_point_out_of_the_surface_and_only_there(dimension):
    sim = Simulation(still_tank(dimension), device="cpu")
    walls = sim.system.parts.walls.motion
    position, normal = walls.reference.numpy(), walls.reference_normal.numpy()
    up = np.eye(dimension)[-1]
    middle = np.all(np.abs(position[:, :-1] - 0.25) < 0.08, axis=1)
    below = -position[:, -1] / 0.05
    first, second = middle & (np.abs(below - 0.5) < 0.1), middle & (np.abs(below - 1.5) < 0.1)
    assert normal[first] == pytest.approx(np.tile(up, (first.sum(), 1)), abs=1e-5)
    assert not normal[second].any()


def test_water_at_rest_does_not_feel_the_barrier(monkeypatch):
    # A spacing away from the first wall layer is beyond the reach of 0.6 spacings: bit for bit the same.
    ends = []
    for strength in (0.4, 0.0):
        monkeypatch.setattr("warpsph.physics.fluid.BARRIER_STRENGTH", strength)
        sim = Simulation(still_tank(), device="cpu")
        for _ in range(50):
            sim.step()
        ends.append(sim.frame(["velocity"]).sets[0].fields["position"])
    assert np.array_equal(ends[0], ends[1])


def fallen_below_a_ceiling(suction: bool) -> float:
    """How far water falls in 0.3 s that begins without pressure under a plate [m]."""
    scene = still_tank()
    water = scene.fluids["water"].model_dump() | {
        "shape": {"type": "box", "min": (0.0, 0.0), "max": (0.5, 0.2)},
        "pressure": {"type": "uniform", "value": 0.0},
    }
    plate = {"shape": {"type": "box", "min": (-0.2, 0.2), "max": (0.7, 0.4)}, "side": "solid"}
    changes = {
        "fluids": {"water": water},
        "boundaries": {"plate": plate},
        "numerics": scene.numerics.model_dump() | {"wall": {"type": "extrapolated", "suction": suction}},
    }
    sim = Simulation(type(scene)(**(scene.model_dump() | changes)), device="cpu")
    sim.advance(0.3)
    return float(0.1 - sim.frame(["velocity"]).sets[0].fields["position"][:, 1].mean())


def test_water_below_a_ceiling_falls():
    # Free fall but for a short pull while the first gap opens, in which the water itself is under tension.
    free_fall = 0.5 * 9.81 * 0.3**2
    fallen = fallen_below_a_ceiling(suction=False)
    assert 0.85 * free_fall < fallen < 1.001 * free_fall
    assert fallen_below_a_ceiling(suction=True) < fallen - 0.1
