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


@pytest.mark.parametrize(
    ("size", "text"), [(999, "999 B"), (120_000, "120 kB"), (5.16e7, "51.6 MB"), (2e10, "20 GB")]
)
def test_memory_in_words(size: float, text: str) -> None:
    assert size_in_words(size) == text
