"""Keep the record of validation runs, and write what is made of it in README.md and in docs/validation.md, gallery.md
and accuracy.md.

warpsph validate --json > out/validation.jsonl
python tools/validation_tables.py out/validation.jsonl

New lines replace those of the same scene and resolution in docs/validation.jsonl; without a file only the tables are
written anew. Lines of compared options (`--compare`) are no part of the record.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Mapping
from itertools import groupby
from pathlib import Path
from typing import Any

import error_estimates
import gallery
import pages

from warpsph.report.words import number, percent, quantity_in_words

ROOT = Path(__file__).resolve().parents[1]
RECORD, PAGE, README = ROOT / "docs/validation.jsonl", ROOT / "docs/validation.md", ROOT / "README.md"
BEGIN, END = "<!-- validation:begin -->", "<!-- validation:end -->"
COLUMNS = (
    "scene",
    "spacing [m]",
    "particles",
    "quantity",
    "value",
    "reference",
    "error",
    "bound",
    "steps",
    "wall [s]",
)
SUMMARY = ("scene", "spacing [m]", "particles", "errors (bounds)", "wall [s]")

Row = Mapping[str, Any]


def merged(old: Iterable[Row], new: Iterable[Row]) -> list[Row]:
    """The old rows, those of scenes and resolutions that are among the new ones replaced, by scene and spacing."""
    new = [row for row in new if not row.get("options")]
    renewed = {(row["scene"], row["resolution"]) for row in new}
    kept = [row for row in old if (row["scene"], row["resolution"]) not in renewed]
    return sorted([*kept, *new], key=lambda row: (row["scene"], -row["resolution"]))


def table(rows: Iterable[Row]) -> str:
    """A Markdown table of all rows and, below it, where they were computed."""
    rows = list(rows)
    return "\n".join([*pages.table(COLUMNS, map(_cells, rows)), "", _machines(rows)])


def summary(rows: Iterable[Row]) -> str:
    """A Markdown table with a line a scene: its finest resolution, and each quantity that has a bound."""
    rows = list(rows)
    lines = [_summary_cells(list(of_scene)) for _, of_scene in groupby(rows, key=lambda row: row["scene"])]
    return "\n".join([*pages.table(SUMMARY, lines), "", _machines(rows)])


def _machines(rows: Iterable[Row]) -> str:
    found = sorted({f"{r['device']}, {_plural(r['threads'], 'thread')}" for r in rows if r["device"]})
    return f"Computed on: {'; '.join(found)}. **Bold**: the bound does not hold."


def _plural(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"


def _cells(row: Row) -> list[str]:
    error = _error(row["error"], row)
    return [
        f"`{row['scene']}`",
        number(row["resolution"]),
        number(row["particles"], digits=8),
        row["quantity"],
        number(row["value"]),
        number(row["reference"]),
        f"**{error}**" if row["holds"] is False else error,
        _error(row["bound"], row),
        number(row["steps"], digits=8),
        number(row["wall_seconds"], digits=3),
    ]


def _summary_cells(rows: list[Row]) -> list[str]:
    finest = min(row["resolution"] for row in rows)
    of_finest = [row for row in rows if row["resolution"] == finest]
    first = of_finest[0]
    return [
        f"`{first['scene']}`",
        number(finest),
        number(first["particles"], digits=8),
        "; ".join(_verdicts(of_finest)),
        number(first["wall_seconds"], digits=3),
    ]


def _verdicts(rows: Iterable[Row]) -> list[str]:
    """Errors with their bounds, then what stays within its limits and what does not."""
    bounded = [row for row in rows if row["bound"] is not None]
    errors = [_verdict(row) for row in bounded if not row.get("error_unit")]
    limits = [row for row in bounded if row.get("error_unit")]
    kept = ", ".join(quantity_in_words(row["quantity"]) for row in limits if row["holds"])
    broken = ", ".join(quantity_in_words(row["quantity"]) for row in limits if not row["holds"])
    return [
        *errors,
        *([f"within limits: {kept}"] if kept else []),
        *([f"**beyond: {broken}**"] if broken else []),
    ]


def _verdict(row: Row) -> str:
    text = f"{quantity_in_words(row['quantity'])} {_error(row['error'], row)} ({_error(row['bound'], row)})"
    return text if row["holds"] else f"**{text}**"


def _error(error: float | None, row: Row) -> str:
    if error is None:
        return "-"
    unit = row.get("error_unit")
    return f"{number(error, 2)} {unit}" if unit else percent(error)


def main(results: Path | None) -> None:
    """Take the JSON lines of a file into the record, and write every page that is made of it."""
    rows = merged(pages.read_rows(RECORD), pages.read_rows(results) if results else ())
    slim = [{key: value for key, value in row.items() if key not in ("samples", "source")} for row in rows]
    RECORD.write_text("".join(json.dumps(row) + "\n" for row in slim), encoding="utf-8")
    pages.rewrite(PAGE, BEGIN, END, table(rows))
    pages.rewrite(README, BEGIN, END, summary(rows))
    gallery.main(None)
    error_estimates.main()


if __name__ == "__main__":
    if len(sys.argv) > 2:
        sys.exit(__doc__)
    main(Path(sys.argv[1]) if len(sys.argv) == 2 else None)
