"""One plain sentence a scene: how good its numbers are, for how much time, and what better ones would cost."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from warpsph.report.words import machine, percent, quantity_in_words, quoted_error, wall_time
from warpsph.validation.convergence import is_change
from warpsph.validation.halving import halving_cost
from warpsph.validation.options import options_in_words
from warpsph.validation.study import Study, studies_of

Row = Mapping[str, Any]

LARGEST_FACTOR = 1000.0
"""Beyond this a factor of cost says no more than that it is out of reach."""


def sentence_of(rows: Sequence[Row]) -> str:
    """The sentence of one scene from all its rows.

    It speaks of the finest resolution and of the bounded quantity with the largest error there; where options are
    compared, of the choice with which that error is smallest. What breaks a bound is always named, and so is what has
    no bound and a larger error.
    """
    choices = _by_options(rows)
    best = min(choices, key=_rank)
    preamble = f"with {options_in_words(best[0]['options'])}: " if len(choices) > 1 else ""
    finest, worst = _finest(best), worst_study(best)
    clauses = [_achieved(finest, worst, best), *_price(worst), *_larger(finest, worst), *_broken(finest)]
    text = preamble + "; ".join(clauses)
    return f"{text[0].upper()}{text[1:]}."


def worst_study(rows: Sequence[Row]) -> Study | None:
    """The study with the largest quoted error at the finest resolution, of the bounded quantities if there are any.

    None if no quantity has an error there.
    """
    known = _compared(rows)
    bounded = [study for study in known if study.quantity in _bounded(_finest(rows))]
    return max(bounded or known, key=_error, default=None)


def _compared(rows: Sequence[Row]) -> list[Study]:
    """The studies that reach down to the finest resolution."""
    finest = min(row["resolution"] for row in rows)
    return [s for s in studies_of(rows) if s.finest.resolution == finest and s.finest.quoted is not None]


def _bounded(finest: Sequence[Row]) -> set[str]:
    return {row["quantity"] for row in finest if row["bound"] is not None}


def _error(study: Study) -> float:
    return study.finest.quoted or 0.0


def _by_options(rows: Sequence[Row]) -> list[list[Row]]:
    groups: dict[str, list[Row]] = {}
    for row in rows:
        groups.setdefault(options_in_words(row.get("options")), []).append(row)
    return list(groups.values())


def _finest(rows: Sequence[Row]) -> list[Row]:
    finest = min(row["resolution"] for row in rows)
    return [row for row in rows if row["resolution"] == finest]


def _rank(rows: Sequence[Row]) -> tuple[float, float]:
    """Largest error and cost at the finest resolution; what has none comes last."""
    worst = worst_study(rows)
    if worst is None:
        return math.inf, math.inf
    return _error(worst), worst.finest.wall_seconds or math.inf


def _achieved(finest: Sequence[Row], worst: Study | None, rows: Sequence[Row]) -> str:
    seconds = finest[0]["wall_seconds"]
    if seconds is None:
        return f"the run at spacing {finest[0]['resolution']:g} m did not come to its end"
    price = f"for {wall_time(seconds)} on {machine(finest[0]['device'], finest[0]['threads'])}"
    if worst is None:
        return f"{_without_errors(finest)} {price}"
    closer = sum(_error(study) <= _error(worst) for study in _compared(rows)) - 1
    return f"{_within(worst, finest)}{_others(closer)} {price}"


def _within(study: Study, finest: Sequence[Row]) -> str:
    """Only a bound that holds, or a reference that knows no better, makes an error something to be within."""
    name, error = quantity_in_words(study.quantity), percent(_error(study))
    if study.finest.at_uncertainty:
        return f"{name} within {error}, as close as the reference is known,"
    holds = next(row["holds"] for row in finest if row["quantity"] == study.quantity)
    return f"{name} {'within' if holds else 'off by'} {error}"


def _others(count: int) -> str:
    match count:
        case 0:
            return ""
        case 1:
            return " and one more quantity closer,"
        case _:
            return f" and {count} more quantities closer,"


def _without_errors(finest: Sequence[Row]) -> str:
    """What there is to say where nothing has an error against a reference."""
    changes = [row for row in finest if is_change(row) and row["error"] is not None]
    if changes:
        worst = max(changes, key=lambda row: row["error"])
        return f"{quantity_in_words(worst['quantity'])} changed by {percent(worst['error'])} in the last refinement"
    kept = [row["holds"] for row in finest if row.get("error_unit")]
    match len(kept):
        case 0:
            return "no figure that could be compared"
        case 1:
            return "the one limit kept" if kept[0] else "the one limit broken"
        case count:
            return f"all {count} limits kept" if all(kept) else f"{sum(kept)} of {count} limits kept"


def _price(worst: Study | None) -> Iterator[str]:
    """What halving the error takes, or why that is not known."""
    if worst is None or worst.finest.at_uncertainty or not worst.finest.quoted:
        return
    if len(worst.points) < 2:
        yield "one resolution does not show what halving the error takes"
        return
    cost = halving_cost(worst)
    if cost is None:
        yield "the error does not clearly fall with the resolution"
    else:
        yield f"halving the error takes {_times(cost.factor)} times the work{_range(cost.range)}"


def _times(factor: float) -> str:
    """Two significant digits without an exponent."""
    if factor > LARGEST_FACTOR:
        return f"more than {LARGEST_FACTOR:.0f}"
    return f"{float(f'{factor:.2g}'):g}"


def _range(factors: tuple[float, float] | None) -> str:
    ends = [] if factors is None else [_times(factor) for factor in factors]
    return f" ({ends[0]} to {ends[1]})" if len(set(ends)) > 1 else ""


def _larger(finest: Sequence[Row], worst: Study | None) -> Iterator[str]:
    """Errors of quantities without a bound that exceed the one that the sentence speaks of."""
    if worst is None:
        return
    larger = [s for s in studies_of(finest) if s.finest.quoted is not None and _error(s) > _error(worst)]
    if larger:
        named = ", ".join(f"{quantity_in_words(s.quantity)} {percent(_error(s))}" for s in larger)
        yield f"without a bound: {named}"


def _broken(finest: Sequence[Row]) -> Iterator[str]:
    failing = [row for row in finest if row["holds"] is False]
    broken = [_excess(row) for row in failing if row["error"] is not None]
    missing = [quantity_in_words(row["quantity"]) for row in failing if row["error"] is None]
    if broken:
        yield f"beyond its bound: {', '.join(broken)}"
    if missing:
        yield f"without a value: {', '.join(missing)}"


def _excess(row: Row) -> str:
    name, error = quantity_in_words(row["quantity"]), quoted_error(row)
    return (
        f"{name} by {error}" if row.get("error_unit") else f"{name} ({error}, bound {percent(row['bound'])})"
    )
