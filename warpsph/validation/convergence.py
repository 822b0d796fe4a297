"""Figures without an exact value: judged by how much they still change with the resolution."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from warpsph.scene.references import FeatureReference
from warpsph.validation.runner import Case, CaseResult

NOTE = "the reference is the next coarser resolution"


def is_change(row: Mapping[str, Any]) -> bool:
    """Whether the error of a row is a change with the resolution, and not one against a reference."""
    return row.get("note") == NOTE


def judged(result: CaseResult, earlier: Sequence[CaseResult], cases: Sequence[Case]) -> CaseResult:
    """The result of the finest case of a scene, with its figures held against those of the next coarser case with the
    same options.

    Only references that ask for `convergence` change: the coarser figure becomes their reference. Results of other
    cases come back as they are.
    """
    finest = [case for case in cases if case.series == result.case.series][-1] == result.case
    coarser = [other for other in earlier if other.case.series == result.case.series]
    if not finest or not coarser:
        return result
    values = {row["quantity"]: row["value"] for row in coarser[-1].rows}
    return replace(result, rows=tuple(_row(result.case, row, values[row["quantity"]]) for row in result.rows))


def _row(case: Case, row: Mapping[str, Any], coarser: float | None) -> Mapping[str, Any]:
    reference = case.scene.references.get(row["quantity"])
    if not isinstance(reference, FeatureReference) or reference.convergence is None:
        return row
    error = None if not coarser or row["value"] is None else abs(row["value"] / coarser - 1.0)
    holds = error is not None and error <= reference.convergence
    verdict = {"reference": coarser, "error": error, "bound": reference.convergence, "holds": holds}
    return {**row, **verdict, "note": NOTE}
