"""One plain sentence a scene: how good its numbers are, for how much time, and what better ones would cost."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from warpsph.report.words import machine, percent, quantity_in_words, quoted_error, wall_time
from warpsph.validation.halving import halving_cost
from warpsph.validation.study import Study, options_in_words, studies_of

Row = Mapping[str, Any]

LARGEST_FACTOR = 1000.0
"""Beyond this a factor of cost says no more than that it is out of reach."""


def sentence_of(rows: Sequence[Row]) -> str:
    """The sentence of one scene from all its rows.

    It speaks of the finest resolution and of the quantity with the largest error there; where options are compared, of
    the choice with which that error is smallest. What breaks a bound is always named.
    """
    choices = _by_options(rows)
    best = min(choices, key=lambda own: _rank(studies_of(own)))
    preamble = f"with {options_in_words(best[0]['options'])}: " if len(choices) > 1 else ""
    text = "; ".join([preamble + _achieved(best), *_price(best), *_broken(_finest(best))])
    return f"{text[0].upper()}{text[1:]}."


def worst_study(studies: Sequence[Study]) -> Study | None:
    """The study with the largest quoted error at its finest resolution; None where none has an error there."""
    known = [study for study in studies if study.finest.quoted is not None]
    return max(known, key=lambda study: study.finest.quoted or 0.0, default=None)


def _by_options(rows: Sequence[Row]) -> list[list[Row]]:
    groups: dict[str, list[Row]] = {}
    for row in rows:
        groups.setdefault(options_in_words(row.get("options")), []).append(row)
    return list(groups.values())


def _finest(rows: Sequence[Row]) -> list[Row]:
    finest = min(row["resolution"] for row in rows)
    return [row for row in rows if row["resolution"] == finest]


def _rank(studies: Sequence[Study]) -> tuple[float, float]:
    """Largest error and cost at the finest resolution; runs without an error come last."""
    worst = worst_study(studies)
    if worst is None or any(study.finest.wall_seconds is None for study in studies):
        return math.inf, math.inf
    return worst.finest.quoted or 0.0, worst.finest.wall_seconds or 0.0


def _achieved(rows: Sequence[Row]) -> str:
    finest = _finest(rows)
    cost = finest[0]["wall_seconds"]
    if cost is None:
        return f"the run at spacing {finest[0]['resolution']:g} m did not come to its end"
    price = f"for {wall_time(cost)} on {machine(finest[0]['device'], finest[0]['threads'])}"
    studies = studies_of(rows)
    worst = worst_study(studies)
    if worst is None:
        return f"{_limits(finest)} {price}"
    return f"{_within(worst)}{_others(len(studies) - 1)} {price}"


def _within(study: Study) -> str:
    text = f"{quantity_in_words(study.quantity)} within {percent(study.finest.quoted or 0.0)}"
    return f"{text}, as close as the reference is known," if study.finest.at_uncertainty else text


def _others(count: int) -> str:
    match count:
        case 0:
            return ""
        case 1:
            return " and the other quantity closer,"
        case _:
            return f" and the other {count} quantities closer,"


def _limits(rows: Sequence[Row]) -> str:
    verdicts = [row["holds"] for row in rows if row.get("error_unit")]
    if not verdicts:
        return "no figure that could be compared"
    return f"{sum(verdicts)} of {len(verdicts)} limits kept"


def _price(rows: Sequence[Row]) -> Iterator[str]:
    """What halving the error costs, or why that is not known."""
    worst = worst_study(studies_of(rows))
    if worst is None or worst.finest.at_uncertainty or not worst.finest.quoted:
        return
    if len(worst.points) < 2:
        yield "one resolution does not show what halving the error costs"
        return
    cost = halving_cost(worst)
    if cost is None:
        yield "the error does not clearly fall with the resolution"
    elif cost.factor > LARGEST_FACTOR:
        yield f"halving the error costs more than {LARGEST_FACTOR:.0f} times"
    else:
        yield f"halving the error costs {_times(cost.factor)} times{_range(cost.range)}"


def _times(factor: float) -> str:
    if factor > LARGEST_FACTOR:
        return f"more than {LARGEST_FACTOR:.0f}"
    return f"{factor:.2g}" if factor < 99.5 else f"{factor:.0f}"


def _range(factors: tuple[float, float] | None) -> str:
    ends = [] if factors is None else [_times(factor) for factor in factors]
    return f" ({ends[0]} to {ends[1]})" if len(set(ends)) > 1 else ""


def _broken(rows: Sequence[Row]) -> Iterator[str]:
    failing = [row for row in rows if row["holds"] is False]
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
