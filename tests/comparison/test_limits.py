"""Limit references: the violation is the error, zero its bound."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from compared_scenes import tank_with

from warpsph.comparison.compare import Comparison, compare_run

COLUMN = "energy.kinetic[J/m]"
TIMES = np.linspace(0.0, 2.0, 21)


def limited(values: np.ndarray, times: np.ndarray = TIMES, **limits: Any) -> Comparison:
    scene = tank_with(energy={"type": "limit", "column": COLUMN, **limits})
    (row,) = compare_run(scene, {"time[s]": times, COLUMN: values})
    return row


def test_within_the_limits_the_violation_is_zero() -> None:
    row = limited(np.sin(TIMES), low=-1.0, high=1.0)
    assert (row.error, row.bound, row.holds) == (0.0, 0.0, True)
    assert row.error_unit == "J/m"


def test_violation_is_the_distance_beyond_the_broken_limit() -> None:
    row = limited(TIMES, low=0.5, high=1.8)
    assert (row.value, row.reference) == pytest.approx((0.0, 0.5))
    assert row.error == pytest.approx(0.5)
    assert row.holds is False


def test_only_the_window_counts() -> None:
    assert limited(np.exp(-5.0 * TIMES), window=[1.0, 2.0], high=0.01).holds is True
    assert limited(np.exp(-5.0 * TIMES), high=0.01).holds is False


def test_run_that_ended_before_the_window_does_not_hold() -> None:
    row = limited(np.zeros(11), TIMES[:11], high=1.0)
    assert row.holds is False
    assert row.note == "the run ended before t = 2 s"


def test_value_that_is_no_number_does_not_hold() -> None:
    values = np.zeros_like(TIMES)
    values[7] = np.nan
    row = limited(values, high=1.0)
    assert math.isnan(row.error)
    assert row.holds is False
