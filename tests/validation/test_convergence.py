"""Figures without an exact value are judged by their change between the two finest resolutions."""

from __future__ import annotations

from pathlib import Path

from warpsph.scene import scene_from_yaml
from warpsph.validation.convergence import judged
from warpsph.validation.runner import Case, CaseResult

SCENE = """
name: splash
dimension: 2
spacing: %g
gravity: [0.0, -9.81]
time: {end: 1.0, frame_rate: 10}
fluids: {water: {shape: {type: box, min: [0, 0], max: [1, 1]}, density: 1000}}
probes: {energy: {type: energy}}
references:
  impulse:
    {type: feature, column: "energy.kinetic[J/m]", feature: integral, convergence: 0.1, source: convergence}
"""


def result(spacing: float, value: float | None, *options: str) -> CaseResult:
    row = {
        "quantity": "impulse",
        "value": value,
        "reference": None,
        "error": None,
        "bound": None,
        "holds": None,
    }
    return CaseResult(Case(scene_from_yaml(SCENE % spacing, Path()), options), (row,))


def verdicts(*values: float | None) -> list[bool | None]:
    results = [result(0.1 / 2**k, value) for k, value in enumerate(values)]
    cases = [r.case for r in results]
    return [judged(r, results[:k], cases).rows[0]["holds"] for k, r in enumerate(results)]


def test_only_the_finest_is_judged_against_the_next_coarser() -> None:
    assert verdicts(5.0, 10.0, 10.9) == [None, None, True]
    assert verdicts(11.0, 10.0, 11.1) == [None, None, False]


def test_one_resolution_shows_no_convergence() -> None:
    assert verdicts(10.0) == [None]


def test_a_figure_that_is_missing_does_not_hold() -> None:
    assert verdicts(10.0, None) == [None, False]
    assert verdicts(None, 10.0) == [None, False]


def test_each_choice_of_options_is_judged_by_itself() -> None:
    results = [
        result(0.2, 10.0, "kernel=a"),
        result(0.1, 10.5, "kernel=a"),
        result(0.2, 20.0, "kernel=b"),
        result(0.1, 30.0, "kernel=b"),
    ]
    cases = [r.case for r in results]
    judgements = [judged(r, results[:k], cases).rows[0]["holds"] for k, r in enumerate(results)]
    assert judgements == [None, True, None, False]
