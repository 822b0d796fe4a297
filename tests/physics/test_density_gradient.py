"""Density diffusion without the renormalised gradient (Antuono et al. 2010)."""

import numpy as np
import pytest
from builders import GRAVITY, still_tank

from warpsph.solver.simulation import Simulation

LINEAR = {"precision": "double", "state": {"type": "linear"}}


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_linear_density_has_its_gradient_and_is_not_diffused(dimension):
    # Water at rest under a linear state: grad rho = rho0 g / c0^2 up to the surface and at the floor, and a term that
    # vanishes for linear densities leaves the rate of a fluid without motion at zero. The step of 1e-9 s moves nothing.
    numerics = LINEAR | {"density_diffusion": {"type": "delta_sph"}}
    sim = Simulation(still_tank(dimension, numerics=numerics, time={"max_step": 1e-9}), device="cpu")
    sim.step()
    count = len(sim.frame().sets[0].fields["id"])
    slope = -1000.0 * GRAVITY / sim.sound_speed**2
    gradient = sim.system.parts.fluid._density_gradient.gradient.numpy()
    expected = np.zeros_like(gradient)
    expected[:, -1] = slope
    assert gradient == pytest.approx(expected, abs=1e-6 * abs(slope))
    rate = sim.system.parts.assembly.state.density_rate.numpy()[:count]
    scale = sim.sound_speed * abs(slope)
    assert np.abs(rate).max() < 1e-6 * scale


def test_without_the_gradient_the_surface_is_diffused():
    # What the term above takes away: the same tank, of the order of delta c0 grad rho.
    numerics = LINEAR | {"density_diffusion": {"type": "molteni_colagrossi"}}
    sim = Simulation(still_tank(numerics=numerics, time={"max_step": 1e-9}), device="cpu")
    sim.step()
    rate = sim.system.parts.assembly.state.density_rate.numpy()
    assert np.abs(rate).max() > 0.02 * 1000.0 * GRAVITY / sim.sound_speed
