"""Values of figures and references that are followed to finer spacings."""

from __future__ import annotations

import numpy as np
import pytest
from compared_scenes import tank_with

from warpsph.comparison.compare import compare_run
from warpsph.comparison.quantities import converging_references, name_of, unit_of_quantity, values_of
from warpsph.scene.references import Figure

TIMES = np.linspace(0.0, 2.0, 21)
HISTORY = {"time[s]": TIMES, "energy.kinetic[J/m]": TIMES**2, "front.position[m]": 1.0 + TIMES}
SCENE = tank_with(
    front={
        "type": "series",
        "column": "front.position[m]",
        "table": {"time": [0.5, 1.0], "value": [1.0, 1.0]},
    },
    peak={"type": "feature", "column": "energy.kinetic[J/m]", "feature": "maximum"},
    kept={"type": "limit", "column": "energy.kinetic[J/m]", "high": 1.0},
    pressure={"type": "field", "set": "water", "field": "pressure", "expression": "1 + y"},
    mean_pressure={
        "type": "field",
        "set": "water",
        "field": "pressure",
        "expression": "1 + y",
        "norm": "rms",
    },
    profile={
        "type": "profile",
        "field": "velocity_x",
        "through": [0.5, 0.5],
        "axis": "x",
        "table": {"position": [0.2, 0.4], "value": [1.0, 1.0]},
    },
)
ROWS = {row.quantity: row.as_record() for row in compare_run(SCENE, HISTORY)}


def test_a_series_has_its_values_at_all_times_of_comparison() -> None:
    assert values_of("front", SCENE, HISTORY, ROWS) == pytest.approx([1.5, 2.0])


def test_a_feature_has_one_value_whether_a_reference_or_not() -> None:
    figure = Figure(column="energy.kinetic[J/m]", feature="maximum")
    assert values_of("peak", SCENE, HISTORY, ROWS) == pytest.approx([4.0])
    assert values_of(figure, SCENE, HISTORY, ROWS) == pytest.approx([4.0])


def test_a_profile_has_its_values_at_all_points() -> None:
    points = [[0.2, 3.0, 1.0], [0.4, 5.0, 1.0]]
    rows = {"profile": {"samples": [{"value": 5.0, "points": points}]}}
    assert values_of("profile", SCENE, HISTORY, rows) == pytest.approx([3.0, 5.0])


def test_a_run_that_did_not_come_so_far_has_no_values() -> None:
    short = {name: column[:3] for name, column in HISTORY.items()}
    rows = {row.quantity: row.as_record() for row in compare_run(SCENE, short)}
    for quantity in ("front", "peak", "mean_pressure", "profile"):
        assert np.isnan(values_of(quantity, SCENE, short, rows)).all(), quantity


def test_limits_and_largest_errors_of_fields_converge_to_nothing() -> None:
    assert list(converging_references(SCENE)) == ["front", "peak", "mean_pressure", "profile"]


def test_units_and_names() -> None:
    figure = Figure(column="energy.kinetic[J/m]", feature="maximum_time")
    assert [unit_of_quantity(q, SCENE) for q in ("front", "peak", "mean_pressure", "profile", figure)] == [
        "m", "J/m", "Pa", "m/s", "s",
    ]  # fmt: skip
    assert name_of(figure) == "maximum_time of energy.kinetic[J/m]"
