"""The scenes that come with the package."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parents[1]
_INSTALLED = _PACKAGE / "_scenes"
_CHECKOUT = _PACKAGE.parent / "scenes"


def shipped_scenes() -> dict[str, Path]:
    """File of every shipped scene by its name, in alphabetical order."""
    directory = _INSTALLED if _INSTALLED.is_dir() else _CHECKOUT
    return {path.stem: path for path in sorted(directory.glob("*.yaml"))}
