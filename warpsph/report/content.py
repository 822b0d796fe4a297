"""What a report says of each scene, and the same as plain values for JSON."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from warpsph.report.sentence import sentence_of
from warpsph.scene.schema import Scene
from warpsph.validation.halving import halving_cost
from warpsph.validation.options import as_mapping, without_effect
from warpsph.validation.runner import CaseResult
from warpsph.validation.study import Study, on_front, studies_of

Row = Mapping[str, Any]
RUN_KEYS = (
    "device",
    "threads",
    "versions",
    "particles",
    "wall_s",
    "particle_steps_per_second",
    "ledger",
    "warnings",
)


@dataclass(frozen=True)
class SceneReport:
    """All runs of one scene, each choice of options from coarse to fine."""

    results: tuple[CaseResult, ...]

    @property
    def scene(self) -> Scene:
        """The scene as its last case runs it."""
        return self.results[-1].case.scene

    @property
    def rows(self) -> tuple[Row, ...]:
        """The rows of all runs."""
        return tuple(row for result in self.results for row in result.rows)

    @cached_property
    def studies(self) -> Mapping[str, tuple[Study, ...]]:
        """The studies of each quantity, one for each choice of options."""
        found: dict[str, tuple[Study, ...]] = {}
        for study in studies_of(self.rows):
            found[study.quantity] = (*found.get(study.quantity, ()), study)
        return found

    @cached_property
    def sentence(self) -> str:
        """How good the numbers are and what they cost."""
        return sentence_of(self.rows)

    @property
    def compares_options(self) -> bool:
        """Whether the runs differ in more than their resolution."""
        return any(result.case.options for result in self.results)

    def as_record(self) -> dict[str, Any]:
        """The report for JSON."""
        return {
            "scene": self.scene.name,
            "description": self.scene.description,
            "sentence": self.sentence,
            "options_without_effect": without_effect(self.rows),
            "holds": all(result.holds for result in self.results),
            "studies": [record for studies in self.studies.values() for record in _study_records(studies)],
            "runs": [_run_record(result) for result in self.results],
            "comparisons": list(self.rows),
        }


def scene_reports(results: Iterable[CaseResult]) -> tuple[SceneReport, ...]:
    """The reports of all scenes, in the order of their first runs."""
    groups: dict[str, list[CaseResult]] = {}
    for result in results:
        groups.setdefault(result.case.scene.name, []).append(result)
    return tuple(SceneReport(tuple(own)) for own in groups.values())


def _study_records(studies: Sequence[Study]) -> list[dict[str, Any]]:
    wall, steps = on_front(studies, "wall_seconds"), on_front(studies, "particle_steps")
    return [_study_record(*own) for own in zip(studies, wall, steps, strict=True)]


def _study_record(
    study: Study, on_wall_front: Sequence[bool], on_step_front: Sequence[bool]
) -> dict[str, Any]:
    order, halving = study.order, halving_cost(study)
    points = zip(study.points, on_wall_front, on_step_front, strict=True)
    return {
        "quantity": study.quantity,
        "options": dict(study.options),
        "observed_order": None if order is None else order.order,
        "standard_error": None if order is None else order.standard_error,
        "halving_cost": None if halving is None else halving.factor,
        "halving_cost_range": None if halving is None else halving.range,
        "points": [
            {
                "resolution": point.resolution,
                "error": point.quoted,
                "at_uncertainty": point.at_uncertainty,
                "wall_seconds": point.wall_seconds,
                "particle_steps": point.particle_steps,
                "on_wall_front": wall,
                "on_step_front": steps,
            }
            for point, wall, steps in points
        ],
    }


def _run_record(result: CaseResult) -> dict[str, Any]:
    summary = result.summary or {}
    return {
        "options": as_mapping(result.case.options),
        "resolution": result.case.scene.spacing,
        "directory": str(result.case.directory),
        "failure": result.failure,
        "steps": (summary.get("steps") or {}).get("count"),
        **{key: summary.get(key) for key in RUN_KEYS},
    }
