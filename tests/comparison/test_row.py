"""A row of the table of errors, as JSON."""

from __future__ import annotations

import json
import math

from warpsph.comparison.row import Comparison, Sample


def row(error: float, bound: float | None = 0.1) -> Comparison:
    sample = Sample(1.0, 2.0, math.nan, error)
    return Comparison(
        "front", "front.position[m]", "max", 2.0, 2.1, error, bound, 0.01, "paper", samples=(sample,)
    )


def test_verdict_follows_error_and_bound() -> None:
    assert [row(0.05).holds, row(0.1).holds, row(0.2).holds] == [True, True, False]
    assert [row(math.nan).holds, row(math.inf).holds, row(math.nan, None).holds] == [False, False, None]


def test_record_is_strict_json_whatever_the_figures() -> None:
    record = json.loads(json.dumps(row(math.nan).as_record(), allow_nan=False))
    assert record["error"] is None
    assert record["holds"] is False
    assert record["samples"] == [{"time": 1.0, "value": 2.0, "reference": None, "error": None}]


def test_unit_lag_and_note_appear_only_where_known() -> None:
    assert not {"error_unit", "lag", "note"} & row(0.05).as_record().keys()
