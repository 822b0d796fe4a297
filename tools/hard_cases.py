"""Keep the record of hard cases, and write the table of docs/hard_cases.md from it.

warpsph validate --hard --json > out/hard_cases.jsonl
python tools/hard_cases.py out/hard_cases.jsonl

New lines replace those of the same case in docs/hard_cases.jsonl; without a file only the table is written anew.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping, Sequence
from itertools import groupby
from json import dumps
from pathlib import Path
from typing import Any

import pages

from warpsph.report.hard import bound_in_words, value_in_words
from warpsph.report.words import machine, number, quantity_in_words

ROOT = Path(__file__).resolve().parents[1]
RECORD, PAGE = ROOT / "docs/hard_cases.jsonl", ROOT / "docs/hard_cases.md"
BEGIN, END = "<!-- hard-cases:begin -->", "<!-- hard-cases:end -->"
COLUMNS = ("case", "figure", "value", "bound", "holds", "seconds")

Row = Mapping[str, Any]


def merged(old: Iterable[Row], new: Iterable[Row], order: Sequence[str]) -> list[Row]:
    """The old rows, those of cases that are among the new ones replaced, in the order of the cases.

    Rows of cases that there are no longer are left out.
    """
    new = list(new)
    renewed = {row["case"] for row in new}
    every = [*(row for row in old if row["case"] not in renewed), *new]
    return sorted((row for row in every if row["case"] in order), key=lambda row: order.index(row["case"]))


def block(rows: Sequence[Row]) -> str:
    """How many cases hold, the table of all figures, and what each case does."""
    cases = {name: list(own) for name, own in groupby(rows, key=lambda row: row["case"])}
    failing = [name for name, own in cases.items() if not all(row["holds"] for row in own)]
    seconds = sum(own[0]["seconds"] for own in cases.values())
    machines = sorted({f"{row['device']}, {machine(row['device'], row['threads'])}" for row in rows})
    told = f"{len(cases) - len(failing)} of {len(cases)} cases keep their bounds"
    names = f"; these do not: {', '.join(map(quantity_in_words, failing))}" if failing else ""
    return "\n".join(
        [
            f"{told}{names}. Computed on {'; '.join(machines)}, in {number(seconds, 3)} s.",
            "",
            *pages.table(COLUMNS, map(_cells, rows)),
            "",
            *(f"- **{quantity_in_words(name)}**: {own[0]['about']}" for name, own in cases.items()),
        ]
    )


def _cells(row: Row) -> list[str]:
    return [
        quantity_in_words(row["case"]),
        row["failure"] or row["figure"],
        value_in_words(row),
        bound_in_words(row),
        "yes" if row["holds"] else "**NO**",
        number(row["seconds"], 2),
    ]


def main(results: Path | None) -> None:
    """Take the JSON lines of a file into the record, and write the table."""
    from warpsph.validation.hard.suite import HARD_CASES

    order = [case.name for case in HARD_CASES]
    rows = merged(pages.read_rows(RECORD), pages.read_rows(results) if results else (), order)
    RECORD.write_text("".join(dumps(row) + "\n" for row in rows), encoding="utf-8")
    pages.rewrite(PAGE, BEGIN, END, block(rows))


if __name__ == "__main__":
    if len(sys.argv) > 2:
        sys.exit(__doc__)
    main(Path(sys.argv[1]) if len(sys.argv) == 2 else None)
