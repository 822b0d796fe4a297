"""A free surface through open boundaries: its level stays, and nothing enters above it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from open_boundary_builders import DP, stream
from pydantic import ValidationError

from warpsph.sampling import sample
from warpsph.sampling.patches import patches_of
from warpsph.scene import Scene, SceneError
from warpsph.solver.simulation import Simulation

DEPTH, LENGTH, SOUND_SPEED = 1.0, 2.0, 30.0
SINKING = 9.81 * DEPTH / (2.0 * SOUND_SPEED**2)
"""Part of its depth by which water sinks that is compressed by its weight: the mean of its pressure over rho c^2."""


def water(sim: Simulation, *fields: str) -> dict[str, np.ndarray]:
    return dict(sim.frame(["position", *fields]).of_kind("fluid")[0].fields)


def highest(position: np.ndarray) -> np.ndarray:
    """Level [m] in each quarter of the channel: half a spacing over the highest particle."""
    quarters = np.floor(position[:, 0] / (0.25 * LENGTH))
    return np.array([position[quarters == k, 1].max() + 0.5 * DP for k in range(4)])


@pytest.mark.parametrize("speed", [0.0, 0.5])
def test_a_level_stays(speed: float) -> None:
    """Uniform flow and rest are exact solutions, but for what the weight compresses: over time the mean level,
    the number of particles and the speed stay within a per cent of them, and single particles within half a spacing."""
    sim = Simulation(stream(speed=speed), device="cpu")
    before = sim.sets[0][2]
    levels, numbers, speeds = [], [], []
    for time in np.arange(1.0, 5.01, 0.25):
        sim.advance(float(time))
        state = water(sim, "velocity")
        levels.append(highest(state["position"]))
        numbers.append(len(state["position"]))
        inside = np.abs(state["position"][:, 0] - 0.5 * LENGTH) < 0.4 * LENGTH
        speeds.append(state["velocity"][inside, 0].mean())
    assert np.abs(np.array(levels) - DEPTH).max() < 0.5 * DP
    assert np.mean(levels) == pytest.approx(DEPTH * (1.0 - SINKING), rel=0.01)
    assert np.mean(numbers) == pytest.approx(before, rel=0.01)
    assert np.mean(speeds) == pytest.approx(speed, abs=0.01 * max(speed, 1.0))
    assert sim.removed_count == 0


def test_water_above_the_level_of_an_inlet_does_not_enter_again_and_again() -> None:
    """A bore runs back over the inlet from water that is deeper than its level. What comes back in takes no new
    particles with it: the columns of the inlet's far half reach its level and no higher, and only what they carry
    enters."""
    scene = stream()
    data = scene.model_dump()
    data["fluids"]["water"]["shape"]["max"] = (LENGTH, 1.25 * DEPTH)
    sim = Simulation(Scene.model_validate(data), device="cpu")
    inlet = patches_of(scene)[0]
    spilled = 0
    for time in np.arange(0.25, 3.01, 0.25):
        sim.advance(float(time))
        position = water(sim)["position"]
        x, y = position.T
        spilled = max(spilled, int(np.sum((x < 0.0) & (y > DEPTH))))
        assert y[x < -0.5 * inlet.length].max() < DEPTH
    assert spilled > 0
    rows, columns = round(DEPTH / DP), 0.5 * 3.0 / DP
    assert sim.system.parts.open_boundaries.exchange.births == pytest.approx(rows * columns, abs=rows)


def test_a_stream_goes_on_from_a_checkpoint_to_the_same_bits() -> None:
    numerics = {"sound_speed": SOUND_SPEED, "particle_order": {"type": "shifting"}}
    straight = Simulation(stream(numerics=numerics), device="cpu", threads=1)
    straight.advance(0.5)
    saved = straight.save_state()
    straight.advance(1.0)
    resumed = Simulation(stream(numerics=numerics), device="cpu", threads=2)
    resumed.load_state(saved)
    resumed.advance(1.0)
    for name, values in water(straight, "velocity", "density", "id").items():
        assert np.array_equal(values, water(resumed, "velocity", "density", "id")[name]), name
    assert resumed.system.inflows() == straight.system.inflows()


def test_a_stream_in_space_keeps_its_columns() -> None:
    """Three columns of particles pass a rectangle whose first side stands upright."""
    numerics = {"sound_speed": SOUND_SPEED, "wall": {"type": "extrapolated", "suction": True}}
    sim = Simulation(stream(dimension=3, speed=1.0, numerics=numerics), device="cpu")
    before = sim.sets[0][2]
    sim.advance(0.3)
    position = water(sim)["position"]
    assert len(position) == before
    assert sim.system.inflows()["inlet"].entered == pytest.approx(3 * 4 * 10, abs=40)
    assert np.abs(highest(position) - DEPTH).max() < 0.2 * DP


@pytest.mark.parametrize("dimension", [2, 3])
def test_stations_and_buffers_end_at_the_level(dimension: int) -> None:
    """The area of a patch is that below its level; each station but the lowest has another just below it; and a buffer
    holds nothing above."""
    scene = stream(dimension=dimension)
    points = next(s for s in sample(scene) if s.kind == "fluid").position
    for patch in patches_of(scene):
        assert patch.area == pytest.approx(DEPTH * (1.0 if dimension == 2 else 0.4))
        places = patch.points(patch.stations)
        has_lower = patch.lower >= 0
        assert has_lower.sum() == len(places) - len(places) // 15
        steps = places[has_lower] - places[patch.lower[has_lower]]
        assert steps == pytest.approx(np.tile([0.0, DP, 0.0][:dimension], (len(steps), 1)), abs=1e-12)
        behind = points[patch.behind(points, 0.0)]
        assert behind[:, 1].max() == pytest.approx(DEPTH - 0.5 * DP)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"gravity": (0.0, 0.0)}, "without gravity"),
        ({"outlet": {"pressure": 0.0}}, "its pressure, or its level"),
        ({"outlet": {"level": None}}, "its pressure, or its level"),
        ({"outlet": {"ramp": 1.0}}, "no effect on a level"),
        ({"outlet": {"level": 1.6}}, "lies off the patch"),
        ({"inlet": {"velocity": {"type": "parabolic", "mean": 1.0}}}, "a full section"),
        ({"inlet": {"shape": {"center": (0.0, 0.0), "normal": (0.0, 1.0), "width": 1.0}}}, "upright"),
    ],
)
def test_levels_that_cannot_be_are_refused(changes: dict[str, Any], words: str) -> None:
    data = stream().model_dump()
    for name in ("inlet", "outlet"):
        data["open_boundaries"][name] |= changes.get(name, {})
    data["gravity"] = changes.get("gravity", data["gravity"])
    with pytest.raises((SceneError, ValidationError), match=words):
        sample(Scene.model_validate(data))
