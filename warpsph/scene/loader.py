"""From a scene file, or the name of a shipped scene, to a Scene; or to all that is wrong with it."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import numpy as np

from warpsph.scene.checks.common import suggestion
from warpsph.scene.diagnosis import validated
from warpsph.scene.document import MAX_BYTES, Document, decode, parse, placed
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.library import shipped_scenes
from warpsph.scene.motion import Table
from warpsph.scene.overrides import apply_override, set_value
from warpsph.scene.references import FileProfile, FileTable
from warpsph.scene.schema import Scene
from warpsph.scene.tables import TableError, read_columns


def load_scene(path_or_name: str | Path, overrides: str | Sequence[str] = ()) -> Scene:
    """The scene of a YAML file, or the shipped scene of that name, with one override `key.sub=value` or several.

    Raises SceneError with every problem at once, each with its line, key, value and what is allowed.
    """
    path = _scene_file(path_or_name)
    document = parse(decode(_content(path), str(path)), str(path))
    several = [overrides] if isinstance(overrides, str) else overrides
    return _scene(document, path.absolute().parent, several)


def scene_from_yaml(text: str, base_directory: Path | None = None, overrides: Sequence[str] = ()) -> Scene:
    """The scene of a YAML text; relative file names count from `base_directory`, by default the current one.

    Raises SceneError as `load_scene` does.
    """
    return _scene(parse(text, "<text>"), base_directory or Path.cwd(), overrides)


def _scene(document: Document, base_directory: Path, overrides: Sequence[str]) -> Scene:
    if not isinstance(document.data, dict):
        message = "the file is empty" if document.data is None else "this is no mapping of keys to values"
        allowed = f"the keys {', '.join(Scene.model_fields)}"
        raise SceneError([placed(Problem(message=message, allowed=allowed), document)])
    _apply(overrides, document)
    scene = validated(document, base_directory).read_from(base_directory, document)
    problems = [placed(problem, document) for problem in _table_problems(scene)]
    if problems:
        raise SceneError(problems)
    _try_validation_overrides(scene, document, base_directory)
    return scene


def _apply(overrides: Sequence[str], document: Document) -> None:
    problems: list[Problem] = []
    for override in overrides:
        try:
            apply_override(document, override)
        except SceneError as error:
            problems.extend(error.problems)
    if problems:
        raise SceneError(problems)


def _try_validation_overrides(scene: Scene, document: Document, base_directory: Path) -> None:
    """Refuse overrides of the validation that would fail only when it runs."""
    if scene.validation is None or not scene.validation.set:
        return
    trial = copy.deepcopy(document)
    for key, value in scene.validation.set.items():
        set_value(trial, key.split("."), value, document.place(("validation", "set", key)))
    validated(trial, base_directory)


def _scene_file(path_or_name: str | Path) -> Path:
    """The file of that path, or of the shipped scene of that name."""
    path, shipped = Path(path_or_name), shipped_scenes()
    try:
        exists = path.is_file()
    except OSError as error:
        raise _file_error(str(path), f"this cannot be a file: {error.strerror}", _choices(shipped)) from error
    return shipped.get(str(path_or_name), path) if not exists else path


def _content(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            return file.read(MAX_BYTES + 1)
    except FileNotFoundError as error:
        shipped = shipped_scenes()
        message = f"there is no such file or shipped scene{suggestion(path.stem, shipped)}"
        raise _file_error(str(path), message, _choices(shipped)) from error
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise _file_error(str(path), f"it cannot be read: {reason}", "a readable scene file") from error


def _file_error(file: str, message: str, allowed: str) -> SceneError:
    return SceneError([Problem(file=file, message=message, allowed=allowed)])


def _choices(shipped: Iterable[str]) -> str:
    return f"a scene file, or one of {', '.join(shipped)}"


def _table_problems(scene: Scene) -> Iterator[Problem]:
    """CSV files that the scene names and that do not hold the columns it wants, the time or position first."""
    for key, file, columns in _wanted_columns(scene):
        try:
            first, *_ = read_columns(scene.base_directory / file, columns)
        except TableError as error:
            yield Problem.at(key, str(error), f"a CSV file with the columns {', '.join(columns)}", file)
        else:
            if (np.diff(first) <= 0.0).any():
                message = f"the numbers in column {columns[0]!r} do not increase"
                yield Problem.at(key, message, "increasing times or coordinates", file)


def _wanted_columns(scene: Scene) -> Iterator[tuple[str, str, list[str]]]:
    for name, boundary in scene.boundaries.items():
        for index, motion in enumerate(boundary.motion):
            if isinstance(motion, Table):
                columns = [
                    motion.time,
                    *(motion.translation or {}).values(),
                    *filter(None, [motion.rotation]),
                ]
                yield f"boundaries.{name}.motion.{index}.file", motion.file, columns
    for name, reference in scene.references.items():
        match getattr(reference, "table", None):
            case (
                FileTable(file=file, time=first, value=value)
                | FileProfile(file=file, position=first, value=value)
            ):
                yield f"references.{name}.table.file", file, [first, value]
