"""A picture of the particles of a run, where its frames are kept. Needs the extra `render`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from warpsph.output.run_directory import RunDirectory
from warpsph.scene.schema import Scene
from warpsph.validation.runner import CaseResult

SIZE = (960, 540)


def scene_picture(results: Sequence[CaseResult], directory: Path) -> bytes | None:
    """The last frame of the finest run below the directory whose frames are kept as USD, as a PNG; None without any.

    Raises RenderError or OutputError if it cannot be drawn.
    """
    from warpsph.rendering.movie import render

    for result in sorted(results, key=lambda result: result.case.scene.spacing):
        scene, run = result.case.scene, RunDirectory(directory / result.case.directory)
        if result.failure is None and scene.output.usd and run.usd.is_file():
            drawn = render(run.path, field=_field(scene), size=SIZE, frames="-1")
            return drawn.images[0].read_bytes()
    return None


def _field(scene: Scene) -> str:
    """Structures at rest say more by their stress than by their speed."""
    return "von_mises" if not scene.fluids and "von_mises" in scene.output.fields else "velocity"
