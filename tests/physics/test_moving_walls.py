"""Prescribed motion of walls: what the fluid feels is the motion, and no particle gets through."""

import numpy as np
import pytest
from builders import closed_vessel

from warpsph.sampling.distance import signed_distance
from warpsph.solver.simulation import Simulation

pytestmark = pytest.mark.verification

AMPLITUDE, FREQUENCY = 0.05, 1.0
OMEGA = 2.0 * np.pi * FREQUENCY


def test_a_vessel_at_constant_velocity_carries_its_fluid_along():
    # Galilean invariance: nothing but the common translation happens.
    scene = closed_vessel(velocity=(0.7, 0.0), motion=[{"type": "linear", "velocity": (0.7, 0.0)}])
    sim = Simulation(scene, device="cpu")
    before = sim.frame(["velocity"]).sets[0].fields["position"]
    sim.advance(0.2)
    water, vessel = (s.fields for s in sim.frame(["velocity"]).sets)
    assert water["position"] - before == pytest.approx(np.tile([0.14, 0.0], (len(before), 1)), abs=1e-5)
    assert vessel["velocity"] == pytest.approx(np.tile([0.7, 0.0], (len(vessel["velocity"]), 1)), abs=1e-6)


def test_a_shaken_vessel_feels_the_inertia_of_its_fluid():
    # x = A sin(omega t) with the fluid at the vessel's first speed: the fluid is carried along as one body, so the
    # force of the fluid on the vessel is m A omega^2 sin(omega t).
    motion = [{"type": "sinusoid", "translation": (AMPLITUDE, 0.0), "frequency": FREQUENCY}]
    numerics = {"wall": {"type": "extrapolated", "suction": True}}
    scene = closed_vessel(velocity=(AMPLITUDE * OMEGA, 0.0), motion=motion, numerics=numerics)
    sim = Simulation(scene, device="cpu")
    for t in (0.15, 0.25, 0.35):
        sim.advance(t)
        water, vessel = (s.fields for s in sim.frame(["mass", "force"]).sets)
        inertia = water["mass"].sum() * AMPLITUDE * OMEGA**2 * np.sin(OMEGA * t)
        assert vessel["force"][:, 0].sum() == pytest.approx(inertia, rel=0.05)


@pytest.mark.parametrize("wall", ["extrapolated", "dynamic"])
def test_a_rolling_half_full_vessel_does_not_leak(wall):
    motion = [{"type": "sinusoid", "rotation": 20.0, "center": (0.5, 0.25), "frequency": FREQUENCY}]
    scene = closed_vessel(filling=0.5, gravity=(0.0, -9.81), motion=motion, numerics={"wall": {"type": wall}})
    sim = Simulation(scene, device="cpu")
    sim.advance(1.0)  # after a whole period the vessel is back where it began
    water = sim.frame(["velocity"]).sets[0].fields["position"]
    # A particle lies half a spacing before the wall at rest; in a splash it may come closer, but not through.
    assert signed_distance(scene.boundaries["vessel"].shape, water).max() < 0.0
