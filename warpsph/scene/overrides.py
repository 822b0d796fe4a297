"""Values given beside the scene file: key.sub=value."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from warpsph.scene.document import Document, Path, Place, dotted, parse
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.rules import rule_at


def apply_override(document: Document, override: str) -> None:
    """Put the value of `key.sub=value`, read as YAML, in its place; SceneError where that cannot be."""
    place = Place(f"--set {override}")
    key, equals, text = override.partition("=")
    parts = key.strip().split(".")
    if not equals or not all(parts):
        allowed = "key=value or key.sub=value"
        raise SceneError([Problem(place.file, None, "", Problem.NOTHING, "this is no override", allowed)])
    set_value(document, parts, _value(text, place), place)


def _value(text: str, place: Place) -> Any:
    try:
        return parse(text, place.file).data
    except SceneError as error:
        raise SceneError(replace(problem, line=None) for problem in error.problems) from error


def set_value(document: Document, parts: Sequence[str], value: Any, place: Place) -> None:
    """Put a value at the path of these keys and list indices, making mappings where nothing stands yet.

    A new mapping that stands for an object with a default takes the default's `type`.
    """
    path: Path = ()
    node = document.data
    for part in parts[:-1]:
        step = _step(node, path, part, place)
        path = (*path, step)
        if isinstance(node, dict) and node.get(step) is None:
            default = rule_at(path, document.data).default_type
            node[step] = {} if default is None else {"type": default}
            document.places[path] = place
        node = node[step]
    last = _step(node, path, parts[-1], place)
    node[last] = value
    document.forget((*path, last))
    document.places[(*path, last)] = place


def _step(node: Any, path: Path, part: str, place: Place) -> str | int:
    """The key or index of a part in a node that must be a mapping, or a list that is long enough."""
    if isinstance(node, dict):
        return part
    key = dotted((*path, part))
    if not isinstance(node, list):
        message = f"{dotted(path) or 'the scene'} is no mapping, so it has no key {part!r}"
        raise SceneError([Problem(place.file, place.line, key, node, message, "a key of a mapping")])
    if not part.isdecimal() or int(part) >= len(node):
        allowed = f"an index from 0 to {len(node) - 1}" if node else "nothing: the list is empty"
        raise SceneError([Problem(place.file, place.line, key, part, "the list has no such item", allowed)])
    return int(part)
