"""`warpsph validate --hard`: what is meant to break the scheme, and how it fares."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from warpsph.cli.failures import BadInput, ExitCode

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from warpsph.validation.hard.case import HardCase, HardResult, Machine


def validate_hard(
    names: Sequence[str], machine: Machine, out: Path, progress: Console, *, json_lines: bool, with_page: bool
) -> ExitCode:
    """Run hard cases, all of them by default, and show each figure with its bound; exit code 1 if one does not hold.

    All figures also go to hard.json in the directory, with a page to hard.html.
    """
    from warpsph.cli.consoles import plain_console
    from warpsph.cli.kept import require_directory
    from warpsph.report.hard import write_hard
    from warpsph.validation.hard.case import run_hard_case

    cases = chosen_cases(names)
    require_directory(out)
    results: list[HardResult] = []
    try:
        for number, case in enumerate(cases, start=1):
            progress.print(f"{number}/{len(cases)} {case.name}")
            results.append(run_hard_case(case, machine))
            if json_lines:
                for record in results[-1].as_records():
                    print(json.dumps(record, allow_nan=False), flush=True)
    finally:
        if results and not json_lines:
            plain_console().print(hard_table(results))
        if results:
            for path in write_hard(results, out, with_page=with_page):
                progress.print(f"report {path}", soft_wrap=True)
    return ExitCode.OK if all(result.holds for result in results) else ExitCode.FAILED


def chosen_cases(names: Sequence[str]) -> tuple[HardCase, ...]:
    """The cases of these names, in their own order, or all. Raises BadInput for a name that there is not."""
    from warpsph.validation.hard.suite import HARD_CASES

    known = {case.name for case in HARD_CASES}
    if unknown := sorted(set(names) - known):
        raise BadInput(f"--hard {unknown[0]}: no such hard case; there are {', '.join(sorted(known))}")
    return tuple(case for case in HARD_CASES if not names or case.name in names)


def hard_table(results: Sequence[HardResult]) -> Table:
    """A line for each figure, with the seconds of its case."""
    from rich.table import Table

    from warpsph.cli.tables import VERDICTS
    from warpsph.report.hard import bound_in_words, value_in_words
    from warpsph.report.words import number, quantity_in_words

    table = Table("case", "figure", "value", "bound", "holds", "seconds", box=None, pad_edge=False)
    for result in results:
        for k, record in enumerate(result.as_records()):
            first = (quantity_in_words(result.case.name), number(result.seconds, 3)) if k == 0 else ("", "")
            figure = record["failure"] or record["figure"]
            cells = value_in_words(record), bound_in_words(record), VERDICTS[record["holds"]]
            table.add_row(first[0], figure, *cells, first[1])
    return table
