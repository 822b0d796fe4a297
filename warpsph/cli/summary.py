"""The summary of a run, as a person reads it at its end."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from warpsph.cli.plan import outcome_in_words, plan_in_words
from warpsph.cli.progress import duration, rate_in_words
from warpsph.cli.tables import comparison_table, estimate_table

Summary = Mapping[str, Any]


def show_summary(console: Console, directory: Path, summary: Summary) -> None:
    """Where the files are, what the run cost, how its steps were chosen, and how good the numbers are."""
    table = Table(show_header=False, box=None, pad_edge=False)
    for name, text in _lines(directory, summary):
        table.add_row(name, text)
    console.print(table)
    for warning in summary["warnings"]:
        console.print(f"warning: {warning}", style="yellow", soft_wrap=True)
    if summary["references"]:
        console.print()
        console.print(comparison_table(summary["references"]))
    if summary.get("discretisation_error"):
        console.print()
        console.print(estimate_table(summary["discretisation_error"]))


def _lines(directory: Path, summary: Summary) -> Iterator[tuple[str, str]]:
    files = sorted(path.name for path in directory.iterdir() if path.is_file())
    yield "directory", str(directory)
    if summary.get("plan"):
        yield "plan", plan_in_words(summary["plan"])
        yield "accuracy", outcome_in_words(summary["plan"])
    yield "files", ", ".join(files)
    particles = f"{summary['particles']} particles" + _removed(summary["removed_particles"])
    yield "run", f"{summary['frames']} frames to t = {summary['simulated_s']:.6g} s, {particles}"
    yield "wall time", f"{duration(summary['wall_s'])} on {summary['device']}, {summary['threads']} threads"
    if summary["particle_steps_per_second"]:
        yield "pace", rate_in_words(summary["particle_steps_per_second"])
    if summary["steps"]["count"]:
        yield "steps", _steps(summary["steps"])


def _removed(count: int) -> str:
    return f" ({count} left the kill box)" if count else ""


def _steps(steps: Mapping[str, Any]) -> str:
    ruling = sorted(steps["limited_by"].items(), key=lambda item: -item[1])
    shares = ", ".join(f"{limit} {number / steps['count']:.0%}" for limit, number in ruling)
    within = f" and {steps['sub_steps']} of structures within" if steps["sub_steps"] else ""
    return f"{steps['count']}{within}, dt = {steps['mean_s']:.3g} s on average; limited by {shares}"
