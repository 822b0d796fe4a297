"""A simulation under the control of a program: callbacks, arrays, and what it refuses."""

import math

import numpy as np
import pytest
from builders import still_tank

from warpsph.solver.errors import SimulationDiverged
from warpsph.solver.fluid_system import ARRAYS
from warpsph.solver.simulation import Simulation


def simulation(**changes) -> Simulation:
    """A tank with frames at 0, 0.05, 0.1, 0.15 and 0.2 s."""
    return Simulation(still_tank(time={"end": 0.2, "frame_rate": 20.0}, **changes), device="cpu")


def frames_heard(sim: Simulation) -> list[tuple[int, float]]:
    heard: list[tuple[int, float]] = []
    sim.on_frame(lambda sim: heard.append((sim.frame_index, sim.time)))
    sim.run()
    return heard


@pytest.mark.parametrize(
    ("until", "frames"),
    [
        (0.0, [0, 1, 2, 3, 4]),
        (0.07, [2, 3, 4]),
        (0.1, [2, 3, 4]),
        (0.1 + 1e-17 + 1e-16, [2, 3, 4]),  # the frame time but for rounding
        (0.2, [4]),
        (0.22, []),
    ],
)
def test_run_calls_back_for_the_frames_from_the_present_on_each_at_its_own_time(until, frames):
    sim = simulation()
    sim.advance(until)
    heard = frames_heard(sim)
    assert [index for index, _ in heard] == frames
    assert [time for _, time in heard] == pytest.approx([index / 20.0 for index in frames], abs=1e-12)


def test_run_goes_on_from_a_saved_state():
    first, second = simulation(), simulation()
    first.advance(0.12)
    second.load_state(first.save_state())
    assert [index for index, _ in frames_heard(second)] == [3, 4]


@pytest.mark.parametrize("until", [math.nan, math.inf])
def test_a_time_that_is_not_finite_is_refused(until):
    with pytest.raises(ValueError, match="allowed: a finite time"):
        simulation().advance(until)


def test_unknown_arrays_and_fields_are_answered_with_those_that_there_are():
    sim = simulation()
    assert all(len(sim.array(name)) == sim.particle_count for name in ARRAYS)
    with pytest.raises(KeyError, match="no array 'pressure'; there are position"):
        sim.array("pressure")
    with pytest.raises(KeyError, match="no field 'speed'; there are position"):
        sim.frame(["speed"])
    assert "id" in sim.frame(["id"]).sets[0].fields


def test_no_threads_are_refused():
    with pytest.raises(ValueError, match="threads is 0; allowed"):
        Simulation(still_tank(), device="cpu", threads=0)


@pytest.mark.parametrize("name", ["position", "velocity_volume", "density_deviation"])
def test_a_value_that_is_not_finite_stops_the_run_and_is_named(name):
    sim = simulation()
    sim.advance(0.01)
    sim.array(name).numpy()[5] = np.nan
    with pytest.raises(SimulationDiverged, match=r"a value is not finite \(found nan\)"):
        sim.advance(0.2)
