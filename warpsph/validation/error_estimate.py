"""The discretisation error of a run's own figures, from runs of the same scene at other spacings."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from warpsph.comparison.quantities import converging_references, name_of, unit_of_quantity
from warpsph.comparison.row import finite_or_none
from warpsph.scene.accuracy import Quantity
from warpsph.scene.schema import Scene
from warpsph.validation.pilots import FinishedRun
from warpsph.validation.plan import Plan, plain_figure
from warpsph.validation.richardson import Extrapolation, extrapolate, root_mean_square

COARSER = 2.0
"""Spacing of the one other run over that of the run itself: bodies keep whole numbers of particles."""


def error_estimates(run: FinishedRun, others: Sequence[FinishedRun]) -> list[dict[str, Any]]:
    """One record for each reference that can converge, and for the quantity of `accuracy`.

    Errors and uncertainties are in the unit of the quantity, root mean squares where it has several values; the
    relative ones are over the root mean square of the run's values. One other run leaves the order to be assumed.
    """
    return [_record(quantity, run, others) for quantity in _quantities(run.scene)]


def outcome(
    plan: Plan, quantity: Quantity, run: FinishedRun, others: Sequence[FinishedRun]
) -> dict[str, Any]:
    """Whether a run has the accuracy that it was planned for, by what it shows itself beside its pilots.

    `error` and `uncertainty` are relative to the scale of the plan; all is None where a run has no value.
    """
    found = _record(quantity, run, others)
    if found["error"] is None:
        return dict.fromkeys(("error", "uncertainty", "met"))
    uncertainty = found["uncertainty"] / plan.scale
    return {
        "error": found["error"] / plan.scale,
        "uncertainty": uncertainty,
        "met": uncertainty <= plan.within,
    }


def _quantities(scene: Scene) -> Iterator[Quantity]:
    yield from converging_references(scene)
    if scene.accuracy is not None and not isinstance(scene.accuracy.quantity, str):
        yield scene.accuracy.quantity


def _record(quantity: Quantity, run: FinishedRun, others: Sequence[FinishedRun]) -> dict[str, Any]:
    runs = sorted((run, *others), key=lambda one: -one.scene.spacing)
    figures = [one.values_of(quantity) for one in runs]
    own = run.values_of(quantity)
    about = {
        "quantity": name_of(quantity),
        "unit": unit_of_quantity(quantity, run.scene),
        "spacings": [one.scene.spacing for one in runs[-3:]],
        "value": finite_or_none(float(own[0])) if len(own) == 1 else finite_or_none(root_mean_square(own)),
    }
    if not all(len(figure) == len(own) and np.isfinite(figure).all() for figure in figures):
        nothing = dict.fromkeys(("order", "error", "uncertainty", "relative_error", "relative_uncertainty"))
        return about | nothing | {"note": "a run has no value of it"}
    found = extrapolate([one.scene.spacing for one in runs], figures)
    return about | _estimate(found, own)


def _estimate(found: Extrapolation, own: np.ndarray) -> dict[str, Any]:
    from_limit = found.error_of(own)
    error = found.error if from_limit is None else from_limit
    scale = root_mean_square(own)
    return {
        "order": found.order,
        "order_is": "observed" if found.relies_on_observation else "assumed" if found.order else None,
        "observed_order": found.observed,
        "extrapolated_value": None if found.limit is None else plain_figure(found.limit),
        "error": error,
        "uncertainty": error * found.safety,
        "relative_error": error / scale if scale else None,
        "relative_uncertainty": error * found.safety / scale if scale else None,
        "behaviour": found.behaviour,
    }
