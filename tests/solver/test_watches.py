"""Watches of a run: each warns or stops where a scene provokes it, says where, and stays silent where all is well."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders import free_drop, still_tank
from structure_builders import block, region

from warpsph.frame import Frame, SetFrame
from warpsph.particles.state import host_view, write_array
from warpsph.scene.schema import Scene
from warpsph.solver.energy_watch import EnergyWatch, why_not_closed
from warpsph.solver.errors import SimulationDiverged
from warpsph.solver.leak_watch import LeakWatch
from warpsph.solver.leaks import LeakFinder
from warpsph.solver.run import run_scene
from warpsph.solver.simulation import Simulation
from warpsph.solver.step_watch import StepWatch
from warpsph.solver.system import StepReport
from warpsph.solver.watches_of import watches_of


def box(low: tuple[float, ...], high: tuple[float, ...]) -> dict[str, Any]:
    return {"type": "box", "min": low, "max": high}


def sloshing(**changes: Any) -> Scene:
    """Water that begins to slosh because gravity is tilted."""
    time = {"end": 0.4} | changes.pop("time", {})
    return still_tank(gravity=(3.0, -9.0), time=time, **changes)


# The step


def test_a_step_that_falls_for_long_is_found_with_its_limit_and_particle(tmp_path: Path) -> None:
    """A wall particle, away from the water, is spun about a point beside it.

    Its acceleration a = omega^2 r demands steps of cfl sqrt(h / a): less than a tenth of the acoustic cfl h / c where
    a exceeds 100 c^2 / h, which at r = h / 50 it does at less than twice the sound speed, the limit of its speed.
    """
    spacing, sound = 0.1, 20.0
    h = 1.5 * spacing
    radius = h / 50.0
    rate = np.degrees(np.sqrt(150.0 * sound**2 / h / radius))
    (tmp_path / "spin.csv").write_text(f"t,angle\n0,0\n2.5,0\n3.5,{rate:.9g}\n")
    low = (2.0, 0.0)
    center = (low[0] + 0.5 * spacing - radius, 0.5 * spacing)
    motion = [
        {
            "type": "table",
            "file": str(tmp_path / "spin.csv"),
            "time": "t",
            "rotation": "angle",
            "center": center,
            "interpolation": "linear",
        }
    ]
    base = still_tank(spacing=spacing).model_dump()
    base["boundaries"]["spinner"] = {
        "shape": box(low, (low[0] + spacing, spacing)),
        "side": "solid",
        "motion": motion,
    }
    base["numerics"]["sound_speed"] = sound
    base["time"] |= {"end": 2.75, "frame_rate": 4.0}
    base["output"] = {"usd": False}
    summary = run_scene(Scene(**base), tmp_path / "run", device="cpu", threads=1)
    (warning,) = [text for text in summary["warnings"] if "median" in text]
    assert "below 10% of its median" in warning
    assert "by the limit 'force'" in warning
    assert "of water at (" in warning
    assert float(warning.split("t = ")[1].split()[0]) == pytest.approx(2.5, abs=0.01)
    # The median is known to a grade of 5 %, and the water at the floor, at 1.2 %, is 3.7 % stiffer than at rest.
    assert summary["watches"]["step"]["lasting_share"] == pytest.approx(150.0**-0.5, rel=0.07)


@pytest.fixture(scope="module")
def tank() -> Simulation:
    return Simulation(still_tank(spacing=0.1), device="cpu", threads=1)


def stepped(watch: StepWatch, sim: Simulation, dt: float, count: int, limit: str = "force") -> StepWatch:
    for _ in range(count):
        sim.last_step = StepReport(dt, limit)
        watch.look(sim)
    return watch


def test_short_rows_of_short_steps_and_steps_that_land_on_a_time_are_no_collapse(tank: Simulation) -> None:
    watch = stepped(StepWatch(), tank, 1.0, 1000)
    for _ in range(5):
        stepped(watch, tank, 0.01, 499)
        stepped(watch, tank, 1.0, 1)
    stepped(watch, tank, 0.0101, 600, "frame")
    stepped(watch, tank, 0.11, 600)
    assert watch.warnings == []


def test_a_hopeless_step_stops_the_run_with_a_particle_and_its_place(tank: Simulation) -> None:
    watch = stepped(StepWatch(), tank, 1.0, 1000)
    with pytest.raises(
        SimulationDiverged, match=r"particle \d+ of water .* below 0\.001 of its median"
    ) as found:
        stepped(watch, tank, 0.9e-3, 600)
    assert found.value.value == 0.9e-3
    assert len(found.value.position) == 2


# The energy


def gain(scene: Scene, until: float, every: int = 5) -> EnergyWatch:
    """The energy watch after a run to a time [s]."""
    sim, watch = Simulation(scene, device="cpu", threads=1), EnergyWatch(scene)
    watch.start(sim)
    for number, _ in enumerate(sim.steps_until(until)):
        if number % every == 0:
            watch.look(sim)
    watch.look(sim)
    return watch


def test_work_of_a_moving_wall_is_no_gain() -> None:
    """A piston compresses fluid to a tenth of a per cent in a time in which sound goes to and fro several times."""
    speed, time = 0.1, 0.05
    piston = {
        "shape": box((-0.4, 0.0), (0.0, 0.5)),
        "side": "solid",
        "motion": [{"type": "linear", "velocity": (speed, 0.0)}],
    }
    scene = still_tank(spacing=0.025, gravity=(0.0, 0.0), numerics={"sound_speed": 100.0}).model_dump()
    walls = scene["boundaries"]["tank"] | {"shape": box((-0.4, 0.0), (0.5, 0.5)), "open": ()}
    scene["boundaries"] = {"tank": walls, "piston": piston}
    watch = gain(Scene(**scene), time)
    # Slow compression of 0.5 m x 0.5 m by s = U t: W = rho c^2 / 2 (s / L)^2 L H.
    strain = speed * time / 0.5
    expected = 0.5 * 1000.0 * 100.0**2 * strain**2 * 0.25
    assert watch.record()["work_J"] == pytest.approx(expected, rel=0.3)
    # All but what viscosity takes comes back as energy of the fluid; the trapezoidal rule adds its own error.
    assert abs(watch.record()["gained_J"]) < 0.2 * expected
    assert watch.warnings == []


def test_work_of_loads_is_no_gain() -> None:
    """A column that a sudden load of its end stretches: what it does is what the column has."""
    load = {"type": "traction", "region": region((0.9, 0.0), (1.0, 0.5)), "value": (2.0e4, 0.0)}
    held = {"foot": {"region": region((0.0, 0.0), (0.1, 0.5))}}
    scene = block(structure={"loads": {"pull": load}, "clamps": held})
    watch = gain(scene, 0.1)
    assert watch.record()["work_J"] > 10.0
    assert abs(watch.record()["gained_J"]) < 0.01 * watch.record()["work_J"]


def faster(sim: Simulation, factor: float) -> None:
    """Multiply all velocities."""
    array = sim.array("velocity_volume")
    values = np.array(host_view(array))
    values[:, :-1] *= factor
    write_array(array, values)


def test_energy_from_nowhere_is_found_and_stops_the_run_when_it_doubles() -> None:
    scene = free_drop()
    sim, watch = Simulation(scene, device="cpu", threads=1), EnergyWatch(scene)
    watch.start(sim)
    sim.advance(0.05)
    watch.look(sim)
    assert watch.warnings == []
    faster(sim, 1.1)  # the kinetic energy grows by 21 %, of which 5 % are allowed
    watch.look(sim)
    (warning,) = watch.warnings
    assert "at t = 0.05 s" in warning
    assert "fastest was particle" in warning
    faster(sim, 1.5)
    with pytest.raises(SimulationDiverged, match="energy has grown by more than all"):
        watch.look(sim)


def test_fluid_that_leaves_takes_its_energy_along() -> None:
    """A drop falls out of the kill box: that its potential energy, lower than nothing, is gone is no gain."""
    kill_box = {"min": (-1.0, -1.0), "max": (2.0, 2.0)}
    watch = gain(free_drop(gravity=(0.0, -9.81), domain={"kill_box": kill_box}), 0.8)
    assert watch.record()["largest_share"] < 0.01


def test_a_budget_that_cannot_be_drawn_up_is_not_judged() -> None:
    periodic = {"periodic": {"x": (0.0, 1.0)}}
    assert why_not_closed(still_tank()) is None
    assert "axis x" in str(why_not_closed(still_tank(gravity=(1.0, -9.81), domain=periodic)))
    assert why_not_closed(still_tank(domain=periodic)) is None


# Leaks


def test_fluid_behind_walls_is_found_where_they_are_now() -> None:
    """Places in and beside the walls of two tanks, a shelf, and a block that has moved by 1 m."""
    base = still_tank(spacing=0.1).model_dump()
    shelf = {"type": "plane", "point": (0.0, 5.0), "normal": (0.0, 1.0)}
    base["boundaries"] |= {
        "closed": {"shape": box((0.0, -3.0), (0.5, -2.0)), "side": "outside"},
        "shelf": {"shape": shelf | {"bounds": {"min": (0.0, 4.0), "max": (1.0, 6.0)}}, "side": "inside"},
        "block": {
            "shape": box((3.0, 0.0), (4.0, 1.0)),
            "side": "solid",
            "motion": [{"type": "linear", "velocity": (0.5, 0.0)}],
        },
    }
    finder = LeakFinder(Scene(**base))
    places = {
        (0.2, 0.2): set(),
        (-0.09, 0.2): set(),  # less than a spacing
        (-0.11, 0.2): {"tank"},
        (-5.0, 0.2): {"tank"},  # beyond its layers, and in no other tank
        (0.2, -2.5): set(),  # beyond them, in the other tank
        (0.2, -1.8): {"closed"},  # behind its lid
        (0.2, -0.2): {"tank"},  # behind the floor of the first
        (-0.1, 0.8): set(),  # above its rim
        (0.2, 4.85): {"shelf"},
        (0.2, 4.5): set(),  # beyond its layers
        (1.2, 4.85): set(),  # beside it
        (4.5, 0.5): {"block"} | {"tank"},
        (4.5, 0.85): {"block"},
        (3.5, 0.9): set(),  # where the block was
    }
    position = np.array(list(places))
    water = SetFrame("water", "fluid", {"position": position, "id": np.arange(len(places))})
    found: dict[int, set[str]] = {row: set() for row in range(len(places))}
    for leak in finder.leaks(Frame(0, 2.0, 2, 0.1, (water,))):
        for row in leak.rows:
            found[int(row)].add(leak.solid)
    assert list(found.values()) == list(places.values())


def test_fluid_in_a_structure_that_has_turned_and_stretched_is_found() -> None:
    base = still_tank(spacing=0.1).model_dump()
    material = {"density": 1000.0, "youngs_modulus": 1e6, "poisson_ratio": 0.3}
    base["boundaries"] = {}
    base["structures"] = {"plate": {"shape": box((2.0, 0.0), (2.4, 1.0)), "material": material}}
    rest = np.stack(np.meshgrid(np.arange(2.05, 2.4, 0.1), np.arange(0.05, 1.0, 0.1)), axis=-1).reshape(-1, 2)
    turn = np.array([[0.0, -1.0], [1.0, 0.0]]) @ np.diag([1.2, 1.0])
    plate = SetFrame("plate", "structure", {"position": rest @ turn.T, "displacement": rest @ turn.T - rest})
    of_rest = np.array([[2.2, 0.53], [2.06, 0.3], [2.03, 0.3], [1.98, 0.3], [2.5, 0.5], [9.0, 9.0]])
    water = SetFrame("water", "fluid", {"position": of_rest @ turn.T, "id": np.arange(6)})
    (leak,) = LeakFinder(Scene(**base)).leaks(Frame(0, 0.0, 2, 0.1, (water, plate)))
    assert (leak.solid, list(leak.rows)) == ("plate", [0, 1])


def shot(layers: int | str) -> Scene:
    """A jet that hits a wall at 40 m/s; a single layer without a barrier does not hold it."""
    scene = free_drop(spacing=0.05).model_dump()
    scene["fluids"]["water"]["velocity"] = (40.0, 0.0)
    scene["boundaries"] = {
        "wall": {
            "shape": box((1.0, -1.0), (1.6, 2.0)),
            "side": "inside",
            "open": ("x_max", "y_min", "y_max"),
            "layers": layers,
        }
    }
    scene["numerics"] |= {"sound_speed": 100.0, "wall": {"type": "dynamic"}}
    scene["time"] = {"end": 0.1, "frame_rate": 100.0}
    scene["output"] = {"usd": False}
    return Scene(**scene)


def test_a_leak_is_reported_once_with_time_particle_and_wall(tmp_path: Path) -> None:
    class Listener:
        def __init__(self) -> None:
            self.heard: list[str] = []

        def start(self, sim: Simulation) -> None: ...
        def progress(self, sim: Simulation) -> None: ...
        def finish(self, summary: dict[str, Any]) -> None: ...
        def warn(self, text: str) -> None:
            self.heard.append(text)

    listener = Listener()
    summary = run_scene(shot(1), tmp_path, device="cpu", threads=1, reporter=listener)
    (warning,) = [text for text in summary["warnings"] if text.startswith("fluid leaked")]
    assert warning in listener.heard
    assert "behind the surface of wall" in warning
    assert "of water at (" in warning
    assert summary["watches"]["leaks"]["at_most"] > 0
    held = run_scene(shot("auto"), tmp_path, device="cpu", threads=1)
    assert held["watches"]["leaks"]["at_most"] == 0
    assert not [text for text in held["warnings"] if text.startswith("fluid leaked")]


# All together


def test_watches_change_no_bit_of_a_run_and_are_silent_where_all_is_well(tmp_path: Path) -> None:
    scene = sloshing()
    plain = Simulation(scene, device="cpu", threads=1)
    watched = Simulation(scene, device="cpu", threads=1)
    watches = watches_of(scene)
    for watch in watches._watches:
        watch.every = 1
    watches.start(watched)
    for _ in plain.steps_until(0.2):
        pass
    for _ in watched.steps_until(0.2):
        assert watches.note(watched) == []
    for name in ("position", "velocity", "density"):
        one, other = (sim.frame((name,)).set_named("water").fields[name] for sim in (plain, watched))
        np.testing.assert_array_equal(one, other)


def test_what_watches_remember_survives_a_break(tmp_path: Path) -> None:
    whole = run_scene(sloshing(), tmp_path / "whole", device="cpu", threads=1)
    run_scene(sloshing(), tmp_path / "parts", device="cpu", threads=1, frames=4)
    again = run_scene(sloshing(), tmp_path / "parts", device="cpu", threads=1, resume=True)
    assert again["watches"] == whole["watches"]
    assert set(again["watches"]) == {"step", "energy", "leaks"}
    assert again["watches"]["energy"]["gained_J"] != 0.0


def test_a_particle_that_comes_back_has_not_leaked() -> None:
    """Behind the wall at one look and before it at the next: counted, and no warning; at two looks in a row: a leak."""
    scene = still_tank(spacing=0.1)
    sim, watch = Simulation(scene, device="cpu", threads=1), LeakWatch(scene)
    watch.start(sim)
    position = sim.array("position")
    home = np.array(host_view(position))
    strayed = home.copy()
    first = int(np.argmin(home[:25, 0]))
    strayed[first, 0] = -0.15
    for places, warnings in ((strayed, 0), (home, 0), (strayed, 0), (strayed, 1), (strayed, 1)):
        write_array(position, places)
        watch.look(sim)
        assert len(watch.warnings) == warnings
    assert watch.record() == {"at_last": 1, "at_most": 1, "ignored": []}
    assert f"particle {int(host_view(sim.array('id'))[first])} of water at (-0.15," in watch.warnings[0]
