"""Values of scene options that a validation runs side by side."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

from warpsph.scene.errors import Problem, SceneError

_EXAMPLE = "as in numerics.kernel=wendland_c2,cubic_spline"
_OPENING, _CLOSING = "[{", "]}"
_QUOTED = re.compile(r"\"[^\"]*\"|'[^']*'|.", re.DOTALL)


@dataclass(frozen=True)
class ComparedOption:
    """A key of the scene and the values to run it with, as texts of YAML."""

    key: str
    values: tuple[str, ...]

    @property
    def overrides(self) -> tuple[str, ...]:
        """One `key=value` for each value."""
        return tuple(f"{self.key}={value}" for value in self.values)


def compared_options(texts: Iterable[str]) -> tuple[ComparedOption, ...]:
    """The options of texts such as `numerics.kernel=wendland_c2,cubic_spline`. Raises ValueError."""
    options = tuple(_option(text) for text in texts)
    keys = [option.key for option in options]
    repeated = next((key for key in keys if keys.count(key) > 1), None)
    if repeated:
        raise ValueError(f"{repeated} is compared twice: give all its values at once, {_EXAMPLE}")
    return options


def _option(text: str) -> ComparedOption:
    key, _, values = text.partition("=")
    option = ComparedOption(key.strip(), tuple(split_values(values)))
    distinct = set(option.values)
    if not option.key or "" in distinct or not 2 <= len(distinct) == len(option.values):
        raise ValueError(f"{text}: give a key and at least two different values, {_EXAMPLE}")
    if option.key == "spacing":
        raise ValueError(f"{text}: spacings are chosen by --resolutions, for every value of the options")
    return option


def split_values(text: str) -> Iterator[str]:
    """Parts between commas that stand in no brackets, braces or quotes, without the blanks around them."""
    depth, part = 0, ""
    for token in _QUOTED.findall(text):
        depth += (token in _OPENING) - (token in _CLOSING)
        if token == "," and depth == 0:
            yield part.strip()
            part = ""
        else:
            part += token
    yield part.strip()


def combinations(options: Sequence[ComparedOption]) -> tuple[tuple[str, ...], ...]:
    """Every combination of values as overrides, the last option running fastest; one empty one of no options."""
    return tuple(product(*(option.overrides for option in options)))


def as_mapping(overrides: Iterable[str]) -> dict[str, str]:
    """Values by key of such a combination."""
    return {key: value for key, _, value in (override.partition("=") for override in overrides)}


def options_in_words(options: Mapping[str, str] | None) -> str:
    """Compared options as `key=value, key=value`, of keys only the last part where that tells them apart."""
    known = options or {}
    short = [key.rpartition(".")[2] for key in known]
    names = short if len(set(short)) == len(short) else list(known)
    return ", ".join(f"{name}={value}" for name, value in zip(names, known.values(), strict=True))


def without_effect(rows: Iterable[Mapping[str, Any]]) -> tuple[str, ...]:
    """Compared keys of which no value changes any figure in the rows of one scene: it has no use for them.

    Figures that are missing, or that only one value has so far, tell nothing.
    """
    figures: dict[str, dict[tuple[Any, ...], dict[str, float]]] = {}
    for row in rows:
        options = row.get("options") or {}
        for key in options:
            others = tuple(item for item in options.items() if item[0] != key)
            found = figures.setdefault(key, {}).setdefault((row["resolution"], row["quantity"], others), {})
            if row["value"] is not None:
                found[options[key]] = row["value"]
    return tuple(key for key, groups in figures.items() if _all_same(groups.values()))


def _all_same(groups: Iterable[Mapping[str, float]]) -> bool:
    compared = [set(group.values()) for group in groups if len(group) > 1]
    return bool(compared) and all(len(values) == 1 for values in compared)


def problems_of(error: SceneError, overrides: Sequence[str]) -> Iterator[Problem]:
    """The problems of an error, those of compared values under the name of the option that brought them."""
    places = {f"--set {override}": f"--compare {override}" for override in overrides}
    for problem in error.problems:
        yield replace(problem, file=places.get(problem.file or "", problem.file))


def unique(items: Iterable[Any]) -> list[Any]:
    """The items in their order, each once; they need not be hashable."""
    found: list[Any] = []
    for item in items:
        if item not in found:
            found.append(item)
    return found
