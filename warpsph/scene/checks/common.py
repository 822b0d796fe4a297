"""Problems of kinds that several checks find."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from warpsph.scene.errors import Problem
from warpsph.scene.expressions import VectorField, free_variables
from warpsph.scene.types import AXES

_SECTIONS = ("fluids", "boundaries", "structures", "probes", "references", "open_boundaries")


@dataclass(frozen=True)
class DeclaredNames:
    """Names that the scene gives its objects, also those whose object is itself refused."""

    fluids: frozenset[str]
    boundaries: frozenset[str]
    structures: frozenset[str]
    probes: frozenset[str]
    references: frozenset[str]
    open_boundaries: frozenset[str]

    @classmethod
    def of(cls, sections: Mapping[str, Any]) -> DeclaredNames:
        """Names of the sections of a scene, which may be anything but mappings in a wrong file."""

        def names(section: str) -> frozenset[str]:
            value = sections.get(section)
            return frozenset(value) if isinstance(value, Mapping) else frozenset()

        return cls(*map(names, _SECTIONS))


def unknown_name(key: str, kind: str, name: str, known: Iterable[str]) -> Problem:
    """Problem of a value that should name one of the known things."""
    candidates = sorted(known)
    allowed = ", ".join(candidates) or f"nothing: the scene has no {kind}"
    return Problem.at(key, f"there is no {kind} {name!r}{suggestion(name, candidates)}", allowed, name)


def suggestion(word: str, known: Iterable[str]) -> str:
    """'; did you mean ...?' where something known is near, otherwise nothing."""
    near = difflib.get_close_matches(word, list(known), n=1)
    return f"; did you mean {near[0]!r}?" if near else ""


def no_such_axis(key: str, value: Any, dimension: int) -> Problem:
    """Problem of something along z in a scene that has only x and y."""
    return Problem.at(
        key, f"there is no z where dimension is {dimension}", ", ".join(AXES[:dimension]), value
    )


def expression_problems(key: str, expression: str, variables: Sequence[str]) -> Iterator[Problem]:
    """Problem of an expression that uses variables which have no meaning at its place."""
    foreign = sorted(free_variables(expression) - set(variables))
    if foreign:
        message = f"{', '.join(foreign)} has no meaning here"
        yield Problem.at(key, message, f"an expression in {', '.join(variables)}", expression)


def vector_field_problems(
    key: str, field: VectorField | None, dimension: int, variables: Sequence[str] | None = None
) -> Iterator[Problem]:
    """Problems of a vector of numbers or expressions: its length, and variables without meaning."""
    if field is None:
        return
    if len(field) != dimension:
        message = f"{len(field)} components where dimension is {dimension}"
        yield Problem.at(key, message, f"{dimension} components", list(field))
    for index, component in enumerate(field):
        if isinstance(component, str):
            yield from expression_problems(f"{key}.{index}", component, variables or AXES[:dimension])


def repeated_problems(key: str, values: Sequence[str]) -> Iterator[Problem]:
    """Problem of every value that stands in its list a second time."""
    for index, value in enumerate(values):
        if value in values[:index]:
            yield Problem.at(f"{key}.{index}", "it stands there already", "each once", value)


def prefixed(prefix: str, problems: Iterable[Problem]) -> Iterator[Problem]:
    """Problems of a part of the scene, with the key of that part before theirs."""
    for problem in problems:
        yield Problem.at(f"{prefix}.{problem.key}", problem.message, problem.allowed, problem.value)
