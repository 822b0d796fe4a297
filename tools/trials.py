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


def error_text(reference: Mapping[str, Any]) -> str:
    """Name and error of a compared quantity, bold where its bound does not hold."""
    name, error, unit = (
        reference["quantity"].replace("_", " "),
        reference["error"],
        reference.get("error_unit"),
    )
    if error is None:
        return f"{name} -"
    if unit:
        return f"{name} holds" if reference["holds"] else f"**{name} does not hold**"
    text = f"{name} {100.0 * error:.2g} %"
    return f"**{text}**" if reference["holds"] is False else text


def write_table(page: Path, columns: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """Put a table between the marks of a page."""
    rewrite(page, BEGIN, END, "\n".join(table(columns, rows)))
