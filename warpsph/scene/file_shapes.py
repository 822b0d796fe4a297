"""Shapes that come from files, and where those are."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import PrivateAttr

from warpsph.scene.shape_model import ShapeModel

if TYPE_CHECKING:
    from warpsph.scene.checks.common import DeclaredNames


Stamp = tuple[int, int]
"""Time of change [ns] and size [B] of a file."""


@dataclass(frozen=True)
class LoadContext:
    """The context in which the models of a scene file are validated."""

    directory: Path
    declared: DeclaredNames | None = None


def directory_of(context: object) -> Path:
    """Where relative file names count from: the directory of the scene file; without one the current directory."""
    return context.directory if isinstance(context, LoadContext) else Path.cwd()


def stamp_of(path: Path) -> Stamp | None:
    """What changes when a file does; None where it cannot be looked at."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size


class FileShape(ShapeModel):
    """Base of the shapes that may come from a file; it is read once, when the shape is made."""

    _directory: Path = PrivateAttr(default_factory=Path.cwd)

    def model_post_init(self, context: Any, /) -> None:
        self._directory = directory_of(context)
