"""The benchmark: its yardstick computes the solver's scheme, its figures follow from its blocks, its guard guards."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from warpsph.benchmark.cases import FULL, QUICK, BenchmarkCase
from warpsph.benchmark.guard import losses, read_rows, strangers
from warpsph.benchmark.measure import Block, speeds
from warpsph.benchmark.yardsticks import PlainSum, memory_bandwidth
from warpsph.cli.app import app
from warpsph.scene import load_scene
from warpsph.solver.simulation import Simulation

ROUNDING = {"acceleration": 2e-4, "density_rate": 1e-3}
"""Of sums of some thirty terms in single precision that cancel. The plain sum stores rho, not its deviation: half a
unit in its last place, 3e-5 kg/m2, times 2 delta h c0 sum |V F| = 0.2 c0 / h times 5, is 3e-3 of a rate of
5 kg/m2/s."""
KEYS = {"particle_steps_per_second", "neighbours", "ratio_to_plain_sum", "bytes_per_particle"}


@pytest.mark.parametrize("case", [*QUICK, *FULL], ids=lambda case: f"{case.name}-{case.particles}")
def test_cases_are_shipped_scenes_of_about_the_size_they_name(case: BenchmarkCase) -> None:
    scene = case.load()
    assert case.content / scene.spacing**scene.dimension == pytest.approx(case.particles, rel=0.01)


def test_the_plain_sum_finds_the_accelerations_and_density_rates_of_the_solver() -> None:
    """Without walls, over a step so short that the state before it is that within it."""
    scene = load_scene("rotating_patch", ["spacing=0.05", "time.max_step=1e-9"])
    simulation = Simulation(scene, "cpu", 1)
    simulation.step()
    frame = simulation.frame(["velocity", "density", "pressure"], ordered=False)
    plain = PlainSum(scene, frame, simulation.sound_speed)
    plain.run()
    for name, yardstick in (("acceleration", plain.acceleration), ("density_rate", plain.density_rate)):
        state = simulation.system.parts.assembly.state
        solver = np.asarray(getattr(state, name).numpy())
        found = yardstick.numpy()[:, :2] if solver.ndim == 2 else yardstick.numpy()
        scale = np.abs(solver).max()
        assert scale > 0.0
        np.testing.assert_allclose(found, solver, rtol=0.0, atol=ROUNDING[name] * scale)


def test_the_ratio_is_the_median_of_ratios_of_neighbouring_times() -> None:
    """A machine that is slow for one block slows its yardstick as well; a disturbed block counts as one of three."""
    blocks = [
        Block(10, 1.0, 3000, 1000.0),
        Block(10, 4.0, 3000, 250.0),
        Block(10, 1.0, 300, 1000.0),
    ]
    figures = speeds(blocks, particles=500)
    assert figures["ratio_to_plain_sum"] == pytest.approx(3.0)
    assert figures["particle_steps_per_second"] == pytest.approx(30 * 500 / 6.0)


def test_bandwidth_is_that_of_a_memory() -> None:
    assert 1e8 < memory_bandwidth("cpu", 1) < 1e13


def row(ratio: float, **changes: Any) -> dict[str, Any]:
    return {"case": "fluid_2d", "ratio_to_plain_sum": ratio, "threads": 1, "moving_particles": 10, **changes}


@pytest.mark.parametrize(("ratio", "lost"), [(2.0, False), (1.41, False), (1.39, True)])
def test_the_guard_finds_a_loss_of_more_than_thirty_per_cent(ratio: float, lost: bool) -> None:
    assert bool(losses([row(ratio)], [row(2.0)])) is lost


def test_the_guard_does_not_judge_what_was_recorded_on_another_processor() -> None:
    here, there = row(1.0, machine="here"), row(9.0, machine="there")
    assert losses([here], [there]) == []
    assert strangers([here], [there]) == ["fluid_2d: recorded on there, not judged on here"]
    assert strangers([here], [here]) == []


def test_the_guard_misses_no_case_without_a_record() -> None:
    assert "no recorded ratio" in losses([row(2.0, threads=2)], [row(2.0)])[0]


def test_bench_prints_and_stores_the_same_records(tmp_path: Path, bench: Callable[..., Result]) -> None:
    out = tmp_path / "records.jsonl"
    result = bench("--case", "fluid_2d", "--json", "--out", out)
    assert result.exit_code == 0
    (record,) = map(json.loads, result.stdout.splitlines())
    assert read_rows(out) == [record]
    assert record.keys() >= KEYS
    assert 20 < record["neighbours"] < 30
    assert sum(record["seconds_a_step_by_stage"].values()) <= record["seconds"] / record["steps"]


def test_bench_ends_with_1_where_the_guard_finds_a_loss(tmp_path: Path, bench: Callable[..., Result]) -> None:
    out = tmp_path / "records.jsonl"
    assert bench("--case", "fluid_2d", "--out", out).exit_code == 0
    (record,) = read_rows(out)
    impossible = tmp_path / "recorded.jsonl"
    impossible.write_text(json.dumps({**record, "ratio_to_plain_sum": 1e6}))
    result = bench("--case", "fluid_2d", "--guard", impossible, "--compare", out, "--out", out)
    assert result.exit_code == 1
    assert "times the plain sum; allowed: at least" in result.stdout


@pytest.mark.parametrize(
    "arguments", [("--case", "gas"), ("--guard", "nowhere.json"), ("--compare", "nowhere.json")]
)
def test_requests_that_cannot_be_met_are_refused(
    arguments: tuple[str, ...], bench: Callable[..., Result]
) -> None:
    assert bench(*arguments).exit_code == 2


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Result]:
    """Call `warpsph bench --quick ARGUMENTS...` with the shortest measurement."""
    from warpsph.benchmark.measure import Effort

    monkeypatch.setattr("warpsph.benchmark.measure.QUICK", Effort(total=0.1, block=0.01))

    def call(*arguments: Any) -> Result:
        words = ["bench", "--quick", "--threads", "1", "--device", "cpu", *map(str, arguments)]
        return CliRunner().invoke(app, words)

    return call
