"""From what pydantic refuses to problems with a key, a place and what is allowed."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from pathlib import Path as Directory
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from warpsph.scene.checks.common import DeclaredNames, suggestion
from warpsph.scene.document import Document, Path, dotted, holds, placed
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.file_shapes import LoadContext
from warpsph.scene.rules import rule_at
from warpsph.scene.schema import Scene
from warpsph.scene.types import NAME_RULE

_IGNORED = frozenset({"default_factory_not_called"})
_WRONG_KIND = frozenset({"literal_error", "is_instance_of"})
_MESSAGES: Mapping[str, str] = {
    "greater_than": "the number is too small",
    "greater_than_equal": "the number is too small",
    "less_than": "the number is too large",
    "less_than_equal": "the number is too large",
    "finite_number": "the number is not finite",
    "too_short": "too few values",
    "too_long": "too many values",
    "string_too_short": "the text is empty",
    "string_pattern_mismatch": "this is not spelled as a name must be",
}
_NAMED_SECTIONS = ("fluids", "boundaries", "structures", "probes", "references")
_OPTIONAL_SECTIONS = ("domain", "numerics", "contact", "output", "accuracy", "validation", "description")
_STAND_INS: Mapping[str, Any] = {"name": "unnamed", "time": {"end": 1.0, "frame_rate": 1.0}}


def validated(document: Document, directory: Directory) -> Scene:
    """The scene of a document; SceneError with all its problems, in the order of the file.

    Relative file names count from the directory.
    """
    try:
        return Scene.model_validate(document.data, context=LoadContext(directory))
    except ValidationError as error:
        problems = [*_problems(error, document), *_problems_of_the_rest(error, document, directory)]
    raise SceneError(sorted(problems, key=lambda problem: (problem.line is None, problem.line or 0)))


def _problems(error: ValidationError, document: Document) -> Iterator[Problem]:
    details: defaultdict[Path, list[ErrorDetails]] = defaultdict(list)
    for detail in error.errors(include_url=False):
        cause = detail.get("ctx", {}).get("error")
        if isinstance(cause, SceneError):
            yield from (placed(problem, document) for problem in cause.problems)
        elif detail["type"] not in _IGNORED:
            details[_resolved(detail, document.data)].append(detail)
    for path, alternatives in details.items():
        if not _follows_from_others(path, alternatives, details):
            yield _problem(path, _most_telling(alternatives), document)


def _resolved(detail: ErrorDetails, data: Any) -> Path:
    """Path in the data; pydantic's own also names the branches of unions that it tried."""
    path: Path = ()
    tag_seen = False
    *parents, last = detail["loc"] or ("",)
    for part in parents:
        is_tag = not tag_seen and isinstance(data, dict) and "type" in data and data["type"] == part
        if is_tag:
            tag_seen = True
        elif holds(data, part):
            path, data, tag_seen = (*path, part), data[part], False
    names_a_key = detail["type"] in ("missing", "extra_forbidden") or holds(data, last)
    path = (*path, last) if names_a_key and last != "[key]" and detail["loc"] else path
    return (
        (*path, "type")
        if detail["type"].startswith("union_tag") and isinstance(detail["input"], dict)
        else path
    )


def _follows_from_others(path: Path, alternatives: list[ErrorDetails], details: Mapping[Path, Any]) -> bool:
    """pydantic also calls a list too short when its items are refused."""
    inside = any(len(other) > len(path) and other[: len(path)] == path for other in details)
    return inside and all(detail["type"] == "too_short" for detail in alternatives)


def _most_telling(alternatives: list[ErrorDetails]) -> ErrorDetails:
    """Of the branches of a union, one that took the kind of value but not this one."""

    def wrong_kind(detail: ErrorDetails) -> bool:
        return detail["type"] in _WRONG_KIND or detail["type"].endswith("_type")

    return min(alternatives, key=wrong_kind)


def _problem(path: Path, detail: ErrorDetails, document: Document) -> Problem:
    message, allowed = _explained(path, detail, document.data)
    value = Problem.NOTHING if detail["type"] in ("missing", "union_tag_not_found") else detail["input"]
    if detail["type"] == "union_tag_invalid":
        value = detail["ctx"]["tag"]
    if detail["loc"][-1:] == ("[key]",):
        value = path[-1]
    place = document.place(path)
    return Problem(place.file, place.line, dotted(path), value, message, allowed)


def _explained(path: Path, detail: ErrorDetails, data: Any) -> tuple[str, str]:
    """Message, and what would be allowed."""
    if detail["loc"][-1:] == ("[key]",):
        names = rule_at(path[:-1], data).keys
        return "this key is not spelled as a name must be", ", ".join(names) or NAME_RULE
    rule, name = rule_at(path, data), path[-1] if path else ""
    allowed = _joined(rule.allowed, _description(path, data))
    match detail["type"]:
        case "extra_forbidden":
            keys = rule_at(path[:-1], data).keys
            return f"unknown key {name!r}{suggestion(str(name), keys)}", ", ".join(keys)
        case "missing":
            return f"the key {name!r} is missing", allowed
        case "union_tag_invalid":
            types, tag = rule_at(path[:-1], data).types, detail["ctx"]["tag"]
            return f"unknown type {tag!r}{suggestion(tag, types)}", ", ".join(types)
        case "union_tag_not_found":
            return "the key 'type' is missing", ", ".join(rule_at(path[:-1], data).types)
        case "value_error":
            return str(detail["ctx"]["error"]), _description(path, data)
        case "literal_error":
            near = suggestion(str(detail["input"]), rule.choices)
            return f"this value is not allowed here{near}", allowed
        case kind:
            return _MESSAGES.get(kind, "this value is not allowed here"), allowed


def _description(path: Path, data: Any) -> str:
    """What the value means; an item of a list has its meaning from the list."""
    rule = rule_at(path, data)
    is_item = path and isinstance(path[-1], int) and not rule.description
    return _description(path[:-1], data) if is_item else rule.description


def _joined(*parts: str) -> str:
    return "; ".join(part.rstrip(".") for part in parts if part)


def _problems_of_the_rest(
    error: ValidationError, document: Document, directory: Directory
) -> Iterator[Problem]:
    """Problems across the scene that remain when the refused parts are left out: all appear at once."""
    paths = [_resolved(detail, document.data) for detail in error.errors(include_url=False)]
    rest = _without(paths, document.data) if all(paths) else None
    if rest is None:
        return
    try:
        Scene.model_validate(rest, context=LoadContext(directory, DeclaredNames.of(document.data)))
    except ValidationError as further:
        for detail in further.errors(include_url=False):
            cause = detail.get("ctx", {}).get("error")
            if isinstance(cause, SceneError):
                yield from (placed(problem, document) for problem in cause.problems)


def _without(paths: list[Path], data: Any) -> dict[str, Any] | None:
    """The scene's data less the parts with these paths; None where nothing sensible is left."""
    if not isinstance(data, dict):
        return None
    rest = {key: dict(value) if isinstance(value, dict) else value for key, value in data.items()}
    for path in paths:
        section = str(path[0])
        if section in _NAMED_SECTIONS and len(path) > 1:
            rest[section].pop(path[1], None)
        elif section in _STAND_INS:
            rest[section] = _STAND_INS[section]
        elif section in _OPTIONAL_SECTIONS or section not in Scene.model_fields:
            rest.pop(section, None)
        else:
            return None
    return rest
