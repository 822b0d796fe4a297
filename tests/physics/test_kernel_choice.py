"""Every smoothing kernel and state runs through lists, walls and step with its own support."""

import numpy as np
import pytest
from builders import GRAVITY, still_tank

from warpsph.laws.smoothing import SMOOTHING_LAWS
from warpsph.solver.simulation import Simulation

SPACING = 0.05


@pytest.mark.parametrize("kernel", SMOOTHING_LAWS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_still_tank_stays_still(kernel, dimension):
    # At one support radius, 3 dp. Before anything moves the only error is that of the kernel sums, which is a small
    # part of gravity; without the right layers of wall or lists of the right reach it is of the order of gravity.
    h_over_dp = 3.0 / SMOOTHING_LAWS[kernel].support
    scene = still_tank(dimension, SPACING, numerics={"kernel": kernel, "h_over_dp": h_over_dp})
    sim = Simulation(scene, device="cpu")
    sim.step()
    water = sim.frame(["velocity"]).sets[0].fields
    deep = water["position"][:, -1] < 0.5 - 3.0 * SPACING
    acceleration = sim.array("acceleration").numpy()[: len(deep)]
    by_id = acceleration[np.argsort(sim.array("id").numpy()[: len(deep)])]
    assert np.abs(by_id[deep]).max() < 0.25 * GRAVITY


@pytest.mark.parametrize("kernel", ["wendland_c2", "quintic_spline"])
def test_walls_are_as_thick_as_the_support(kernel):
    scene = still_tank(2, SPACING, numerics={"kernel": kernel, "h_over_dp": 1.5})
    sim = Simulation(scene, device="cpu")
    floor = sim.frame(["velocity"]).set_named("tank").fields["position"][:, 1].min()
    layers = np.ceil(1.5 * SMOOTHING_LAWS[kernel].support - 1e-9)
    assert floor == pytest.approx(-(layers - 0.5) * SPACING, abs=1e-9)


def test_the_linear_state_is_what_the_frame_shows():
    scene = still_tank(numerics={"state": {"type": "linear"}})
    sim = Simulation(scene, device="cpu")
    start = sim.frame(["pressure"]).sets[0].fields
    depth = 0.5 - start["position"][:, 1]
    assert start["pressure"] == pytest.approx(1000.0 * GRAVITY * depth, rel=1e-5)
    sim.advance(0.02)
    fields = sim.frame(["pressure", "density"]).sets[0].fields
    expected = sim.sound_speed**2 * (fields["density"] - 1000.0)
    assert fields["pressure"] == pytest.approx(expected, rel=1e-5, abs=1e-2)
