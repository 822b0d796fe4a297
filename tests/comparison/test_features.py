"""Feature references: figures of histories whose features are known in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from compared_scenes import tank_with

from warpsph.comparison.compare import Comparison, compare_run
from warpsph.scene import SceneError

COLUMN = "energy.kinetic[J/m]"
TIMES = np.linspace(0.0, 2.0, 401)


def row_of(values: np.ndarray, **reference: Any) -> Comparison:
    scene = tank_with(figure={"type": "feature", "column": COLUMN, **reference})
    (row,) = compare_run(scene, {"time[s]": TIMES, COLUMN: values})
    return row


def test_decay_rate_of_an_exponential() -> None:
    row = row_of(3.0 * np.exp(-1.5 * TIMES), feature="decay_rate", value=1.5, bound=1e-9)
    assert row.holds is True
    assert row_of(3.0 * np.exp(-1.5 * TIMES), feature="decay_rate", value=1.4, bound=0.01).holds is False


def test_decay_rate_of_what_reaches_zero_is_no_number() -> None:
    row = row_of(1.0 - TIMES, feature="decay_rate", value=1.0, bound=10.0)
    assert row.holds is False
    assert row.note == "the column shows no decay_rate"


def test_period_of_a_damped_and_noisy_oscillation() -> None:
    """Zero crossings of exp(-t/10) cos(omega t) are exactly a period apart; the mean is not quite zero."""
    noise = 0.02 * np.random.default_rng(0).standard_normal(TIMES.size)
    wave = 5.0 + np.exp(-0.1 * TIMES) * np.cos(2.0 * np.pi * TIMES / 0.4) + noise
    # A crossing is known to noise / slope = 0.02 / (2 pi / 0.4) s; the mean over four periods divides it by four.
    assert row_of(wave, feature="period", value=0.4).value == pytest.approx(
        0.4, abs=4.0 * 0.02 * 0.4 / 2 / np.pi
    )


def test_one_passage_is_no_period() -> None:
    assert row_of(TIMES, feature="period", value=1.0, bound=0.1).holds is False


def test_arrival_is_interpolated() -> None:
    row = row_of(np.maximum(TIMES - 0.5, 0.0), feature="arrival", threshold=0.2501, value=0.7501, bound=1e-9)
    assert row.holds is True


def test_what_never_arrives_does_not_hold() -> None:
    assert row_of(TIMES, feature="arrival", threshold=3.0, value=1.0, bound=10.0).holds is False


def test_first_peak_is_not_the_largest() -> None:
    """Two bumps with a dip below half of the first between them."""
    bumps = 2.0 * np.exp(-(((TIMES - 0.5) / 0.1) ** 2)) + 5.0 * np.exp(-(((TIMES - 1.5) / 0.1) ** 2))
    assert row_of(bumps, feature="first_peak", threshold=0.5, value=2.0).value == pytest.approx(2.0, rel=1e-9)
    assert row_of(bumps, feature="first_peak_time", threshold=0.5, value=0.5).value == pytest.approx(0.5)
    assert row_of(bumps, feature="maximum", value=5.0).value == pytest.approx(5.0, rel=1e-9)


def test_integral_and_mean_over_the_window() -> None:
    assert row_of(2.0 * TIMES, feature="integral", window=[1.0, 2.0], value=3.0).value == pytest.approx(3.0)
    assert row_of(2.0 * TIMES, feature="mean", window=[1.0, 2.0], value=3.0).value == pytest.approx(3.0)


def test_change_is_between_the_ends_of_the_window() -> None:
    assert row_of(TIMES**2, feature="change", window=[1.0, 2.0], value=3.0).value == pytest.approx(3.0)


def test_deviation_of_a_swing_is_its_amplitude_over_the_root_of_two() -> None:
    """Over whole periods, up to the end point that is there twice."""
    swing = 5.0 + 0.1 * np.sin(2.0 * np.pi * TIMES)
    row = row_of(swing, feature="deviation", value=0.0, relative_to=5.0, bound=0.02)
    assert row.value == pytest.approx(0.1 / np.sqrt(2.0), rel=0.01)
    assert row.error == pytest.approx(0.02 / np.sqrt(2.0), rel=0.01)
    assert row.holds is True


def test_average_removes_what_is_shorter_than_it() -> None:
    """A spike of one sample, 1000 high and 5 ms wide at its foot's middle, over a slow ramp: mean 1000 * 5 / 100."""
    spike = TIMES + np.where(np.arange(TIMES.size) == 200, 1000.0, 0.0)
    row = row_of(spike, feature="maximum", average=0.1, value=50.0)
    # the ramp adds one second at the spike, up to half the average's length to either side
    assert row.value == pytest.approx(50.0 + 1.0, abs=0.06)
    assert row_of(TIMES, feature="maximum", average=0.1, value=2.0).value == pytest.approx(2.0, abs=0.03)


def test_without_a_value_the_figure_is_reported() -> None:
    row = row_of(TIMES, feature="integral", convergence=0.1)
    assert (row.value, row.holds, row.note) == (pytest.approx(2.0), None, "in J/m s")


