"""Whether a checkpoint belongs to the run that asks for it."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ruamel.yaml import YAML

from warpsph import __version__
from warpsph.output.checkpoint import Checkpoint, CheckpointError
from warpsph.scene.schema import Scene

FREE_KEYS = {"description", "references", "validation"}
"""Keys that may differ between the checkpoint's scene and the one that goes on."""


def require_time_left(scene: Scene, time: float, path: Path) -> None:
    """Raise CheckpointError if the checkpoint is of a time [s] after the end of the scene."""
    if time > scene.time.end:
        raise CheckpointError(
            path, f"it is of t = {time:.6g} s, after time.end = {scene.time.end:.6g} s; allowed: a later end"
        )


def require_all_of(state: Iterable[str], checkpoint: Checkpoint, path: Path) -> None:
    """Raise CheckpointError if a checkpoint has no value for one of the names of the simulation's state.

    So it is with checkpoints of versions that did not have some field or term of the present scheme.
    """
    if missing := sorted(set(state) - set(checkpoint.state["simulation"])):
        writer = (
            f"warpsph {checkpoint.writer}" if checkpoint.writer else "a version that did not leave its name"
        )
        raise CheckpointError(
            path,
            f"it lacks {', '.join(missing)}, which warpsph {__version__} needs to go on; it was written by {writer}. "
            "Start anew, without --resume, or go on with the version that wrote it",
        )


def require_same_run(scene: Scene, checkpoint_text: str, path: Path) -> None:
    """Raise CheckpointError unless the checkpoint was written by the same scene; only its end may be later."""
    yaml = YAML(typ="safe", pure=True)
    then, now = yaml.load(checkpoint_text), yaml.load(scene.to_yaml())
    for document in (then, now):
        document["time"].pop("end", None)
        for key in FREE_KEYS:
            document.pop(key, None)
    differing = sorted(key for key in {*then, *now} if then.get(key) != now.get(key))
    if differing:
        raise CheckpointError(
            path,
            f"it was written by another scene: {', '.join(differing)} differ. "
            "Run without --resume, or with the scene.yaml beside the checkpoint",
        )
