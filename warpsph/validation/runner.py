"""Run scenes over their resolutions and collect the comparisons with their references."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from pathlib import Path
from typing import Any
from urllib.parse import quote

from warpsph.scene import load_scene, shipped_scenes
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.references import bound_at
from warpsph.scene.schema import Scene, Validation
from warpsph.validation.options import ComparedOption, as_mapping, combinations, problems_of, unique
from warpsph.validation.windows import beyond_the_end

RunScene = Callable[[Scene, Path], Mapping[str, Any]]
"""Runs a scene into a directory and returns its summary."""

RUN_FACTS = ("wall_seconds", "steps", "particles", "particle_steps_per_second", "device", "threads")
"""What every row repeats of its run: what the figure cost, and on what."""


@dataclass(frozen=True)
class Case:
    """A scene at one resolution, ready to run; `options` are the compared values in it, as `key=value`.

    `skipped` are the references that have been taken out of it since they look at times [s] beyond its end.
    """

    scene: Scene
    options: tuple[str, ...] = ()
    skipped: Mapping[str, float] = field(default_factory=dict)

    @property
    def directory(self) -> Path:
        """Where the case runs, relative to the directory of the whole validation."""
        parts = (quote(",".join(self.options), safe="=,"), f"{self.scene.spacing:g}")
        return Path(self.scene.name, *filter(None, parts))

    @property
    def series(self) -> tuple[str, tuple[str, ...]]:
        """What all resolutions of the same scene with the same options share."""
        return self.scene.name, self.options


@dataclass(frozen=True)
class CaseResult:
    """The rows of a case, one a reference, and the summary of its run; `failure` says why it did not reach its end."""

    case: Case
    rows: tuple[Mapping[str, Any], ...]
    failure: str | None = None
    summary: Mapping[str, Any] | None = None

    @property
    def holds(self) -> bool:
        """Whether the run came to its end within every bound."""
        return self.failure is None and all(row["holds"] is not False for row in self.rows)


def cases_of(
    scene: str,
    *,
    quick: bool,
    resolutions: Sequence[float] | None,
    overrides: Sequence[str],
    compared: Sequence[ComparedOption] = (),
) -> tuple[Case, ...]:
    """A scene at the spacings [m] asked for, else at those that its `validation` names, coarse ones first.

    Every combination of the compared options runs at all of them. These beat overrides, which beat those of
    `validation.quick_set`, which hold for `quick` and beat those of `validation.set`. Where they end the run earlier,
    references that look beyond are skipped. Frames are not kept as USD unless an override says so. Raises SceneError
    with the problems of all cases that cannot run, or if the scene has nothing to compare with.
    """
    base = load_scene(scene, overrides)
    if not base.references:
        allowed = "a scene with references, which `warpsph scenes` counts"
        raise SceneError(
            [Problem.at("references", f"the scene {base.name} has nothing to compare with", allowed)]
        )
    validation = base.validation or Validation(resolutions=(base.spacing,))
    own = _as_overrides({**validation.set, **(validation.quick_set if quick else {})})
    whole = load_scene(scene, [*_as_overrides(validation.set), *overrides]).time.end
    spacings = sorted(set(resolutions or _spacings(base, quick=quick)), reverse=True)
    cases: list[Case] = []
    problems: list[Problem] = []
    for options, spacing in product(combinations(compared), spacings):
        every = ["output.usd=false", *own, *overrides, *options, f"spacing={spacing!r}"]
        try:
            cases.append(_without_what_lies_beyond(Case(load_scene(scene, every), options), whole))
        except SceneError as error:
            problems.extend(problems_of(error, options))
    if problems:
        raise SceneError(unique(problems))
    return tuple(cases)


def scenes_with_references() -> tuple[str, ...]:
    """Names of the shipped scenes that can be validated."""
    return tuple(name for name, path in shipped_scenes().items() if load_scene(path).references)


def run_case(case: Case, directory: Path, run_scene: RunScene) -> CaseResult:
    """Run a case below `directory`; a run that diverges gives rows without values, and none of them holds."""
    from warpsph.solver.errors import SimulationDiverged

    try:
        summary = run_scene(case.scene, directory / case.directory)
    except SimulationDiverged as error:
        return CaseResult(
            case, tuple(_row_of_failed_run(case, name) for name in case.scene.references), str(error)
        )
    facts = _facts(summary)
    rows = [_row(case, comparison, facts) for comparison in summary["references"]]
    rows += [_row_of_skipped(case, name, time, facts) for name, time in case.skipped.items()]
    return CaseResult(case, tuple(rows), summary=summary)


def _as_overrides(values: Mapping[str, Any]) -> list[str]:
    return [f"{key}={json.dumps(value)}" for key, value in values.items()]


def _without_what_lies_beyond(case: Case, whole: float) -> Case:
    """The case without the references that it cannot serve because it ends before the whole run would [s]."""
    skipped = beyond_the_end(case.scene, whole) if case.scene.time.end < whole else {}
    kept = {name: one for name, one in case.scene.references.items() if name not in skipped}
    return replace(case, scene=case.scene.model_copy(update={"references": kept}), skipped=skipped)


def _spacings(scene: Scene, *, quick: bool) -> Sequence[float]:
    validation = scene.validation or Validation(resolutions=(scene.spacing,))
    if not quick:
        return validation.resolutions
    return validation.quick or (max(validation.resolutions),)


def _facts(summary: Mapping[str, Any]) -> dict[str, Any]:
    same = {key: summary[key] for key in ("particles", "particle_steps_per_second", "device", "threads")}
    return {"wall_seconds": summary["wall_s"], "steps": summary["steps"]["count"], **same}


def _row(case: Case, comparison: Mapping[str, Any], facts: Mapping[str, Any]) -> dict[str, Any]:
    options = {"options": as_mapping(case.options)} if case.options else {}
    return {"scene": case.scene.name, "resolution": case.scene.spacing, **options, **comparison, **facts}


def _row_of_skipped(case: Case, quantity: str, time: float, facts: Mapping[str, Any]) -> dict[str, Any]:
    nothing = dict.fromkeys(("value", "reference", "error", "bound", "holds"))
    note = f"skipped: it looks at the run until t = {time:.6g} s, and this one ends at {case.scene.time.end:.6g} s"
    return _row(case, {"quantity": quantity, **nothing, "note": note}, facts)


def _row_of_failed_run(case: Case, quantity: str) -> dict[str, Any]:
    bound = bound_at(getattr(case.scene.references[quantity], "bound", 0.0), case.scene.spacing)
    nothing = dict.fromkeys(("value", "reference", "error"))
    comparison = {"quantity": quantity, **nothing, "bound": bound, "holds": None if bound is None else False}
    return _row(case, comparison, dict.fromkeys(RUN_FACTS))
