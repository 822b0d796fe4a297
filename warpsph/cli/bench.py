"""`warpsph bench`: how fast is the solver on this machine, and what limits it?"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from warpsph.cli.failures import BadInput, ExitCode, reported
from warpsph.cli.options import Device, Overrides, Threads, Verbose

if TYPE_CHECKING:
    from warpsph.benchmark.cases import BenchmarkCase

Quick = Annotated[bool, typer.Option("--quick", help="Four small cases, within a minute.")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object a line instead of tables.")]
Only = Annotated[
    list[str] | None,
    typer.Option(
        "--case", metavar="NAME", help="Only fluid_3d, fluid_2d, structure_3d, coupled_2d; repeatable."
    ),
]
Compare = Annotated[
    Path | None, typer.Option(metavar="OLD.json", help="Show the change from an earlier benchmark's file.")
]
Guard = Annotated[
    Path | None,
    typer.Option(
        metavar="RECORDED.json",
        help="End with exit code 1 if a ratio to the plain sum is below 0.7 of that in this file.",
    ),
]
Out = Annotated[Path, typer.Option("--out", metavar="FILE", help="File of the records.")]


@reported
def bench(
    quick: Quick = False,
    json_lines: Json = False,
    cases: Only = None,
    compare: Compare = None,
    guard: Guard = None,
    out: Out = Path("out/benchmark.jsonl"),
    device: Device = None,
    threads: Threads = None,
    overrides: Overrides = None,
    verbose: Verbose = False,
) -> ExitCode:
    """Time steps of the real solver beside two yardsticks of the machine.

    The yardsticks are its memory bandwidth and a plain SPH sum by `hash_grid_query` on one thread of the CPU. Records
    go to a file, one JSON object a line; docs/performance.md explains their keys.
    """
    from warpsph.cli.warp_runtime import start_warp

    older, recorded = _rows_of("--compare", compare), _rows_of("--guard", guard)
    start_warp(device, verbose=verbose)
    chosen = _chosen(cases, quick, device)
    from warpsph.benchmark.guard import losses, strangers
    from warpsph.benchmark.measure import QUICK, THOROUGH, measure

    rows = []
    for case in chosen:
        row = measure(case, QUICK if quick else THOROUGH, device, threads, overrides or ())
        rows.append(row)
        _show(row, json_lines)
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text("".join(json.dumps(row) + "\n" for row in rows))
    if older and not json_lines:
        _show_changes(rows, older)
    lost = losses(rows, recorded) if guard else []
    for sentence in (*lost, *strangers(rows, recorded)):
        print(sentence)
    return ExitCode.FAILED if lost else ExitCode.OK


def _rows_of(option: str, path: Path | None) -> list[dict[str, Any]]:
    from warpsph.benchmark.guard import read_rows

    try:
        return read_rows(path) if path else []
    except (OSError, ValueError) as error:
        raise BadInput(f"{option} {error}") from error


def _chosen(names: Sequence[str] | None, quick: bool, device: str | None) -> Sequence[BenchmarkCase]:
    """The cases asked for; on a GPU also sizes that only a GPU runs. Raises BadInput."""
    from warpsph.benchmark.cases import FULL, LARGE, QUICK
    from warpsph.solver.simulation import default_device

    on_gpu = (device or default_device()).startswith("cuda")
    every = QUICK if quick else (*FULL, *LARGE) if on_gpu else FULL
    known = {case.name for case in every}
    if unknown := sorted(set(names or ()) - known):
        raise BadInput(f"--case {unknown[0]}: there is no such case; there are {', '.join(sorted(known))}")
    return [case for case in every if not names or case.name in names]


def _show(row: Mapping[str, Any], json_lines: bool) -> None:
    if json_lines:
        print(json.dumps(row, allow_nan=False), flush=True)
        return
    from warpsph.cli.consoles import plain_console

    console = plain_console()
    interval, profile = row["list_interval_steps"], row["seconds_a_step_by_stage"]
    low, high = row["ratio_quartiles"]
    step = row["seconds"] / row["steps"]
    shares = ", ".join(f"{name} {spent / step:.0%}" for name, spent in list(profile.items())[:6])
    lists = f"lists made every {interval:.1f} steps" if interval else "no lists made"
    console.print(
        f"{row['case']}: {row['moving_particles']} moving particles of {row['particles']}, "
        f"{row['neighbours']:.0f} neighbours; {row['machine']}, {row['device']}, threads {row['threads']}\n"
        f"  {row['particle_steps_per_second'] / 1e6:.3g} M particle-steps/s, "
        f"{row['evaluations_per_second'] / 1e6:.3g} M evaluations/s: {row['ratio_to_plain_sum']:.2f} "
        f"({low:.2f} to {high:.2f}) times the plain sum of one thread\n"
        f"  {row['bytes_per_particle']:.0f} bytes a particle, {row['bytes_per_particle_without_lists']:.0f} without "
        f"lists; reading them once a step is {row['ratio_to_bandwidth']:.1%} of the bandwidth of "
        f"{row['bandwidth_bytes_per_second'] / 1e9:.3g} GB/s\n"
        f"  {1e3 * step:.3g} ms a step: {shares}, outside of stages {row['share_outside_stages']:.0%}; {lists}",
        soft_wrap=True,
    )


def _show_changes(rows: Sequence[Mapping[str, Any]], older: Sequence[Mapping[str, Any]]) -> None:
    from rich.table import Table

    from warpsph.benchmark.guard import partner
    from warpsph.cli.consoles import plain_console

    table = Table("case", "particles", "ratio before", "now", "change", "speed", box=None, pad_edge=False)
    for row in rows:
        old = partner(row, older)
        if old is None:
            table.add_row(row["case"], str(row["moving_particles"]), "-", f"{row['ratio_to_plain_sum']:.2f}")
            continue
        before, now = old["ratio_to_plain_sum"], row["ratio_to_plain_sum"]
        speed = row["particle_steps_per_second"] / old["particle_steps_per_second"] - 1.0
        figures = (f"{before:.2f}", f"{now:.2f}", f"{now / before - 1.0:+.0%}", f"{speed:+.0%}")
        table.add_row(row["case"], str(row["moving_particles"]), *figures)
    plain_console().print(table)
