"""Runs of an earlier validation that need not be made again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from warpsph.output.run_directory import RunDirectory
from warpsph.scene.file_names import file_names
from warpsph.scene.schema import Scene


def kept_summary(scene: Scene, directory: Path) -> Mapping[str, Any] | None:
    """The summary of a complete run of the same scene in the directory; None if there is none.

    The same is a scene with every value the same, the spacing and all defaults among them, whose tables in files have
    not been written since.
    """
    run = RunDirectory(directory)
    try:
        same = run.scene.read_text(encoding="utf-8") == scene.to_yaml(directory)
        tables = (scene.base_directory / name for name in file_names(scene.model_dump()))
        newest_table = max((path.stat().st_mtime for path in tables), default=0.0)
        if not same or newest_table > run.summary.stat().st_mtime:
            return None
        summary = json.loads(run.summary.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return summary if summary.get("status") == "complete" else None
