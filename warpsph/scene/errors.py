"""What is wrong with a scene: every problem with its place and with what would be allowed."""

from __future__ import annotations

import reprlib
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, ClassVar


class _Nothing:
    """Type of the value of a problem that lies in what is not there."""


@dataclass(frozen=True)
class Problem:
    """One thing wrong with a scene.

    `file` is the scene file, or the override that carries the value; `line` counts from 1 and is None where
    there is no file (scene built from Python); `key` is the dotted path of the value, such as
    boundaries.tank.shape.max.
    """

    NOTHING: ClassVar[_Nothing] = _Nothing()

    file: str | None = None
    line: int | None = None
    key: str = ""
    value: Any = NOTHING
    message: str = ""
    allowed: str = ""

    @classmethod
    def at(cls, key: str, message: str, allowed: str, value: Any = NOTHING) -> Problem:
        """Problem of a scene object whose place in a file is not known (yet)."""
        return cls(key=key, value=value, message=message, allowed=allowed)

    @property
    def has_value(self) -> bool:
        """False where the trouble is that nothing stands there."""
        return self.value is not Problem.NOTHING

    def __str__(self) -> str:
        place = self.file or ""
        if self.line is not None:
            place = f"{place}, line {self.line}" if place else f"line {self.line}"
        head = ": ".join(part for part in (place, self.key, self.message) if part)
        rows = [head]
        if self.has_value:
            rows.append(f"    value:   {_short(self.value)}")
        if self.allowed:
            rows.append(f"    allowed: {self.allowed}")
        return "\n".join(rows)


class SceneError(ValueError):
    """A scene that cannot be run; `problems` lists everything that is wrong with it, in file order."""

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__(self._text())

    def _text(self) -> str:
        if len(self.problems) == 1:
            return str(self.problems[0])
        return "\n".join([f"{len(self.problems)} problems in the scene:", *map(str, self.problems)])


def _short(value: Any) -> str:
    """The value as one line a person can read, cut where it is long."""
    shortener = reprlib.Repr()
    shortener.maxlist = shortener.maxtuple = shortener.maxdict = 8
    shortener.maxstring = shortener.maxother = shortener.maxlong = 80
    return shortener.repr(value)
