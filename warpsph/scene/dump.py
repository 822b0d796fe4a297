"""A scene as the text of a scene file."""

from __future__ import annotations

import os
from collections.abc import Callable
from io import StringIO
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap, CommentedSeq
from ruamel.yaml.representer import RoundTripRepresenter
from ruamel.yaml.scalarstring import DoubleQuotedScalarString

from warpsph.scene.file_names import with_file_names
from warpsph.scene.types import SceneModel

_WIDTH = 110
_RARE_BREAKS = "\x85\u2028\u2029"
"""Line breaks that only double quotes keep: within single ones they are folded to a blank."""


class _Representer(RoundTripRepresenter):
    """Writes null in full; ruamel leaves an empty place."""


_Representer.add_representer(
    type(None), lambda representer, _: representer.represent_scalar("tag:yaml.org,2002:null", "null")
)


def to_yaml(scene: SceneModel, base_directory: Path, directory: Path | None) -> str:
    """Text with every key of the scene, defaults filled in.

    Relative file names count from `base_directory`; where a `directory` is given, they are rewritten to count
    from there.
    """
    yaml = YAML()
    yaml.Representer = _Representer
    yaml.width = _WIDTH
    data = scene.model_dump()
    if directory is not None:
        data = with_file_names(data, _moving(base_directory.resolve(), directory.resolve()))
    stream = StringIO()
    yaml.dump(_styled(data), stream)
    return stream.getvalue()


def _moving(origin: Path, destination: Path) -> Callable[[str], str]:
    """What lets relative file names count from another directory."""
    return lambda name: name if Path(name).is_absolute() else os.path.relpath(origin / name, destination)


def _styled(data: Any) -> Any:
    """Mappings in block style with `type` first, lists of plain values on one line."""
    if isinstance(data, dict):
        keys = sorted(data, key=lambda key: key != "type")
        return CommentedMap((key, _styled(data[key])) for key in keys)
    if isinstance(data, list | tuple):
        items = CommentedSeq(_styled(item) for item in data)
        if not any(isinstance(item, CommentedMap) for item in items):
            items.fa.set_flow_style()
        return items
    if isinstance(data, float):
        return float(data)
    if isinstance(data, str) and any(mark in data for mark in _RARE_BREAKS):
        return DoubleQuotedScalarString(data)
    return data
