"""Spacings proposed from pilots with manufactured errors and costs."""

from __future__ import annotations

import json

import numpy as np
import pytest

from warpsph.validation.plan import Pilot, pilot_spacings, plan_from

LIMIT = 10.0


def pilots(p: float = 2.0, slope: float = 40.0, count: int = 3) -> list[Pilot]:
    """f = 10 + slope h^p in three dimensions: particles ~ h^-3, steps ~ h^-1."""
    return [pilot_at(h, LIMIT + slope * h**p) for h in pilot_spacings(0.1)[3 - count :]]


def pilot_at(h: float, value: float) -> Pilot:
    return Pilot(h, np.array([value]), 5.0, round(h**-3), round(100 / h), 800.0, "cpu, 2 threads")


def test_spacing_is_the_coarsest_whose_uncertainty_meets_the_target() -> None:
    """1.25 * 40 h^2 <= 0.01 * f(finest) asks for h <= 0.0450: 0.2 / 5 is the first of 0.2 / k below."""
    plan = plan_from(pilots(), within=0.01)
    assert plan.proposal is not None
    assert plan.proposal.spacing == pytest.approx(0.2 / 5)
    scale = LIMIT + 40.0 * 0.05**2
    assert plan.proposal.error == pytest.approx(40.0 * 0.04**2 / scale, rel=1e-5)
    assert plan.proposal.uncertainty == pytest.approx(1.25 * plan.proposal.error)
    assert plan.proposal.uncertainty <= 0.01
    one_step_coarser = 1.25 * 40.0 * (0.2 / 4) ** 2 / scale
    assert one_step_coarser > 0.01


def test_cost_follows_the_power_laws_of_the_pilots() -> None:
    proposal = plan_from(pilots(), within=0.01).proposal
    assert proposal is not None
    assert proposal.particles == pytest.approx(0.04**-3, rel=1e-3)
    assert proposal.steps == pytest.approx(100 / 0.04, rel=1e-3)
    assert proposal.wall_seconds == pytest.approx(5.0 * (0.05 / 0.04) ** 4, rel=1e-3)
    assert proposal.memory_bytes == pytest.approx(800.0 * proposal.particles)


def test_errors_of_pilots_are_those_against_the_limit() -> None:
    plan = plan_from(pilots(), within=0.01)
    errors = [plan.error_of(pilot) for pilot in plan.pilots]
    assert errors == pytest.approx([40.0 * p.spacing**2 / plan.scale for p in plan.pilots], rel=1e-5)


def test_the_coarsest_pilot_may_do() -> None:
    proposal = plan_from(pilots(), within=0.5).proposal
    assert proposal is not None
    assert proposal.spacing == pytest.approx(0.1)


def test_relative_to_a_given_scale() -> None:
    """1.25 * 40 h^2 <= 0.01 * 2.5 asks for h <= 0.02236: 0.2 / 9."""
    plan = plan_from(pilots(), within=0.01, scale=2.5)
    assert plan.proposal is not None
    assert plan.proposal.spacing == pytest.approx(0.2 / 9)


def test_a_far_spacing_is_called_a_guess() -> None:
    plan = plan_from(pilots(p=1.0), within=0.001)
    assert plan.proposal is not None
    assert plan.advice is not None
    assert "a guess" in plan.advice


def test_two_pilots_say_that_the_order_is_assumed() -> None:
    plan = plan_from(pilots(p=1.0, slope=10.0, count=2), within=0.1)
    assert plan.proposal is not None
    assert plan.advice is not None
    assert "assumed" in plan.advice


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ((1.0, 1.2, 1.1), "up and down"),
        ((1.0, 1.1, 1.3), "changes more"),
        ((1.0, 1.1, 1.18), "with the order"),
    ],
)
def test_pilots_that_do_not_converge_give_advice_and_no_spacing(values: tuple[float, ...], says: str) -> None:
    plan = plan_from([pilot_at(h, v) for h, v in zip((0.4, 0.28, 0.2), values, strict=True)], within=0.05)
    assert plan.proposal is None
    assert plan.advice is not None
    assert says in plan.advice
    assert "accuracy.pilots: [0.2, 0.14, 0.1]" in plan.advice


def test_scatter_far_below_the_target_is_good_enough() -> None:
    """Range 0.2 % of the figure, with a factor of safety of 3 within 5 %: the finest pilot, called by its name."""
    plan = plan_from(
        [pilot_at(h, v) for h, v in zip((0.4, 0.28, 0.2), (1.0, 1.002, 1.001), strict=True)], within=0.05
    )
    assert plan.proposal is not None
    assert plan.proposal.spacing == 0.2
    assert plan.advice is not None
    assert "oscillating" in plan.advice


def test_nothing_is_relative_to_a_figure_of_zero() -> None:
    plan = plan_from([pilot_at(h, v) for h, v in ((0.2, 1.0), (0.1, 0.0))], within=0.05)
    assert plan.proposal is None
    assert plan.advice is not None
    assert "relative_to" in plan.advice


def test_equal_pilots_need_nothing_finer() -> None:
    plan = plan_from([pilot_at(h, 1.0) for h in pilot_spacings(0.1)], within=0.01)
    assert plan.proposal is not None
    assert (plan.proposal.spacing, plan.proposal.uncertainty) == (0.1, 0.0)


def test_record_is_strict_json() -> None:
    record = plan_from(pilots(), within=0.01).as_record()
    again = json.loads(json.dumps(record, allow_nan=False))
    assert again["proposal"]["spacing"] == pytest.approx(0.04)
    assert [pilot["value"] for pilot in again["pilots"]][-1] == pytest.approx(10.1)
