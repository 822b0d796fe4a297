"""Tables of comparisons, as a run and a validation show them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from rich.console import Group
from rich.table import Table
from rich.text import Text

from warpsph.report.words import claimed_error
from warpsph.validation.options import options_in_words, without_effect
from warpsph.validation.runner import CaseResult
from warpsph.validation.study import studies_of

Row = Mapping[str, Any]

VERDICTS = {True: Text("yes", "green"), False: Text("NO", "bold red"), None: Text("-")}


def comparison_table(rows: Iterable[Row]) -> Group:
    """Each reference of one run: value, reference, error, bound, verdict, and what else there is to say."""
    rows = list(rows)
    table = Table(
        *_FIGURES, title="comparison with the references", title_justify="left", box=None, pad_edge=False
    )
    for row in rows:
        table.add_row(*_figures(row))
    return Group(table, *_remarks(rows))


def estimate_table(records: Iterable[Row]) -> Table:
    """The discretisation error of each quantity of one run, with its uncertainty and the order behind it."""
    columns = ("quantity", "value", "error", "at most", "order")
    title = "discretisation error, estimated"
    table = Table(*columns, title=title, title_justify="left", box=None, pad_edge=False)
    for record in records:
        table.add_row(
            record["quantity"],
            _number(record["value"]),
            _error(record["relative_error"], record),
            _error(record["relative_uncertainty"], record),
            record.get("note") or _order(record),
        )
    return table


def _order(record: Row) -> str:
    if record["order"] is None:
        return f"none: {record['behaviour']}"
    return f"{record['order']:.2f} {record['order_is']}"


def validation_table(results: Sequence[CaseResult]) -> Group:
    """Error and cost of every quantity at every resolution, with the observed order of convergence."""
    rows = [row for result in results for row in result.rows]
    compared = ("options",) if any(row.get("options") for row in rows) else ()
    cost = ("wall [s]", "M particle-steps/s")
    table = Table("scene", *compared, "spacing [m]", *_FIGURES, *cost, box=None, pad_edge=False)
    for row in rows:
        options = [options_in_words(row.get("options"))] if compared else []
        table.add_row(row["scene"], *options, f"{row['resolution']:g}", *_figures(row), *_cost(row))
    failures = [f"{result.case.directory}: {result.failure}" for result in results if result.failure]
    return Group(table, *_remarks(rows), *_idle(rows), *_orders(rows), *failures)


_FIGURES = ("quantity", "value", "reference", "error", "bound", "holds")


def _figures(row: Row) -> tuple[str | Text, ...]:
    return (
        row["quantity"],
        _number(row["value"]),
        _number(row["reference"]),
        _quoted(row),
        _error(row["bound"], row),
        VERDICTS[row["holds"]],
    )


def _cost(row: Row) -> tuple[str, str]:
    pace = row["particle_steps_per_second"]
    return _number(row["wall_seconds"], digits=3), _number(None if pace is None else pace / 1e6, digits=3)


def _number(value: float | None, digits: int = 5) -> str:
    return "-" if value is None else f"{value:.{digits}g}"


def _error(error: float | None, row: Row) -> str:
    if error is None:
        return "-"
    unit = row.get("error_unit")
    return f"{error:.3g} {unit}" if unit else f"{100.0 * error:.3g} %"


def _quoted(row: Row) -> str:
    sign, error = claimed_error(row)
    return sign + _error(error, row)


def _remarks(rows: Iterable[Row]) -> list[str]:
    remarks = []
    for row in rows:
        name = f"{_run(row)}, {row['quantity']}" if "scene" in row else row["quantity"]
        if row.get("lag") is not None:
            remarks.append(f"{name}: after a start-up lag of {row['lag']:.4g} s")
        if row.get("note"):
            remarks.append(f"{name}: {row['note']}")
    return remarks


def _idle(rows: Sequence[Row]) -> list[str]:
    """Compared options that a scene has no use for."""
    return [
        f"{scene}: {key} makes no difference"
        for scene in dict.fromkeys(row["scene"] for row in rows)
        for key in without_effect(row for row in rows if row["scene"] == scene)
    ]


def _run(row: Row) -> str:
    options = f" with {options_in_words(row['options'])}" if row.get("options") else ""
    return f"{row['scene']} at {row['resolution']:g}{options}"


def _orders(rows: Sequence[Row]) -> list[str]:
    """How fast each error falls with the spacing."""
    lines = []
    for study in studies_of(rows):
        if study.order is not None:
            label = f" with {study.label}" if study.label else ""
            spread = study.order.standard_error
            error = "" if spread is None else f" +- {spread:.2g}"
            lines.append(
                f"{study.scene}{label}, {study.quantity}: observed order {study.order.order:.2f}{error}"
            )
    return lines
