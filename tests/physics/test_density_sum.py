"""Density by summation and the mixed form."""

import numpy as np
import pytest
from builders import GRAVITY, closed_vessel, free_drop, still_tank

from warpsph.laws.smoothing import SMOOTHING_LAWS
from warpsph.physics.summation import lattice_sum
from warpsph.scene.schema import Scene
from warpsph.solver.simulation import Simulation

SUMMED = {"density": "summation", "density_diffusion": {"type": "none"}}


def sum_over_all(position: np.ndarray, scene: Scene) -> np.ndarray:
    """rho over rho0 at every particle by brute force, on the scale of the lattice."""
    h, dim = scene.numerics.h_over_dp * scene.spacing, scene.dimension
    distance = np.linalg.norm(position[:, None] - position[None, :], axis=2)
    law = SMOOTHING_LAWS[scene.numerics.kernel]
    weights = law.value(distance / h, dim) / h**dim * scene.spacing**dim
    return weights.sum(axis=1) / lattice_sum(scene)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("kernel", SMOOTHING_LAWS)
def test_lattice_sum_is_nearly_one(dimension, kernel):
    # It is the midpoint rule for the integral of the kernel, which is one.
    scene = free_drop(dimension, numerics={"kernel": kernel})
    assert lattice_sum(scene) == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_density_is_the_sum_over_all_particles(dimension):
    sim = Simulation(
        free_drop(dimension, 0.2, numerics=SUMMED | {"precision": "double", "sound_speed": 100.0}),
        device="cpu",
    )
    position = sim.array("position").numpy()
    position += np.random.default_rng(2).uniform(-0.02, 0.02, position.shape)
    sim.system.stepper.renew_lists()
    before = sim.array("position").numpy().copy()
    sim.system.parts.fluid.synchronise()
    sim.system.parts.fluid._density_sum.find()
    found = 1.0 + sim.array("density_deviation").numpy() / 1000.0
    # Positions are kept in double precision; the deviation is one minus a sum of some ten terms.
    assert found == pytest.approx(sum_over_all(before, sim.scene), rel=1e-12)


@pytest.mark.parametrize("density", [SUMMED, {"density": "mixed"}], ids=["summation", "mixed"])
def test_a_full_vessel_at_rest_stays_at_rest(density):
    # The lattice that fills the vessel has the density at rest, beside the walls too.
    sim = Simulation(closed_vessel(numerics=density), device="cpu")
    sim.advance(0.05)
    water = sim.frame(["velocity", "pressure"]).sets[0].fields
    assert np.abs(water["velocity"]).max() < 1e-4
    assert np.abs(water["pressure"]).max() < 1e-3 * 1000.0 * 30.0**2 * 1e-2


@pytest.mark.verification
@pytest.mark.parametrize("dimension", [2, 3])
def test_mixed_keeps_water_under_its_surface(dimension):
    # Water begins on the lattice, which has the density at rest, and bounces about the strain that bears its weight,
    # with the period 4 H / c0 = 0.065 s; over several of them the mean pressure is hydrostatic. At the surface a
    # plain sum would miss half of the neighbours, and its pressure be off by a fifth of rho0 c0^2.
    sim = Simulation(still_tank(dimension, numerics={"density": "mixed"}), device="cpu")
    samples = []
    for time in np.arange(0.2, 0.6, 0.013):
        sim.advance(time)
        water = sim.frame(["velocity", "pressure"]).sets[0].fields
        samples.append(water["pressure"] - 1000.0 * GRAVITY * (0.5 - water["position"][:, -1]))
    error = np.mean(samples, axis=0) / (1000.0 * GRAVITY * 0.5)
    assert water["position"][:, -1].max() == pytest.approx(0.475, abs=0.02)
    assert np.sqrt(np.mean(error**2)) < 0.1


def test_a_sum_is_not_diffused():
    with pytest.raises(ValueError, match="density_diffusion"):
        free_drop(numerics={"density": "summation"})


@pytest.mark.parametrize("dimension", [2, 3])
def test_mixed_conserves_momentum_to_rounding(dimension):
    sim = Simulation(free_drop(dimension, numerics={"density": "mixed", "precision": "double"}), device="cpu")

    def momentum() -> np.ndarray:
        water = sim.frame(["velocity", "mass"]).sets[0].fields
        return (water["mass"][:, None] * water["velocity"]).sum(axis=0)

    before = momentum()
    for _ in range(20):
        sim.step()
    assert np.abs(momentum() - before).max() < 1e-14 * 1000.0


def test_lattice_sites_of_the_sum():
    # Cubic spline, h = dp, two dimensions, by hand: 10/(7 pi) [1 + 4 (1/4) + 4 (2 - sqrt 2)^3 / 4].
    scene = free_drop(numerics={"kernel": "cubic_spline", "h_over_dp": 1.0})
    by_hand = 10.0 / (7.0 * np.pi) * (1.0 + 1.0 + (2.0 - np.sqrt(2.0)) ** 3)
    assert lattice_sum(scene) == pytest.approx(by_hand, rel=1e-12)
