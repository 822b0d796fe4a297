"""Hard cases in words and on a page."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

from warpsph.output.atomic import write_atomically
from warpsph.output.run_directory import make_directory
from warpsph.output.summary import write_summary
from warpsph.report.html import document, table, verdict
from warpsph.report.words import number, quantity_in_words
from warpsph.validation.hard.case import HardResult

RECORD, PAGE = "hard.json", "hard.html"
Record = Mapping[str, Any]

_COLUMNS = ("case", "figure", "value", "bound", "holds", "seconds")


def value_in_words(record: Record) -> str:
    """A figure with its unit, a dash for none."""
    return _with_unit(record["value"], record)


def bound_in_words(record: Record) -> str:
    """The bound of a figure, and on which side of it the figure has to be."""
    if record["bound"] is None:
        return "-"
    side = "at least" if record["at_least"] else "at most"
    return f"{side} {_with_unit(record['bound'], record)}"


def _with_unit(value: float | None, record: Record) -> str:
    unit = record["unit"]
    return f"{number(value)} {unit}" if value is not None and unit != "1" else number(value)


def write_hard(results: Sequence[HardResult], directory: Path, *, with_page: bool) -> Iterator[Path]:
    """Write hard.json and, if asked for, hard.html; yield the path of each. Raises OutputError."""
    make_directory(directory)
    records = [record for result in results for record in result.as_records()]
    write_summary(directory / RECORD, {"figures": records})
    yield directory / RECORD
    if with_page:
        write_atomically(directory / PAGE, hard_page(results).encode())
        yield directory / PAGE


def hard_page(results: Sequence[HardResult]) -> str:
    """The page: how many cases hold, each figure with its bound, and what each case does."""
    held = sum(result.holds for result in results)
    machines = dict.fromkeys(f"{r['device']}, threads: {r['threads']}" for r in _records(results))
    seconds = sum(result.seconds for result in results)
    return document(
        "Hard cases",
        "\n".join(
            [
                "<h1>Hard cases</h1>",
                f"<p class='sentence'>{held} of {len(results)} cases keep their bounds.</p>",
                f"<p class='quiet'>Computed on {escape('; '.join(machines))} in {number(seconds, 3)} s.</p>",
                table(_COLUMNS, map(_cells, _records(results))),
                *(_section(result) for result in results),
            ]
        ),
    )


def _records(results: Sequence[HardResult]) -> Iterator[Record]:
    for result in results:
        yield from result.as_records()


def _cells(record: Record) -> list[str]:
    return [
        escape(quantity_in_words(record["case"])),
        escape(record["failure"] or record["figure"]),
        escape(value_in_words(record)),
        escape(bound_in_words(record)),
        verdict(record["holds"]),
        number(record["seconds"], 3),
    ]


def _section(result: HardResult) -> str:
    name = escape(quantity_in_words(result.case.name))
    return f"<h3>{name} {verdict(result.holds)}</h3>\n<p>{escape(result.case.about)}</p>"
