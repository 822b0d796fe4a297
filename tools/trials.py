"""Runs of shipped scenes with some choice changed, and the pages that their tables stand on."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import warp as wp
from pages import rewrite, table

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


def write_table(page: Path, columns: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """Put a table between the marks of a page."""
    rewrite(page, BEGIN, END, "\n".join(table(columns, rows)))
