"""Coarse runs that go before a run: pilots to plan it by, or a second resolution to judge it by."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rich.console import Console

from warpsph.cli.plan import make_plan, percent, plan_record, run_coarser
from warpsph.cli.run import default_directory
from warpsph.comparison.quantities import name_of
from warpsph.output.run_directory import RunDirectory
from warpsph.output.summary import write_summary
from warpsph.scene import Scene, load_scene
from warpsph.validation.error_estimate import COARSER, error_estimates, outcome
from warpsph.validation.pilots import FinishedRun, PlanError, accuracy_of, coarser_scenes, pilot_scenes
from warpsph.validation.plan import Plan


@dataclass(frozen=True)
class Prepared:
    """A run to be made, the scenes of the coarse runs that go before it, and what these have shown.

    `source` and `overrides` are what the scene was loaded from.
    """

    source: str
    overrides: tuple[str, ...]
    scene: Scene
    directory: Path
    coarse: tuple[Scene, ...]
    plans: bool
    estimates_error: bool
    plan: Plan | None = None
    runs: tuple[FinishedRun, ...] = ()

    def run_coarse(
        self, console: Console, *, device: str | None, threads: int | None, quiet: bool
    ) -> Prepared:
        """Make the coarse runs, if any; with a plan, the scene gets the spacing that it proposes.

        Raises PlanError if the pilots allow none.
        """
        if not self.coarse:
            return self
        options: dict[str, Any] = {"device": device, "threads": threads, "quiet": quiet}
        if not self.plans:
            return replace(self, runs=run_coarser(self.coarse, self.directory, console, **options))
        plan, runs = make_plan(self.scene, self.coarse, self.directory, console, **options)
        if plan.proposal is None:
            raise PlanError(f"the pilots allow no spacing: {plan.advice}; `warpsph plan` shows them")
        scene = load_scene(self.source, [*self.overrides, f"spacing={plan.proposal.spacing!r}"])
        return replace(self, scene=scene, plan=plan, runs=runs)

    def completed(self, summary: Mapping[str, Any]) -> Mapping[str, Any]:
        """The summary with the plan and with the discretisation errors, also in the directory."""
        run, others = FinishedRun(self.scene, summary, self.directory), self._at_other_spacings()
        added: dict[str, Any] = {}
        if self.plan is not None:
            shown = outcome(self.plan, accuracy_of(self.scene).quantity, run, others)
            added["plan"] = plan_record(self.scene, self.plan) | {"outcome": shown}
        if self.estimates_error:
            added["discretisation_error"] = error_estimates(run, others)
        whole = {**summary, **added}
        if added:
            write_summary(RunDirectory(self.directory).summary, whole)
        return whole

    @property
    def remark(self) -> str | None:
        """What a run leaves undone that its scene asks for."""
        accuracy = self.scene.accuracy
        if accuracy is None or self.plan is not None:
            return None
        target = f"{name_of(accuracy.quantity)} within {percent(accuracy.within)}"
        return (
            f"the scene asks for {target}: this run took its spacing as it stands; "
            "--plan takes the one that this needs"
        )

    def _at_other_spacings(self) -> tuple[FinishedRun, ...]:
        """A proposed spacing may be that of a pilot."""
        own = self.scene.spacing
        return tuple(run for run in self.runs if abs(run.scene.spacing / own - 1.0) > 1e-6)


def prepared(
    scene: str, overrides: Sequence[str], out: Path | None, *, plan: bool, estimate_error: bool
) -> Prepared:
    """The scene and its coarse runs, all loaded, so that bad input shows before the first run. Raises SceneError."""
    loaded = load_scene(scene, overrides)
    coarse: tuple[Scene, ...] = ()
    if plan:
        coarse = pilot_scenes(scene, overrides)
    elif estimate_error:
        coarse = coarser_scenes(scene, overrides, [COARSER * loaded.spacing])
    directory = out or default_directory(loaded)
    return Prepared(scene, tuple(overrides), loaded, directory, coarse, plan, estimate_error)
