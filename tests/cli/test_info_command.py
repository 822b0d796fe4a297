"""`warpsph info`: what would run."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

from warpsph.cli.info import size_in_words


def test_info_names_sets_fields_limits_passes_and_estimate(
    warpsph: Callable[..., Result], scene_file: Path
) -> None:
    result = warpsph("info", scene_file)
    assert result.exit_code == 0
    for part in ("water", "boundary", "position", "dt [s]", "acoustic", "passes a step", "estimate"):
        assert part in result.stdout


def test_info_compares_shapes_with_their_particles(warpsph: Callable[..., Result], tmp_path: Path) -> None:
    """Five by ten cells of a tenth in a box of 0.52 m by 1 m: 3.85 % too little."""
    scene = tmp_path / "column.yaml"
    scene.write_text(
        "name: column\ndimension: 2\nspacing: 0.1\ngravity: [0, -9.81]\ntime: {end: 0.1, frame_rate: 10}\n"
        "fluids: {water: {shape: {type: box, min: [0, 0], max: [0.52, 1]}, density: 1000, placement: relaxed}}\n"
    )
    result = warpsph("info", scene)
    assert result.exit_code == 0
    (row,) = [line for line in result.stdout.splitlines() if "-3.85%" in line]
    for part in ("water", "box", "0.52", "0.5", "0 to 0.52"):
        assert part in row
    assert "unevenness" in result.stdout


@pytest.mark.parametrize(
    ("size", "text"), [(999, "999 B"), (120_000, "120 kB"), (5.16e7, "51.6 MB"), (2e10, "20 GB")]
)
def test_memory_in_words(size: float, text: str) -> None:
    assert size_in_words(size) == text
