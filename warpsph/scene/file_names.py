"""The names of files in the data of a scene: the values of every key `file`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


def with_file_names(data: Any, renamed: Callable[[str], str]) -> Any:
    """A copy of plain data in which every file name is what `renamed` makes of it."""
    if isinstance(data, dict):
        return {
            key: renamed(value)
            if key == "file" and isinstance(value, str)
            else with_file_names(value, renamed)
            for key, value in data.items()
        }
    return [with_file_names(item, renamed) for item in data] if isinstance(data, list | tuple) else data


def file_names(data: Any) -> tuple[str, ...]:
    """All file names in plain data, in its order."""
    found: list[str] = []

    def note(name: str) -> str:
        found.append(name)
        return name

    with_file_names(data, note)
    return tuple(found)
