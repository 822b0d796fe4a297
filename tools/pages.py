"""Tables in Markdown, and the places between two marks of a page where they go."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any


def table(columns: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """Lines of a table."""
    return [_line(columns), _line(["---"] * len(columns)), *(_line(row) for row in rows)]


def between(text: str, begin: str, end: str, block: str, name: str) -> str:
    """The text with what stands between two marks replaced. Raises ValueError if a mark of the page is missing."""
    before, found, rest = text.partition(begin)
    _, closed, after = rest.partition(end)
    if not (found and closed):
        raise ValueError(f"{name} needs the lines {begin} and {end}, in this order")
    return f"{before}{begin}\n{block}\n{end}{after}"


def rewrite(page: Path, begin: str, end: str, block: str) -> None:
    """Replace what stands between two marks of a page. Raises ValueError if a mark is missing."""
    text = page.read_text(encoding="utf-8")
    page.write_text(between(text, begin, end, block, page.name), encoding="utf-8")


def read_rows(path: Path) -> list[dict[str, Any]]:
    """The objects of a file that holds one JSON object a line."""
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines() if line]


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"
