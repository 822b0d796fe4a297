"""Open boundaries: what passes through them, what does not come back, and what stays what it was."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from open_boundary_builders import DP, channel, pipe
from scipy.spatial import cKDTree

from warpsph.particles.state import host_view
from warpsph.probes import make_probe
from warpsph.scene import Scene
from warpsph.solver.simulation import Simulation
from warpsph.validation.hard.open_boundaries import channel as obstructed_channel

NUMERICS = {"sound_speed": 20.0, "wall": {"type": "extrapolated", "suction": True}}


def fluid(sim: Simulation, *fields: str) -> dict[str, np.ndarray]:
    return dict(sim.frame(["position", *fields]).of_kind("fluid")[0].fields)


def closest(points: np.ndarray) -> float:
    """Smallest distance between two particles, in spacings."""
    return float(cKDTree(points).query(points, k=2)[0][:, 1].min()) / DP


def jet() -> Scene:
    """Fluid enters a long channel that is nearly empty at first."""
    scene = channel(time={"end": 1.5, "frame_rate": 10.0})
    data = scene.model_dump()
    data["fluids"]["water"]["shape"]["max"] = (0.3, 1.0)
    del data["open_boundaries"]["outlet"]
    return Scene.model_validate(data)


PLUGS = {
    "2d": lambda: channel(time={"end": 2.0, "frame_rate": 10.0}),
    "turned by 30 degrees": lambda: channel(angle=30.0, time={"end": 2.0, "frame_rate": 10.0}),
    "zero gradient": lambda: channel(outlet={"type": "zero_gradient"}, time={"end": 2.0, "frame_rate": 10.0}),
    "non-reflecting": lambda: channel(
        outlet={"type": "non_reflecting"}, time={"end": 2.0, "frame_rate": 10.0}
    ),
    "duct": pipe,
    "pipe": lambda: pipe(is_round=True),
}


@pytest.mark.parametrize("case", PLUGS)
def test_plug_flow_carries_a_lattice_through_and_changes_nothing(case: str) -> None:
    """Uniform flow is an exact solution: the spacing, the speed and the number of particles stay what they were, and a
    whole number of layers enters and leaves. Pressures stay within a twentieth of the dynamic pressure, 500 Pa."""
    scene = PLUGS[case]()
    sim = Simulation(scene, device="cpu")
    before = sim.sets
    velocity = fluid(sim, "velocity")["velocity"][0]
    sim.advance(scene.time.end)
    after = fluid(sim, "velocity", "pressure", "id")
    assert sim.sets == before
    assert closest(after["position"]) > 0.99
    assert np.abs(after["velocity"] - velocity).max() < 0.005
    assert np.abs(after["pressure"]).max() < 50.0
    passed = sim.system.inflows()
    per_layer = before[0][2] / (len(scene.open_boundaries) * 5 + round(_length(scene) / DP))
    layers = scene.time.end / DP
    assert passed["inlet"].entered == pytest.approx(layers * per_layer, abs=per_layer)
    assert passed["outlet"].left == pytest.approx(layers * per_layer, abs=per_layer)
    assert passed["outlet"].entered == passed["inlet"].left == 0


def _length(scene: Scene) -> float:
    centers = [np.array(one.shape.center) for one in scene.open_boundaries.values()]
    return float(np.linalg.norm(centers[1] - centers[0]))


def test_ids_are_never_used_twice() -> None:
    sim = Simulation(channel(), device="cpu")
    seen = set(fluid(sim, "id")["id"].tolist())
    highest = max(seen)
    for time in np.arange(0.1, 1.01, 0.1):
        sim.advance(float(time))
        present = fluid(sim, "id")["id"].tolist()
        assert len(set(present)) == len(present)
        new = set(present) - seen
        assert all(number > highest for number in new)
        seen |= new
        highest = max(seen)
    assert len(seen) == pytest.approx(300 + 100, abs=10)


def test_the_mass_that_is_counted_is_that_of_the_flux() -> None:
    """Counted in particles and integrated from the velocity on the patch, to one layer of particles; and what entered
    less what left is what is there."""
    scene = channel(
        inlet={"type": "velocity", "velocity": {"type": "uniform", "speed": 0.7}, "ramp": 0.5},
        velocity=(0.0, 0.0),
    )
    sim = Simulation(scene, device="cpu")
    inside = lambda: int(np.sum(np.abs(fluid(sim)["position"][:, 0] - 1.0) <= 1.0))  # noqa: E731
    before = inside()
    sim.advance(3.0)
    layer = 1000.0 * DP
    passed = sim.system.inflows()
    # The integral of the ramp over its duration is one half; the fluid is a little denser than at rest.
    expected = 1000.0 * 0.7 * (3.0 - 0.25)
    assert 0.999 * expected <= passed["inlet"].mass <= (1.0 + sim.extremes["compression"]) * expected
    for patch in passed.values():
        assert patch.counted_mass == pytest.approx(patch.mass, abs=1.5 * layer)
    total = sum(patch.entered - patch.left for patch in passed.values())
    assert inside() - before == pytest.approx(total, abs=10)
    assert sim.removed_count == 0


def move(sim: Simulation, ids: np.ndarray, way: float) -> None:
    """Move the particles with these ids along x by a way [m], and make new lists."""
    state, count = sim.system.parts.assembly.state, sim.system.parts.fluid.count  # type: ignore[attr-defined]
    chosen = np.isin(host_view(state.id)[:count], ids)
    host_view(state.position)[:count][chosen, 0] += way
    sim.system.stepper.renew_lists()  # type: ignore[attr-defined]


def test_a_particle_that_is_pushed_back_into_an_inlet_has_no_second_successor() -> None:
    """The first layer of the fluid is pushed over the interface and out again: as many particles as before."""
    sim = Simulation(channel(), device="cpu")
    sim.advance(0.53)
    system, state = sim.system, fluid(sim, "id")
    depth = state["position"][:, 0]
    first = state["id"][(depth > 0.0) & (depth < DP)]
    before, passed = sim.sets, system.inflows()["inlet"]
    for _ in range(2):
        for way in (-DP, DP):
            move(sim, first, way)
            assert sim.sets == before
    assert len(first) == 10
    assert system.inflows()["inlet"] == passed


def test_a_particle_that_is_pushed_back_by_more_than_a_spacing_has_left() -> None:
    """Its place in the buffer is taken: it is removed, and no kill box has lost it."""
    sim = Simulation(channel(), device="cpu")
    sim.advance(0.53)
    state = fluid(sim, "id")
    first = state["id"][(state["position"][:, 0] > 0.0) & (state["position"][:, 0] < DP)]
    (_, _, before), passed = sim.sets[0], sim.system.inflows()["inlet"]
    move(sim, first, -2.0 * DP)
    after = sim.system.inflows()["inlet"]
    assert sim.sets[0][2] == before - len(first) == before - 10
    assert (after.entered, after.left, after.removed) == (passed.entered, 10, 10)
    assert sim.removed_count == 0


def balance(is_holed: bool) -> tuple[np.ndarray, int]:
    """What the balance of a channel under pressure says after 1 s, and how many particles are beside the channel. In a
    hole of the lower plate three particles have room."""
    data = channel(outlet={"type": "pressure", "pressure": 1000.0}).model_dump()
    boxes = [((-1.5, 1.0), (3.5, 1.4)), *([((-1.5, -0.4), (0.8, 0.0)), ((1.1, -0.4), (3.5, 0.0))])]
    if not is_holed:
        boxes[1:] = [((-1.5, -0.4), (3.5, 0.0))]
    shapes = [{"type": "box", "min": low, "max": high} for low, high in boxes]
    data["boundaries"]["plates"]["shape"] = {"type": "union", "shapes": shapes}
    region = {"min": (-1.0, 0.0), "max": (3.0, 1.0)}
    data["probes"] = {"balance": {"type": "volume_balance", "region": region}}
    scene = Scene.model_validate(data)
    sim, probe = (
        Simulation(scene, device="cpu"),
        make_probe("balance", scene.probes["balance"], scene),
    )
    probe.start(sim.frame(probe.needs["fluid"]))
    sim.advance(1.0)
    frame = sim.frame(probe.needs["fluid"])
    height = frame.set_named("water").fields["position"][:, 1]
    return np.array(probe.evaluate(frame)), int(np.sum((height < 0.0) | (height > 1.0)))


def test_a_hole_in_a_wall_shows_in_the_balance() -> None:
    """Counted in particles the balance is exact; by the flux, to a layer at each end."""
    (_, _, _, flux_error, counted_error), beside = balance(is_holed=False)
    assert (beside, counted_error) == (0, 0.0)
    assert abs(flux_error) < 2.0 * 1000.0 * DP
    (flux, _, gained, _, counted_error), beside = balance(is_holed=True)
    assert beside > 10
    assert counted_error == pytest.approx(-beside * 1000.0 * DP**2, rel=1e-6)
    assert flux - gained > 0.5 * beside * 1000.0 * DP**2


def test_a_buffer_on_a_lattice_of_its_own_brings_in_that_lattice() -> None:
    """The channel lies at 30 degrees to the lattice of the fluid in it: once that has left, the flow is as even as one
    on the lattice of the patch."""
    sim = Simulation(channel(angle=30.0, on_axes=True), device="cpu")
    assert closest(fluid(sim)["position"]) < 0.95
    sim.advance(3.0)
    after = fluid(sim, "velocity", "pressure")
    assert closest(after["position"]) > 0.99
    assert np.ptp(after["velocity"], axis=0).max() < 0.01
    assert np.abs(after["pressure"]).max() < 50.0


@pytest.mark.parametrize("threads", [1, 2])
def test_a_run_that_outgrew_its_places_goes_on_from_a_checkpoint_to_the_same_bits(threads: int) -> None:
    """A run saved after it has grown, and one saved before that grows after it has been resumed."""
    straight = Simulation(jet(), device="cpu", threads=1)
    saved, times = {}, (0.2, 1.0, 1.5)
    for time in times:
        straight.advance(time)
        saved[time] = straight.save_state()
    growths = straight.describe()["growths"]
    assert growths >= 2
    assert int(saved[0.2]["growths"]) < int(saved[1.0]["growths"])
    expected = fluid(straight, "velocity", "density", "id")
    assert len(expected["id"]) > 1.5 * len(fluid(Simulation(jet(), device="cpu"))["position"])
    for start, state in saved.items():
        resumed = Simulation(jet(), device="cpu", threads=threads)
        resumed.load_state(state)
        for time in (t for t in times if t > start):
            resumed.advance(time)
        for name, values in fluid(resumed, "velocity", "density", "id").items():
            assert np.array_equal(values, expected[name]), name
        assert resumed.system.inflows() == straight.system.inflows()
        assert resumed.describe()["growths"] == growths


def test_growth_changes_no_particle() -> None:
    sim = Simulation(jet(), device="cpu")
    sim.advance(0.5)
    before = fluid(sim, "velocity", "density", "pressure", "id")
    sim.system.grow()  # type: ignore[attr-defined]
    after = fluid(sim, "velocity", "density", "pressure", "id")
    assert all(np.array_equal(after[name], before[name]) for name in before)


@pytest.mark.parametrize("outlet", ["pressure", "zero_gradient"])
def test_flow_comes_back_through_an_outlet_for_a_quarter_of_the_cycle(outlet: str) -> None:
    """u = 0.5 + 0.7 cos(pi t) is negative for 0.25 of its period of 2 s. The mass in the domain returns after each
    period, and so does the number of particles, to a layer. Buffers bring in particles of the spacing of rest: under a
    pressure that makes the fluid 2 % denser, what passes is still the mass of the fluid at rest."""
    pressure = 8000.0  # above what the deceleration of 2 m of fluid at 2.2 m/s2 takes away
    scene = channel(
        inlet={
            "type": "velocity",
            "velocity": {"type": "uniform", "speed": 1.0},
            "history": "0.5 + 0.7*cos(pi*t)",
        },
        outlet={"type": outlet, "pressure": pressure},
        numerics=NUMERICS | {"particle_order": {"type": "transport_velocity"}},
        fluids={
            "water": {
                "shape": {"type": "box", "min": (0.0, 0.0), "max": (2.0, 1.0)},
                "density": 1000.0,
                "velocity": (1.2, 0.0),
                "pressure": {"type": "uniform", "value": pressure},
            }
        },
    )
    sim = Simulation(scene, device="cpu")
    for time in np.arange(0.5, 6.01, 0.5):
        sim.advance(float(time))
        state = fluid(sim, "velocity")
        assert 280 <= len(state["position"]) <= 320
        inside = np.abs(state["position"][:, 0] - 1.0) < 1.0
        assert np.abs(state["velocity"][inside] - [0.5 + 0.7 * np.cos(np.pi * time), 0.0]).max() < 0.2
    passed = sim.system.inflows()["outlet"]
    assert passed.entered > 10
    assert passed.mass == pytest.approx(-1000.0 * 0.5 * 6.0, rel=0.01)


@pytest.mark.verification
def test_what_enters_leaves_behind_a_step() -> None:
    """Flow of Re = 100 past a step, whose eddy strains what the transport velocity keeps even: in 2 s at a mean of
    1 m/s the flux that enters leaves, to 1 %, because the density follows the shifts. Where it does not, more than 3 %
    more leave than enter."""
    net = {}
    for follows in (None, False):
        inlet = {"velocity": {"type": "parabolic", "mean": 1.0}, "ramp": 0.5}
        step = {"type": "box", "min": (0.3, 0.0), "max": (0.7, 0.3)}
        scene = obstructed_channel(
            2.0, inlet, {}, viscosity=0.01, spacing=0.05, obstacle=step, start=(0.0, 0.0)
        )
        data = scene.model_dump()
        data["numerics"]["particle_order"]["density_follows"] = follows
        sim = Simulation(Scene.model_validate(data), device="cpu")
        sim.advance(1.0)
        first = sim.system.inflows()
        sim.advance(3.0)
        last = sim.system.inflows()
        net[follows] = sum(last[name].mass - first[name].mass for name in last) / 2000.0
    assert abs(net[None]) < 0.01
    assert net[False] < -0.03


def reflection(outlet: dict[str, Any]) -> float:
    """Largest pressure of what comes back of a pulse that runs through resting fluid, over that of the pulse."""
    pulse = {
        "type": "velocity",
        "velocity": {"type": "uniform", "speed": 0.1},
        "history": "exp(-((t - 0.15)/0.0333)**2)",
    }
    scene = channel(
        inlet=pulse, outlet=outlet, velocity=(0.0, 0.0), numerics=NUMERICS | {"viscosity": {"type": "none"}}
    )
    sim = Simulation(scene, device="cpu")
    arriving, returning = 0.0, 0.0
    # The pulse passes the middle at 0.20 s and would be back there at 0.30 s.
    for time in np.arange(0.16, 0.37, 0.01):
        sim.advance(float(time))
        state = fluid(sim, "pressure")
        middle = np.abs(state["position"][:, 0] - 1.0) < DP
        pressure = float(np.abs(state["pressure"][middle].mean()))
        arriving = max(arriving, pressure if time < 0.24 else 0.0)
        returning = max(returning, pressure if time > 0.27 else 0.0)
    return returning / arriving


def test_sound_leaves_through_a_non_reflecting_outlet() -> None:
    """A fixed pressure sends most of the pulse back; characteristics let all but a tenth go, less the longer the
    undisturbed velocity is averaged."""
    assert reflection({"type": "pressure", "pressure": 0.0}) > 0.6
    assert reflection({"type": "non_reflecting"}) < 0.1
    assert reflection({"type": "non_reflecting", "averaging_time": 2.0}) < 0.06


def test_pressures_at_both_ends_drive_the_parabola_of_poiseuille() -> None:
    """u = G y (H - y) / 2 mu. With 10 particles across, no-slip by extrapolation is off by about (dp/H)^2 = 1 % of the
    peak, and compressibility by the Mach number squared."""
    viscosity, gradient = 0.1, 400.0
    data = channel(inlet={"type": "pressure", "pressure": 2.0 * gradient}, velocity=(0.0, 0.0)).model_dump()
    data["numerics"] |= {"viscosity": {"type": "laminar"}, "particle_order": {"type": "transport_velocity"}}
    data["fluids"]["water"]["kinematic_viscosity"] = viscosity
    data["boundaries"]["plates"]["slip"] = "no_slip"
    sim = Simulation(Scene.model_validate(data), device="cpu")
    sim.advance(4.0)
    state = fluid(sim, "velocity")
    y = state["position"][:, 1]
    exact = gradient * y * (1.0 - y) / (2.0 * 1000.0 * viscosity)
    assert np.abs(state["velocity"][:, 0] - exact).max() < 0.04 * exact.max()


def test_a_step_without_patches_has_no_pass_for_them() -> None:
    data = channel().model_dump()
    data["open_boundaries"] = {}
    sim = Simulation(Scene.model_validate(data), device="cpu")
    assert "impose" not in sim.describe()["passes"]
    assert sim.describe()["fluid_places"] == sim.sets[0][2]
