"""A column of water a hundred times taller than it is wide: pressure at its foot after a way of many particles."""

import numpy as np
import pytest

from warpsph.scene.schema import Scene
from warpsph.solver.simulation import Simulation

WIDTH, HEIGHT, GRAVITY, DENSITY = 0.1, 10.0, 9.81, 1000.0
ACROSS = 4


def test_a_tall_column_carries_its_weight_to_the_foot():
    """Four particles across, 400 above each other.

    The particles settle, and the column rings with the period 4 H/c, of 2000 steps; the mean over one of them counts.
    In weakly compressible water the pressure at the foot is small, g H = c^2 / 200: a speed of a four thousandth of the
    sound speed makes a sound of 5 % of it, and that is what is left of the settling.
    """
    shape = {"type": "box", "min": (0.0, 0.0), "max": (WIDTH, HEIGHT)}
    vessel = {"type": "box", "min": (0.0, 0.0), "max": (WIDTH, HEIGHT + WIDTH)}
    scene = Scene(
        name="tall_column",
        dimension=2,
        spacing=WIDTH / ACROSS,
        gravity=(0.0, -GRAVITY),
        time={"end": 1.0, "frame_rate": 1.0},
        fluids={"water": {"shape": shape, "density": DENSITY}},
        boundaries={"vessel": {"shape": vessel, "side": "outside", "open": ("y_max",)}},
    )
    simulation = Simulation(scene, device="cpu", threads=1)
    period = 4.0 * HEIGHT / simulation.sound_speed
    gradients, energies = [], []
    for time in period * np.linspace(0.75, 1.75, 9)[1:]:
        simulation.advance(time)
        water = simulation.frame(["velocity", "pressure"]).sets[0].fields
        height = water["position"][:, 1]
        gradients.append(-np.polyfit(height, water["pressure"], 1)[0] / (DENSITY * GRAVITY))
        energies.append(simulation.ledger().kinetic_energy)
        assert (water["position"][:, 0] > 0.0).all()
        assert (water["position"][:, 0] < WIDTH).all()
    assert np.mean(gradients) == pytest.approx(1.0, abs=0.05)
    # Of what the column could set free by falling over, m g H / 2.
    assert max(energies) < 1e-4 * DENSITY * WIDTH * HEIGHT * GRAVITY * HEIGHT / 2.0
