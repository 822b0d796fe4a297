"""Steps of the real solver, timed in turn with the yardsticks of the machine.

Other programs slow a shared machine down for seconds at a time. A ratio of two times that follow each other feels
little of it, the median of such ratios less.
"""

from __future__ import annotations

import platform
import statistics
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import warp as wp

from warpsph.benchmark.cases import BenchmarkCase
from warpsph.benchmark.yardsticks import PlainSum, memory_bandwidth
from warpsph.solver.simulation import Simulation

TRIED_STEPS = 12
"""Steps before the first measured one: passes find out meanwhile whether to run in chunks."""
LONGEST_CYCLE = 200
"""Steps after which a block ends although no list has been made."""
LEAST_BLOCKS = 3


@dataclass(frozen=True)
class Effort:
    """How long to measure a case: seconds in all, and of one block at least."""

    total: float
    block: float


QUICK = Effort(total=4.0, block=0.1)
THOROUGH = Effort(total=20.0, block=0.3)


@dataclass(frozen=True)
class Block:
    """A few steps: how many, their seconds, the evaluations in them, and plain evaluations a second around them."""

    steps: int
    seconds: float
    evaluations: int
    plain_rate: float

    @property
    def ratio(self) -> float:
        """Evaluations a second over those of the plain sum."""
        return self.evaluations / self.seconds / self.plain_rate


def measure(
    case: BenchmarkCase,
    effort: Effort = THOROUGH,
    device: str | None = None,
    threads: int | None = None,
    extra: Sequence[str] = (),
) -> dict[str, Any]:
    """Measure a case; return its record, see docs/performance.md.

    Args:
        extra: overrides of the scene, as `key=value`.

    Raises:
        SceneError: if the scene cannot run.
    """
    scene = case.load(extra)
    start = time.perf_counter()
    simulation = Simulation(scene, device, threads)
    simulation.step()
    started = time.perf_counter() - start
    warm_up(simulation)
    before, builds = simulation.stages, simulation.list_builds
    blocks, plain = measured_blocks(simulation, effort)
    stages = {name: seconds - before.get(name, 0.0) for name, seconds in simulation.stages.items()}
    record = {
        "case": case.name,
        "scene": case.scene,
        "set": [*case.overrides, *extra],
        **_machine(simulation),
        **_sizes(simulation),
        "start_seconds": started,
        "neighbours": plain.mean_neighbours,
        **speeds(blocks, simulation.particle_count),
        **_profile(stages, blocks),
    }
    record["list_interval_steps"] = _per(record["steps"], simulation.list_builds - builds)
    bandwidth = memory_bandwidth(simulation.device, simulation.threads)
    traffic = record["bytes_per_particle"] * record["particle_steps_per_second"]
    return {**record, "bandwidth_bytes_per_second": bandwidth, "ratio_to_bandwidth": traffic / bandwidth}


def warm_up(simulation: Simulation) -> None:
    """Step until passes have settled and, in fluids, lists have just been made."""
    for _ in range(TRIED_STEPS):
        simulation.step()
    _step_to_next_list(simulation)


def measured_blocks(simulation: Simulation, effort: Effort) -> tuple[list[Block], PlainSum]:
    """Blocks of whole cycles from one list to the next, each between two plain sums."""
    scene = simulation.scene
    fields = ["velocity", *(("density", "pressure") if scene.fluids else ())]
    plain = PlainSum(scene, simulation.frame(fields, ordered=False), simulation.sound_speed)
    plain.run()
    blocks: list[Block] = []
    start = time.perf_counter()
    plain_seconds = plain.run()
    while len(blocks) < LEAST_BLOCKS or time.perf_counter() - start < effort.total:
        steps, evaluations, seconds = _block(simulation, effort.block)
        again = plain.run()
        rate = 2.0 * plain.count / (plain_seconds + again)
        blocks.append(Block(steps, seconds, evaluations, rate))
        plain_seconds = again
    return blocks, plain


def speeds(blocks: Sequence[Block], particles: int) -> dict[str, Any]:
    """The figures of the blocks: rates over all of them, the median of their ratios and its quartiles."""
    steps, seconds = sum(b.steps for b in blocks), sum(b.seconds for b in blocks)
    ratios = [b.ratio for b in blocks]
    low, middle, high = statistics.quantiles(ratios, n=4, method="inclusive")
    return {
        "steps": steps,
        "seconds": seconds,
        "particle_steps_per_second": steps * particles / seconds,
        "evaluations_per_second": sum(b.evaluations for b in blocks) / seconds,
        "plain_evaluations_per_second": statistics.median(b.plain_rate for b in blocks),
        "ratio_to_plain_sum": middle,
        "ratio_quartiles": [low, high],
    }


def _block(simulation: Simulation, least: float) -> tuple[int, int, float]:
    """Steps, evaluations and seconds of whole list cycles that take at least so long."""
    steps = evaluations = 0
    start = time.perf_counter()
    while (elapsed := time.perf_counter() - start) < least:
        cycle = _step_to_next_list(simulation)
        steps, evaluations = steps + cycle[0], evaluations + cycle[1]
    return steps, evaluations, elapsed


def _step_to_next_list(simulation: Simulation) -> tuple[int, int]:
    """Go on until lists have just been made; return the steps and the evaluations of all particles in them."""
    builds, first = simulation.list_builds, simulation.step_count
    fluid, structure = _count(simulation, "fluid"), _count(simulation, "structure")
    evaluations = 0
    while simulation.list_builds == builds and simulation.step_count - first < LONGEST_CYCLE:
        report = simulation.step()
        evaluations += fluid * report.count + structure * (report.sub_steps if fluid else report.count)
    wp.synchronize_device(simulation.device)
    return simulation.step_count - first, evaluations


def _count(simulation: Simulation, kind: str) -> int:
    return sum(count for _, of_kind, count in simulation.sets if of_kind == kind)


def _sizes(simulation: Simulation) -> dict[str, Any]:
    description = simulation.describe()
    particles = description["particles"]
    return {
        "particles": particles,
        "moving_particles": _count(simulation, "fluid") + _count(simulation, "structure"),
        "bytes_per_particle": description["bytes_per_particle"],
        "bytes_per_particle_without_lists": description["bytes_per_particle"]
        - description["list_bytes"] / particles,
    }


def _profile(stages: Mapping[str, float], blocks: Sequence[Block]) -> dict[str, Any]:
    steps, seconds = sum(b.steps for b in blocks), sum(b.seconds for b in blocks)
    by_cost = sorted(stages.items(), key=lambda item: -item[1])
    return {
        "seconds_a_step_by_stage": {name: spent / steps for name, spent in by_cost if spent > 0.0},
        "share_outside_stages": max(0.0, 1.0 - sum(stages.values()) / seconds),
    }


def _machine(simulation: Simulation) -> dict[str, Any]:
    return {
        "device": simulation.device,
        "machine": device_name(simulation.device),
        "threads": simulation.threads,
        "warp": wp.config.version,
    }


def device_name(device: str) -> str:
    """What the machine calls its processor."""
    if wp.get_device(device).is_cuda:
        return str(wp.get_device(device).name)
    lines = Path("/proc/cpuinfo").read_text().splitlines() if Path("/proc/cpuinfo").exists() else []
    models = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(models, platform.processor() or platform.machine())


def _per(steps: int, builds: int) -> float | None:
    return steps / builds if builds else None
