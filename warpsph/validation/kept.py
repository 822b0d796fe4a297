"""Runs of an earlier validation that need not be made again."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from warpsph.output.run_directory import RunDirectory
from warpsph.scene.schema import Scene


def kept_summary(scene: Scene, directory: Path) -> Mapping[str, Any] | None:
    """The summary of a complete run of the same scene in the directory; None if there is none.

    The same is a scene with every value the same, the spacing and all defaults among them, whose tables in files have
    not been written since.
    """
    run = RunDirectory(directory)
    try:
        same = run.scene.read_text(encoding="utf-8") == scene.to_yaml(directory)
        newest_table = max((path.stat().st_mtime for path in _tables(scene)), default=0.0)
        if not same or newest_table > run.summary.stat().st_mtime:
            return None
        summary = json.loads(run.summary.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return summary if summary.get("status") == "complete" else None


def _tables(scene: Scene) -> Iterator[Path]:
    """Every file that the scene names."""
    return (scene.base_directory / name for name in _file_names(scene.model_dump()))


def _file_names(data: Any) -> Iterator[str]:
    if isinstance(data, Mapping):
        for key, value in data.items():
            if key == "file" and isinstance(value, str):
                yield value
            yield from _file_names(value)
    elif isinstance(data, list | tuple):
        for item in data:
            yield from _file_names(item)
