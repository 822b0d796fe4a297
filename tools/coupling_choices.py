"""Choices of coupling, measured: sub-steps, the velocity that the fluid sees, stiffness, and cost over fluid alone.

Writes the tables of docs/coupling.md, on one thread; all but `cases` take minutes:

    python tools/coupling_choices.py [TABLE ...] [--quick]
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
import warp as wp
from pages import rewrite, table

from warpsph import load_scene
from warpsph.scene.schema import Scene
from warpsph.solver.errors import SimulationDiverged
from warpsph.solver.simulation import Simulation

PAGE = Path(__file__).parents[1] / "docs/coupling.md"
SAMPLES = 40
"""Looks at a run, evenly over its time; each ends a step."""
BARE = ("references={}", "validation=null", "output.usd=false")
WAYS = {
    "auto": [],
    "auto, end velocity": ["coupling.velocity=end"],
    "auto, mean velocity": ["coupling.velocity=mean"],
    "one shared step": ["coupling.sub_steps=1"],
}
COUNTS: tuple[Literal["auto", 1], ...] = ("auto", 1)
CASES = {
    "cylinder_in_water": (0.005, 0.5),
    "cylinder_in_free_water": (0.002, 0.04),
    "floating_box": (0.02, 2.0),
    "pushed_cylinder": (0.02, 0.12),
    "rolling_tank_deep": (0.002, 0.1),
    "rolling_tank_shallow": (0.002, 0.1),
    "rolling_tank_hanging": (0.002, 0.1),
    "dam_break_plate_yardstick": (0.0033333333, 0.36),
}
"""Spacing [m] and end [s] of shipped scenes that are run with one shared step beside their own."""

Measure = Callable[[Simulation], float | np.ndarray]


@dataclass(frozen=True)
class Trial:
    """What a run took: steps of the fluid and of the structures, wall seconds of its steps, and samples of some
    figures (samples, figures).

    A figure may be an array. `end` is the time reached [s], short of the whole where the run diverged.
    """

    steps: int
    sub_steps: int
    seconds: float
    samples: np.ndarray
    end: float

    @property
    def cost(self) -> list[str]:
        """Cells of a row."""
        return [str(self.steps), str(self.sub_steps), f"{self.seconds:.2f}"]


def measure(scene: Scene, *of: Measure) -> Trial:
    """Run a scene to its end; kernels are compiled and the stages warmed up by a first step elsewhere."""
    Simulation(scene, device="cpu", threads=1).step()
    simulation = Simulation(scene, device="cpu", threads=1)
    samples, seconds, sub_steps = [], 0.0, 0
    for until in np.linspace(0.0, scene.time.end, SAMPLES + 1)[1:]:
        begun = time.perf_counter()
        try:
            for report in simulation.steps_until(float(until)):
                sub_steps += report.sub_steps
        except SimulationDiverged:
            break
        finally:
            seconds += time.perf_counter() - begun
        samples.append([one(simulation) for one in of])
    print(scene.name, simulation.step_count, sub_steps, f"{seconds:.2f} s", file=sys.stderr, flush=True)
    return Trial(simulation.step_count, sub_steps, seconds, np.array(samples), simulation.time)


def elastic_energy(simulation: Simulation) -> float:
    """Strain and hourglass energy of all structures [J/m]."""
    energies = simulation.ledger().energies
    return energies["strain"] + energies["hourglass"]


def impulse(simulation: Simulation) -> float:
    """Momentum that the water has taken from the plate [kg/s], per metre of depth."""
    water = simulation.frame(["velocity", "mass"]).set_named("water").fields
    return -float(water["mass"] @ water["velocity"][:, 1])


def middle_sag(simulation: Simulation) -> float:
    """Displacement of the plate's middle [m]."""
    plate = simulation.frame(["displacement"]).set_named("plate").fields
    return float(plate["displacement"][np.abs(plate["position"][:, 0] - 0.5) < 0.02, 1].mean())


def largest_tip(simulation: Simulation) -> float:
    """Displacement of the obstacle's upper left corner [m]."""
    obstacle = simulation.frame(["displacement"]).set_named("obstacle").fields
    rest = obstacle["position"] - obstacle["displacement"]
    return float(obstacle["displacement"][np.argmax(rest[:, 1] - rest[:, 0]), 0])


def displacements(simulation: Simulation) -> np.ndarray:
    """Displacements of all particles of structures (n, 2) [m]."""
    sets = simulation.frame(["displacement"]).of_kind("structure")
    return np.concatenate([body.fields["displacement"] for body in sets])


def hydrostatic(quick: bool) -> list[str]:
    """A metre of water on an aluminium plate of twice the thickness without damping."""
    plate = "structures.plate"
    return [
        *BARE,
        "spacing=0.025",
        f"time.end={0.02 if quick else 0.06}",
        "fluids.water.shape.max=[1.0, 1.0]",
        f"{plate}.shape.min=[-0.1, -0.1]",
        f"{plate}.shape.max=[1.1, 0.0]",
        f"{plate}.displacement=null",
        f"{plate}.damping=0",
        "probes={}",
    ]


