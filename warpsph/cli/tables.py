"""Tables of comparisons, as a run and a validation show them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from rich.console import Group
from rich.table import Table
from rich.text import Text

from warpsph.validation.order import observed_order
from warpsph.validation.runner import CaseResult

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


def validation_table(results: Sequence[CaseResult]) -> Group:
    """Error and cost of every quantity at every resolution, with the observed order of convergence."""
    cost = ("wall [s]", "M particle-steps/s")
    table = Table("scene", "spacing [m]", *_FIGURES, *cost, box=None, pad_edge=False)
    for result in results:
        for row in result.rows:
            table.add_row(row["scene"], f"{row['resolution']:g}", *_figures(row), *_cost(row))
    failures = [f"{result.case.directory}: {result.failure}" for result in results if result.failure]
    rows = [row for result in results for row in result.rows]
    return Group(table, *_remarks(rows), *_orders(rows), *failures)


_FIGURES = ("quantity", "value", "reference", "error", "bound", "holds")


def _figures(row: Row) -> tuple[str | Text, ...]:
    return (
        row["quantity"],
        _number(row["value"]),
        _number(row["reference"]),
        _error(row["error"], row),
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


def _remarks(rows: Iterable[Row]) -> list[str]:
    remarks = []
    for row in rows:
        name = (
            f"{row['scene']} at {row['resolution']:g}, {row['quantity']}"
            if "scene" in row
            else row["quantity"]
        )
        if row.get("lag") is not None:
            remarks.append(f"{name}: after a start-up lag of {row['lag']:.4g} s")
        if row.get("note"):
            remarks.append(f"{name}: {row['note']}")
    return remarks


def _orders(rows: Sequence[Row]) -> list[str]:
    """Relative errors over spacing: how fast each falls. A violated limit is no discretisation error."""
    lines = []
    for scene, quantity in dict.fromkeys((row["scene"], row["quantity"]) for row in rows):
        own = [
            r for r in rows if (r["scene"], r["quantity"]) == (scene, quantity) and not r.get("error_unit")
        ]
        errors = [float("nan") if r["error"] is None else r["error"] for r in own]
        order = observed_order([r["resolution"] for r in own], errors)
        if order is not None:
            spread = "" if order.standard_error is None else f" +- {order.standard_error:.2g}"
            lines.append(f"{scene}, {quantity}: observed order {order.order:.2f}{spread}")
    return lines