@pytest.mark.parametrize(
    ("reference", "key"),
    [
        ({"feature": "arrival", "value": 1.0}, "threshold"),
        ({"feature": "mean", "value": 1.0, "threshold": 2.0}, "threshold"),
        ({"feature": "mean", "bound": 0.1}, "bound"),
        ({"feature": "mean", "value": 1.0, "convergence": 0.1}, "convergence"),
        ({"feature": "mean", "value": 0.0}, "value"),
        ({"feature": "mean", "value": 1.0, "window": [1.0, 0.5]}, "window"),
    ],
)
def test_features_that_mean_nothing_are_refused(reference: dict[str, Any], key: str) -> None:
    with pytest.raises(SceneError, match=rf"references\.figure\.{key}"):
        row_of(TIMES, **reference)


def test_times_of_extremes_lie_between_the_samples() -> None:
    """A parabola through samples of a parabola has its vertex; the samples are 0.005 s apart."""
    vertex = 0.7321
    hill = 4.0 - 3.0 * (TIMES - vertex) ** 2
    assert row_of(hill, feature="maximum_time", value=vertex, bound=1e-9).holds is True
    assert row_of(-hill, feature="minimum_time", value=vertex, bound=1e-9).holds is True
    assert row_of(-hill, feature="minimum_time", window=[0.0, 0.5]).value == 0.5


def test_a_bound_may_fall_with_the_spacing() -> None:
    """The tank has a spacing of 0.1 m: the bound of the finest spacing that is no finer counts."""
    values = np.full(TIMES.size, 1.02)
    levels = [[0.2, 0.05], [0.1, 0.03], [0.05, 0.01]]
    assert row_of(values, feature="maximum", value=1.0, bound=levels).bound == 0.03
    assert row_of(values, feature="maximum", value=1.0, bound=[[0.15, 0.04], [0.05, 0.01]]).bound == 0.04
    assert row_of(values, feature="maximum", value=1.0, bound=[[0.05, 0.01]]).holds is None


def test_the_extreme_of_an_angle_is_found_beyond_a_turn() -> None:
    """4 sin(t pi / 2) rad passes pi, where atan2 goes on from -pi; its maximum is at 1 s."""
    angle = 4.0 * np.sin(0.5 * np.pi * TIMES)
    wrapped = (angle + np.pi) % (2.0 * np.pi) - np.pi
    unrolled = row_of(wrapped, feature="maximum_time", value=1.0, bound=1e-6, unroll=2.0 * np.pi)
    assert unrolled.holds is True
    assert row_of(wrapped, feature="maximum_time", value=1.0, bound=1e-6).holds is False


SWING = 3.0 + 2.0 * np.sin(2.0 * np.pi * TIMES / 0.25) * np.where(TIMES < 1.1, 3.0, 1.0)
"""Eight periods of 0.25 s; the first five and a half swing three times as far."""


def test_frequency_is_one_over_the_period() -> None:
    """The mean of a swing that becomes smaller is not quite its centre: passages shift by 1e-3 of a period."""
    assert row_of(SWING, feature="frequency", value=4.0).value == pytest.approx(4.0, rel=2e-3)


def test_last_periods_leave_out_what_was_before() -> None:
    """Within two samples' worth: the curve is known at every fiftieth of a period."""
    recent = {"periods": 2, "value": 1.0}
    assert row_of(SWING, feature="amplitude", **recent).value == pytest.approx(2.0, rel=0.01)
    assert row_of(SWING, feature="centre", **recent).value == pytest.approx(3.0, rel=0.01)
    assert row_of(SWING, feature="mean", **recent).value == pytest.approx(3.0, rel=0.01)
    assert row_of(SWING, feature="frequency", **recent).value == pytest.approx(4.0, rel=0.01)
    assert row_of(SWING, feature="amplitude", value=1.0).value == pytest.approx(6.0, rel=0.01)


def test_more_periods_than_there_are_is_no_number() -> None:
    row = row_of(SWING, feature="amplitude", periods=9, value=2.0, bound=1.0)
    assert row.holds is False
    assert row.note == "the column shows no amplitude"


def test_scatter_of_the_periods_stands_beside_the_frequency() -> None:
    """Periods of 0.3 and 0.2 s in turn, four of them: standard deviation 0.0577 s, over sqrt(4) and the mean of 0.25 s.

    The longer periods shift the mean, and so the passages, by some samples.
    """
    phase = np.interp(TIMES, np.cumsum([0.0, 0.3, 0.2, 0.3, 0.2, 0.3, 0.2]), np.arange(7.0))
    note = row_of(np.sin(2.0 * np.pi * phase), feature="frequency", value=4.0).note
    assert note is not None
    error, what = note.removeprefix("standard error ").split("%, ")
    assert float(error) == pytest.approx(11.5, rel=0.05)
    assert what == "from the scatter of 4 periods"


def test_strouhal_number_is_that_of_the_probe() -> None:
    scene = tank_with(figure={"type": "feature", "column": "body.lift[1]", "feature": "strouhal"})
    (row,) = compare_run(scene, {"time[s]": TIMES, "body.lift[1]": SWING})
    assert row.value == pytest.approx(4.0 * 0.5 / 2.0, rel=2e-3)


def test_strouhal_number_of_another_probe_is_refused() -> None:
    with pytest.raises(SceneError, match="Strouhal"):
        row_of(TIMES, feature="strouhal", value=1.0)
