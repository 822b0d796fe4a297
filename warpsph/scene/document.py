"""A YAML text as plain data in which every value knows its line."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode
from ruamel.yaml.reader import ReaderError

from warpsph.scene.errors import Problem, SceneError

Path = tuple[str | int, ...]

MAX_BYTES = 1_000_000
_MAX_VALUES = 200_000
_MAX_DEPTH = 60
_VALUE_TAGS = frozenset(f"tag:yaml.org,2002:{name}" for name in ("int", "float", "bool", "null"))
_TEXT_TAGS = frozenset(f"tag:yaml.org,2002:{name}" for name in ("str", "timestamp", "merge", "value"))


@dataclass(frozen=True)
class Place:
    """Where a value was written: in a line of a file, or in an override without a line."""

    file: str
    line: int | None = None


@dataclass
class Document:
    """Plain data (dict, list, str, int, float, bool, None) and the place of each value in it."""

    data: Any
    places: dict[Path, Place]

    def place(self, path: Path) -> Place:
        """Place of a value, or of the nearest thing around it that was written."""
        while path not in self.places:
            path = path[:-1]
        return self.places[path]

    def forget(self, path: Path) -> None:
        """Drop the places of a value and of all inside it, because something else replaces it."""
        for known in [known for known in self.places if known[: len(path)] == path]:
            del self.places[known]


def placed(problem: Problem, document: Document) -> Problem:
    """The problem with the place of its key in the document, unless it knows its place."""
    if problem.file is not None:
        return problem
    path: Path = ()
    data = document.data
    for part in problem.key.split(".") if problem.key else ():
        item = int(part) if isinstance(data, list) and part.isdecimal() else part
        path, data = (*path, item), data[item] if holds(data, item) else None
    place = document.place(path)
    return replace(problem, file=place.file, line=place.line)


def holds(data: Any, part: str | int) -> bool:
    """Whether the data has an item at this key or index."""
    if isinstance(data, list):
        return isinstance(part, int) and 0 <= part < len(data)
    return isinstance(data, dict) and part in data


def dotted(path: Path) -> str:
    """The path as a person types it: boundaries.tank.shape.max.0."""
    return ".".join(str(part) for part in path)


def decode(content: bytes, file: str) -> str:
    """The bytes of a file as text; SceneError where they are not UTF-8 or far too many."""
    if len(content) > MAX_BYTES:
        message = f"the file holds more than {MAX_BYTES} bytes"
        raise _error(Place(file), message, "a scene file; tables belong in CSV files")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        message = f"byte 0x{content[error.start]:02x} is not UTF-8 text"
        raise _error(Place(file, line), message, "a YAML file in UTF-8") from error


def parse(text: str, file: str) -> Document:
    """Data and places of a YAML 1.2 text; SceneError with every problem of the text itself."""
    yaml = YAML(typ="safe", pure=True)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            root = yaml.compose(text)
    except (YAMLError, RecursionError, ValueError, TypeError, AttributeError, IndexError, KeyError) as error:
        raise _syntax_error(error, text, file) from error
    reader = _Reader(yaml, file)
    start = Place(file, 1)
    data = None if root is None else reader.value(root, (), start)
    if reader.problems:
        raise SceneError(reader.problems)
    return Document(data, {(): start, **reader.places})


class _Reader:
    """Turns composed YAML nodes into data; collects places and problems on the way."""

    def __init__(self, yaml: YAML, file: str) -> None:
        self.places: dict[Path, Place] = {}
        self.problems: list[Problem] = []
        self._yaml = yaml
        self._file = file

    def value(self, node: Node, path: Path, place: Place) -> Any:
        self.places[path] = place
        if len(path) > _MAX_DEPTH or len(self.places) > _MAX_VALUES:
            message = "it is nested too deeply or expands to too many values"
            raise _error(place, message, f"{_MAX_DEPTH} levels, {_MAX_VALUES} values", dotted(path[:4]))
        if isinstance(node, MappingNode):
            return dict(self._items(node, path))
        if isinstance(node, SequenceNode):
            return [
                self.value(item, (*path, index), self._place(item)) for index, item in enumerate(node.value)
            ]
        assert isinstance(node, ScalarNode)
        return self._scalar(node, path, place)

    def _items(self, node: MappingNode, path: Path) -> Iterator[tuple[str, Any]]:
        lines: dict[str, int | None] = {}
        for key_node, value_node in node.value:
            key, place = key_node.value, self._place(key_node)
            if key_node.tag not in _TEXT_TAGS:
                self._report(place, path, "a key must be a word", "letters, digits and underscores", key_node)
            elif key in lines:
                message = f"the key stands in line {lines[key]} already"
                self._report(place, (*path, key), message, "each key once", value_node)
            else:
                lines[key] = place.line
                yield key, self.value(value_node, (*path, key), place)

    def _scalar(self, node: ScalarNode, path: Path, place: Place) -> Any:
        if node.tag in _TEXT_TAGS:
            return node.value
        try:
            if node.tag in _VALUE_TAGS:
                return self._yaml.constructor.construct_object(node)
            self._report(place, path, f"the tag {node.tag} is not known", "values without a tag", node)
        except (YAMLError, ValueError, OverflowError):
            self._report(place, path, "the value cannot be read", "such as 1, 0.5, 1e-6, true, null", node)
        return None

    def _place(self, node: Node) -> Place:
        return Place(self._file, node.start_mark.line + 1)

    def _report(self, place: Place, path: Path, message: str, allowed: str, node: Node) -> None:
        value = node.value if isinstance(node, ScalarNode) else "a collection"
        self.problems.append(Problem(place.file, place.line, dotted(path), value, message, allowed))


def _syntax_error(error: Exception, text: str, file: str) -> SceneError:
    if isinstance(error, MarkedYAMLError):
        mark = error.problem_mark or error.context_mark
        message = ", ".join(part for part in (error.context, error.problem) if part)
        place = Place(file, mark.line + 1 if mark else None)
        return _error(place, f"this is not valid YAML: {message}", "YAML 1.2, one document")
    if isinstance(error, ReaderError):
        line = text.count("\n", 0, error.position) + 1
        return _error(Place(file, line), f"this is not text: {error.reason}", "a YAML file in UTF-8")
    if isinstance(error, RecursionError):
        return _error(Place(file), "it is nested too deeply", f"{_MAX_DEPTH} levels")
    return _error(Place(file), f"this is not valid YAML: {error}", "YAML 1.2, one document")


def _error(place: Place, message: str, allowed: str, key: str = "") -> SceneError:
    return SceneError([Problem(place.file, place.line, key, Problem.NOTHING, message, allowed)])
