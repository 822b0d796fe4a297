"""Runs of shipped scenes with some choice changed, and the tables that they fill."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import warp as wp

from warpsph import load_scene
from warpsph.solver.run import run_scene

BEGIN, END = "<!-- table:begin -->", "<!-- table:end -->"


def run_trial(scene: str, overrides: Sequence[str]) -> tuple[Mapping[str, Any], float]:
    """Summary of a scene with overrides, and the CPU seconds of its one thread, preparation included."""
    wp.config.quiet = True
    with tempfile.TemporaryDirectory() as directory:
        begun = time.process_time()
        loaded = load_scene(scene, ["output.usd=false", *overrides])
        summary = run_scene(loaded, directory, device="cpu", threads=1)
        return summary, time.process_time() - begun


def table(columns: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """Lines of a table in Markdown."""
    return [_line(columns), _line(["---"] * len(columns)), *(_line(row) for row in rows)]


def write_table(page: Path, lines: Iterable[str]) -> None:
    """Replace what stands between the marks of a page."""
    before, rest = page.read_text(encoding="utf-8").split(BEGIN)
    _, after = rest.split(END)
    page.write_text("\n".join([before + BEGIN, *lines, END + after]), encoding="utf-8")


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"