def sub_step_rows(quick: bool) -> Iterator[list[str]]:
    """Cases by the way in which they are coupled; differences are to the shared step."""
    struck = [*BARE, "spacing=0.004", "structures.plate.material.youngs_modulus=1e10"]
    broken = [*BARE, "spacing=0.004", f"time.end={0.16 if quick else 0.26}"]
    cases: Sequence[tuple[str, Sequence[str], str, Measure, Callable[[np.ndarray], float]]] = (
        ("hydrostatic_plate", hydrostatic(quick), "mean sag [m]", middle_sag, np.mean),
        ("plate_on_water", struck, "impulse [kg/s]", impulse, lambda values: values[-1]),
        ("dam_break_elastic_obstacle", broken, "largest tip [m]", largest_tip, np.max),
    )
    for name, overrides, quantity, of, feature in cases:
        trials, energies = {}, {}
        for way, more in WAYS.items():
            scene = load_scene(name, [*overrides, *more])
            trials[way] = measure(scene, of, elastic_energy)
            energies[way] = float(trials[way].samples[-SAMPLES // 4 :, 1].mean())
        reference = feature(trials["one shared step"].samples[:, 0])
        for way, trial in trials.items():
            value = feature(trial.samples[:, 0])
            difference = "-" if way == "one shared step" else f"{100.0 * (value / reference - 1.0):+.2f} %"
            energy = energies[way] / energies["one shared step"]
            yield [f"`{name}`", way, f"{quantity} {value:.4g}", difference, f"{energy:.3g}", *trial.cost]


def farthest_way(auto: Trial, shared: Trial) -> tuple[float, float]:
    """How far the particle goes that goes farthest with the shared step [m], and the largest distance between its
    places in the two runs at one time, in parts of that."""
    paths = [trial.samples.reshape(len(trial.samples), -1, 2) for trial in (auto, shared)]
    length = np.linalg.norm(paths[1], axis=2)
    particle = length.max(axis=0).argmax()
    apart = np.linalg.norm(paths[0][:, particle] - paths[1][:, particle], axis=1)
    return float(length[:, particle].max()), float(apart.max() / length[:, particle].max())


def case_rows(quick: bool) -> Iterator[list[str]]:
    """Shipped scenes with sub-steps and with one shared step."""
    for name, (spacing, end) in CASES.items():
        stretch = end / 20.0 if quick else end
        overrides = [*BARE, "probes={}", f"spacing={spacing}", f"time.end={stretch}"]
        auto, shared = (
            measure(load_scene(name, [*overrides, f"coupling.sub_steps={count}"]), displacements)
            for count in COUNTS
        )
        way, off = farthest_way(auto, shared)
        yield [
            f"`{name}`",
            f"{spacing:.3g}",
            f"{stretch:g}",
            f"{1e3 * way:.4g}",
            f"{100.0 * off:.2g} %",
            *auto.cost,
            *shared.cost,
            f"{shared.seconds / auto.seconds:.2f}",
        ]


def stiffness_rows(quick: bool) -> Iterator[list[str]]:
    """The dam break on obstacles from jelly to steel."""
    base = [*BARE, "spacing=0.004", f"time.end={0.05 if quick else 0.2}", "probes={}"]
    base += ["structures.obstacle.material.law=neo_hookean"]
    first = 0.0
    for young in (1e4, 1e6, 1e8, 1e10, 2e11):
        scene = load_scene(
            "dam_break_elastic_obstacle", [*base, f"structures.obstacle.material.youngs_modulus={young}"]
        )
        trial = measure(scene, largest_tip)
        first = first or trial.seconds
        reached = "yes" if trial.end == scene.time.end else f"diverged at {trial.end:.3g} s"
        yield [
            f"{young:.0e}",
            reached,
            f"{trial.samples.max():.3g}",
            *trial.cost,
            f"{trial.seconds / first:.2f}",
        ]


def alone_rows(quick: bool) -> Iterator[list[str]]:
    """The same obstacle as a wall and as a structure; and one that no fluid ever meets."""
    base = [*BARE, "spacing=0.003", f"time.end={0.05 if quick else 0.25}", "probes={}"]
    shape = "{type: box, min: [0.292, -0.012], max: [0.304, 0.08]}"
    wall = ["structures={}", f"boundaries.obstacle={{shape: {shape}, side: solid}}"]
    far = [
        "domain.kill_box={min: [-1.0, -1.0], max: [3.0, 3.0]}",
        "structures.obstacle.shape={type: box, min: [2.0, 0.0], max: [2.012, 0.08]}",
        "structures.obstacle.clamps.foot.region={type: box, min: [1.9, -0.1], max: [2.1, 0.012]}",
    ]
    runs = {
        "obstacle is a wall": wall,
        "obstacle is a structure": [],
        "no obstacle, fluid alone": ["structures={}"],
        "structure alone, far away": [*far, "fluids={}", "boundaries={}"],
        "both in one scene, far from each other": far,
    }
    trials = {
        name: measure(load_scene("dam_break_elastic_obstacle", [*base, *more])) for name, more in runs.items()
    }
    seconds = {name: trial.seconds for name, trial in trials.items()}
    apart = seconds["no obstacle, fluid alone"] + seconds["structure alone, far away"]
    over = {
        "obstacle is a structure": (seconds["obstacle is a wall"], "the wall"),
        "both in one scene, far from each other": (apart, "the two alone"),
    }
    for name, trial in trials.items():
        base_cost, of = over.get(name, (0.0, ""))
        yield [name, *trial.cost, f"{trial.seconds / base_cost:.2f} of {of}" if of else "-"]


def held_back(ratio: float, young: float, way: Literal["auto", 1], end: float) -> Scene:
    """0.24 m of water before a clamped plate of three particles with a ratio of densities [1]."""
    dp, half, depth = 0.02, 0.4, 0.24
    thick = 3 * dp

    def box(low: tuple[float, float], high: tuple[float, float]) -> dict[str, object]:
        return {"type": "box", "min": low, "max": high}

    plate = {
        "shape": box((half, -4 * dp), (half + thick, 2 * depth - 4 * dp)),
        "material": {"density": 1000.0 * ratio, "youngs_modulus": young, "poisson_ratio": 0.3},
        "clamps": {"foot": {"region": box((half, -4 * dp), (half + thick, 0.0))}},
    }
    walls = box((0.0, 0.0), (2 * half + thick, 2 * depth))
    water = box((0.0, 0.0), (half, depth))
    return Scene.model_validate(
        {
            "name": "held_back",
            "dimension": 2,
            "spacing": dp,
            "gravity": (0.0, -9.81),
            "time": {"end": end, "frame_rate": 20.0},
            "numerics": {"sound_speed": 20.0},
            "coupling": {"sub_steps": way},
            "fluids": {"water": {"shape": water, "density": 1000.0, "pressure": {"type": "hydrostatic"}}},
            "boundaries": {"tank": {"shape": walls, "side": "outside", "open": ("y_max",)}},
            "structures": {"plate": plate},
        }
    )


def density_rows(quick: bool) -> Iterator[list[str]]:
    """Elastic energy late over early: above one where a light plate is fed, and where a heavy one still swings out."""
    end = 0.1 if quick else 0.6
    for ratio in (0.03, 0.1, 0.3, 1.0, 3.0, 10.0):
        for young in (1e6, 2e7):
            for way in COUNTS:
                if way == 1 and young > 1e6:
                    continue
                trial = measure(held_back(ratio, young, way, end), elastic_energy)
                part = len(trial.samples) // 3
                growth = trial.samples[-part:].max() / trial.samples[:part].max()
                reached = f"{growth:.2f}" if trial.end == end else f"diverged at {trial.end:.3g} s"
                yield [f"{ratio:g}", f"{young:.0e}", str(way), reached, *trial.cost]


COST = ("steps", "sub-steps", "wall [s]")
SHARED = ("steps, shared", "sub-steps, shared", "wall, shared [s]")
TABLES: dict[str, tuple[Sequence[str], Callable[[bool], Iterator[list[str]]]]] = {
    "sub_steps": (("scene", "coupling", "figure", "off", "elastic energy", *COST), sub_step_rows),
    "cases": (
        ("scene", "spacing [m]", "to [s]", "way [mm]", "off", *COST, *SHARED, "costs times"),
        case_rows,
    ),
    "stiffness": (("E [Pa]", "to the end", "largest tip [m]", *COST, "of the first"), stiffness_rows),
    "alone": (("run", *COST, "ratio"), alone_rows),
    "density": (("density ratio", "E [Pa]", "sub_steps", "late over early", *COST), density_rows),
}
"""Tables of the page by the name in their marks: columns and rows."""


def main() -> None:
    """Make all runs and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "table", nargs="*", metavar="TABLE", help=f"of {', '.join(TABLES)}; all if none is named"
    )
    parser.add_argument("--quick", action="store_true", help="short runs, printed and not written")
    asked = parser.parse_args()
    unknown = [name for name in asked.table if name not in TABLES]
    if unknown:
        parser.error(f"no table {', '.join(unknown)}; allowed: {', '.join(TABLES)}")
    wp.config.quiet = True
    for name in asked.table or TABLES:
        columns, rows = TABLES[name]
        lines = "\n".join(table(columns, rows(asked.quick)))
        if asked.quick:
            print(lines)
        else:
            rewrite(PAGE, f"<!-- {name}:begin -->", f"<!-- {name}:end -->", lines)


if __name__ == "__main__":
    main()
