"""Write the validation table of README.md from the lines of `warpsph validate --json`.

warpsph validate --json > out/validation.jsonl
python tools/update_readme.py out/validation.jsonl
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

README = Path(__file__).resolve().parents[1] / "README.md"
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
    "wall [s]",
)

Row = Mapping[str, Any]


def table(rows: Iterable[Row]) -> str:
    """A Markdown table of the rows and, below it, where they were computed."""
    rows = list(rows)
    machines = sorted({f"{r['device']}, {r['threads']} threads" for r in rows if r["device"]})
    lines = [_line(COLUMNS), _line(["---"] * len(COLUMNS)), *(_line(_cells(row)) for row in rows)]
    return "\n".join([*lines, "", f"Computed on: {'; '.join(machines)}. **Bold**: the bound does not hold."])


def replace_block(text: str, block: str) -> str:
    """The text with what stands between the two marks replaced. Raises ValueError if a mark is missing."""
    before, begin, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not (begin and end):
        raise ValueError(f"{README.name} needs the lines {BEGIN} and {END}, in this order")
    return f"{before}{BEGIN}\n{block}\n{END}{after}"


def _cells(row: Row) -> list[str]:
    error = _error(row["error"], row)
    return [
        f"`{row['scene']}`",
        _number(row["resolution"]),
        _number(row["particles"], digits=8),
        row["quantity"],
        _number(row["value"]),
        _number(row["reference"]),
        f"**{error}**" if row["holds"] is False else error,
        _error(row["bound"], row),
        _number(row["wall_seconds"], digits=3),
    ]


def _number(value: float | None, digits: int = 4) -> str:
    return "-" if value is None else f"{value:.{digits}g}"


def _error(error: float | None, row: Row) -> str:
    if error is None:
        return "-"
    unit = row.get("error_unit")
    return f"{error:.2g} {unit}" if unit else f"{100.0 * error:.2g} %"


def _line(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def main(results: str) -> None:
    """Read the JSON lines of a file and rewrite the README."""
    rows = [json.loads(line) for line in Path(results).read_text(encoding="utf-8").splitlines() if line]
    README.write_text(replace_block(README.read_text(encoding="utf-8"), table(rows)), encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
