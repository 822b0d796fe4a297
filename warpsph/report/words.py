"""Figures as a person reads them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from warpsph.validation.order import ObservedOrder


def quantity_in_words(name: str) -> str:
    """The name of a reference or of an entry of the ledger as words."""
    return name.replace("_", " ")


def number(value: float | None, digits: int = 4) -> str:
    """A number with so many significant digits, a dash for none."""
    return "-" if value is None else f"{value:.{digits}g}"


def percent(error: float, digits: int = 2) -> str:
    """A relative error in percent, from 100 % on without decimals."""
    scaled = 100.0 * error
    return f"{scaled:.{digits}g} %" if scaled < 99.5 else f"{scaled:.0f} %"


def claimed_error(row: Mapping[str, Any]) -> tuple[str, float | None]:
    """What may be claimed of the error of a row: the error itself, or "<= " and its reference's uncertainty, if that is
    larger: nothing closer than that is known."""
    error, uncertainty = row["error"], row.get("uncertainty") or 0.0
    return ("<= ", uncertainty) if error is not None and error < uncertainty else ("", error)


def quoted_error(row: Mapping[str, Any]) -> str:
    """The error that may be claimed of a row of a validation, with its unit."""
    sign, error = claimed_error(row)
    unit = row.get("error_unit")
    if error is None:
        return "-"
    return sign + (f"{number(error, 2)} {unit}" if unit else percent(error))


def wall_time(seconds: float) -> str:
    """A duration in the unit that suits it."""
    if seconds < 99.5:
        return f"{seconds:.2g} s"
    minutes = seconds / 60.0
    return f"{minutes:.2g} min" if minutes < 99.5 else f"{minutes / 60.0:.2g} h"


def order_in_words(order: ObservedOrder) -> str:
    """An observed order with its standard error, where it has one."""
    spread = "" if order.standard_error is None else f" ± {order.standard_error:.2f}"
    return f"{order.order:.2f}{spread}"


def machine(device: str | None, threads: int | None) -> str:
    """Where a run was computed: threads of a CPU, or the name of the device."""
    if device is not None and device != "cpu":
        return device
    return "one thread" if threads == 1 else f"{number(threads)} threads"
