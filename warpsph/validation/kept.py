"""Runs of an earlier validation that need not be made again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from warpsph.output.run_directory import RunDirectory
from warpsph.scene.schema import Scene


def kept_summary(scene: Scene, directory: Path) -> Mapping[str, Any] | None:
    """The summary of a complete run of the same scene in the directory; None if there is none.

    The same is a scene with every value the same, the spacing and all defaults among them.
    """
    run = RunDirectory(directory)
    try:
        same = run.scene.read_text(encoding="utf-8") == scene.to_yaml(directory)
        summary = json.loads(run.summary.read_text(encoding="utf-8")) if same else {}
    except (OSError, ValueError):
        return None
    return summary if summary.get("status") == "complete" else None
