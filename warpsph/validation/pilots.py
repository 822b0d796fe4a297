"""Runs of a scene at coarse spacings, kept beside each other, and what they say about a quantity."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from warpsph.comparison.quantities import name_of, values_of
from warpsph.comparison.row import History
from warpsph.output.probes_csv import read_probes
from warpsph.output.run_directory import RunDirectory
from warpsph.scene import load_scene
from warpsph.scene.accuracy import Accuracy, Quantity
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.schema import Scene
from warpsph.validation.options import unique
from warpsph.validation.plan import Pilot, Plan, pilot_spacings, plan_from
from warpsph.validation.runner import RunScene


class PlanError(Exception):
    """Pilots that came to their ends allow no plan; the text says why."""


@dataclass(frozen=True)
class FinishedRun:
    """A complete run: its scene, the summary, and the directory with its probes."""

    scene: Scene
    summary: Mapping[str, Any]
    directory: Path

    def values_of(self, quantity: Quantity) -> np.ndarray:
        """Computed values of a quantity, shape (values,)."""
        rows = {row["quantity"]: row for row in self.summary["references"]}
        history = {} if isinstance(quantity, str) else self._history
        return values_of(quantity, self.scene, history, rows)

    @cached_property
    def _history(self) -> History:
        file = RunDirectory(self.directory).probes
        return {name: np.asarray(values) for name, values in read_probes(file).items()}


def accuracy_of(scene: Scene) -> Accuracy:
    """What the scene asks for. Raises SceneError if it asks for nothing."""
    if scene.accuracy is None:
        allowed = "such as accuracy: {quantity: NAME OF A REFERENCE, within: 3%}"
        raise scene.located(
            SceneError([Problem.at("accuracy", "the scene asks for no accuracy to plan for", allowed)])
        )
    return scene.accuracy


def pilot_scenes(scene: str, overrides: Sequence[str]) -> tuple[Scene, ...]:
    """The scene at the spacings of its pilots, coarse ones first.

    Frames are not kept as USD unless an override says so, and what accuracy is asked for changes no pilot. Raises
    SceneError with the problems of all pilots, or if the scene asks for no accuracy.
    """
    base = load_scene(scene, overrides)
    return coarser_scenes(scene, overrides, accuracy_of(base).pilots or pilot_spacings(base.spacing))


def coarser_scenes(scene: str, overrides: Sequence[str], spacings: Sequence[float]) -> tuple[Scene, ...]:
    """The scene at these spacings [m]. Raises SceneError with the problems of all."""
    scenes: list[Scene] = []
    problems: list[Problem] = []
    for spacing in spacings:
        every = ["output.usd=false", *overrides, "accuracy=null", f"spacing={spacing!r}"]
        try:
            scenes.append(load_scene(scene, every))
        except SceneError as error:
            problems.extend(_by_its_spacing(problem, spacing) for problem in error.problems)
    if problems:
        raise SceneError(unique(problems))
    return tuple(scenes)


def _by_its_spacing(problem: Problem, spacing: float) -> Problem:
    """The problem of a spacing that nobody has written, by what brings it."""
    given = problem.file != f"--set spacing={spacing!r}"
    return problem if given else replace(problem, file=f"the coarse run at {spacing:g} m")


def pilot_directory(directory: Path, scene: Scene) -> Path:
    """Where a pilot runs, in the directory of the whole run."""
    return directory / "pilots" / f"{scene.spacing:g}"


def run_pilots(scenes: Sequence[Scene], directory: Path, run_scene: RunScene) -> tuple[FinishedRun, ...]:
    """Run the pilots, each below the directory."""
    runs = []
    for scene in scenes:
        own = pilot_directory(directory, scene)
        runs.append(FinishedRun(scene, run_scene(scene, own), own))
    return tuple(runs)


def plan_of(accuracy: Accuracy, runs: Sequence[FinishedRun]) -> Plan:
    """The plan that the pilots allow. Raises PlanError where a pilot has no value of the quantity."""
    pilots = tuple(_pilot(accuracy.quantity, run) for run in runs)
    scale = None if accuracy.relative_to == "value" else accuracy.relative_to
    return plan_from(pilots, accuracy.within, scale)


def _pilot(quantity: Quantity, run: FinishedRun) -> Pilot:
    figure, summary = run.values_of(quantity), run.summary
    if not np.isfinite(figure).all():
        raise PlanError(
            f"the pilot at spacing {run.scene.spacing:g} m has no value of {name_of(quantity)}: it is too coarse, or "
            "the run too short for it"
        )
    return Pilot(
        spacing=run.scene.spacing,
        figure=figure,
        wall_seconds=summary["wall_s"],
        particles=summary["particles"],
        steps=summary["steps"]["count"],
        bytes_per_particle=summary["bytes_per_particle"],
        machine=f"{summary['device']}, {summary['threads']} thread{'s' * (summary['threads'] != 1)}",
    )
