"""`warpsph plan`: which spacing the accuracy of a scene needs, and what that costs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from warpsph.cli.failures import ExitCode, reported
from warpsph.cli.options import Device, NoProgress, OutDirectory, Overrides, SceneArgument, Threads, Verbose

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rich.console import Console, RenderableType

    from warpsph.scene.schema import Scene
    from warpsph.validation.pilots import FinishedRun
    from warpsph.validation.plan import Plan

Json = Annotated[bool, typer.Option("--json", help="Print one JSON object instead of tables.")]


@reported
def plan(
    scene: SceneArgument,
    out: OutDirectory = None,
    device: Device = None,
    threads: Threads = None,
    overrides: Overrides = None,
    as_json: Json = False,
    quiet: NoProgress = False,
    verbose: Verbose = False,
) -> ExitCode:
    """Propose the spacing for the accuracy that a scene asks for, from two or three coarse pilots.

    The pilots run at the scene's spacing and at 1/1.5 and 1/2 of it, unless accuracy.pilots names others. They stay
    in the directory of the run, and a later plan or run takes them from there. Exit code 0 with a proposal, 1 if the
    pilots allow none, 2 if the scene or the request is wrong.
    """
    from warpsph.cli.consoles import plain_console
    from warpsph.cli.run import default_directory
    from warpsph.cli.warp_runtime import start_warp
    from warpsph.scene import load_scene
    from warpsph.validation.pilots import pilot_scenes

    loaded = load_scene(scene, overrides or ())
    pilots = pilot_scenes(scene, overrides or ())
    start_warp(device, verbose=verbose)
    progress = plain_console(stderr=True, quiet=quiet)
    directory = out or default_directory(loaded)
    made, _ = make_plan(loaded, pilots, directory, progress, device=device, threads=threads, quiet=quiet)
    if as_json:
        print(json.dumps(plan_record(loaded, made), allow_nan=False))
    else:
        show_plan(plain_console(), loaded, made)
    return ExitCode.OK if made.proposal else ExitCode.FAILED


def make_plan(
    scene: Scene,
    pilots: Sequence[Scene],
    directory: Path,
    progress: Console,
    *,
    device: str | None,
    threads: int | None,
    quiet: bool,
) -> tuple[Plan, tuple[FinishedRun, ...]]:
    """Run the pilots that are not kept in the directory; the plan, which is also written there, and the runs."""
    from warpsph.output.summary import write_summary
    from warpsph.validation.pilots import accuracy_of, plan_of

    runs = run_coarser(pilots, directory, progress, device=device, threads=threads, quiet=quiet)
    made = plan_of(accuracy_of(scene), runs)
    write_summary(directory / "plan.json", plan_record(scene, made))
    return made, runs


def run_coarser(
    scenes: Sequence[Scene],
    directory: Path,
    progress: Console,
    *,
    device: str | None,
    threads: int | None,
    quiet: bool,
) -> tuple[FinishedRun, ...]:
    """Have the scenes run below the directory, each once, and say which."""
    from warpsph.cli.validate import runner_with
    from warpsph.validation.pilots import run_pilots

    have_run = runner_with(progress, quiet, device, threads, resume=True)
    numbers = iter(range(1, len(scenes) + 1))

    def run_at(scene: Scene, own: Path) -> Mapping[str, Any]:
        progress.print(f"pilot {next(numbers)}/{len(scenes)} at spacing {scene.spacing:g} m")
        return have_run(scene, own)

    return run_pilots(scenes, directory, run_at)


def plan_record(scene: Scene, made: Plan) -> dict[str, Any]:
    """The plan for JSON, with the scene and the quantity that it is about."""
    from warpsph.comparison.quantities import name_of, unit_of_quantity
    from warpsph.validation.pilots import accuracy_of

    quantity = accuracy_of(scene).quantity
    about = {"scene": scene.name, "quantity": name_of(quantity), "unit": unit_of_quantity(quantity, scene)}
    return about | made.as_record()


def show_plan(console: Console, scene: Scene, made: Plan) -> None:
    """The pilots as a table, what they show, and the proposal or the way out."""
    from warpsph.validation.pilots import accuracy_of

    record = plan_record(scene, made)
    accuracy, unit = accuracy_of(scene), record["unit"]
    whole = "its value" if accuracy.relative_to == "value" else f"{accuracy.relative_to:g} {unit}"
    console.print(
        f"{scene.name}: {record['quantity']} within {percent(made.within)} of {whole}", soft_wrap=True
    )
    console.print(_pilot_table(made, unit))
    for line in _lines(made):
        console.print(line, soft_wrap=True, highlight=False)


def _pilot_table(made: Plan, unit: str) -> RenderableType:
    from rich.table import Table

    from warpsph.cli.info import size_in_words
    from warpsph.validation.richardson import root_mean_square

    several = len(made.pilots[0].figure) > 1
    value = f"{'root mean square' if several else 'value'} [{unit}]"
    columns = ("spacing [m]", value, "error estimate", "particles", "steps", "wall [s]", "memory")
    table = Table(*columns, box=None, pad_edge=False)
    for pilot in made.pilots:
        shown = root_mean_square(pilot.figure) if several else float(pilot.figure[0])
        error = made.error_of(pilot)
        table.add_row(
            f"{pilot.spacing:.4g}",
            f"{shown:.6g}",
            "-" if error is None else percent(error),
            str(pilot.particles),
            str(pilot.steps),
            f"{pilot.wall_seconds:.3g}",
            size_in_words(pilot.memory_bytes),
        )
    return table


def _lines(made: Plan) -> Iterator[str]:
    yield f"convergence: {order_in_words(made)}"
    if made.proposal is None:
        yield f"no spacing is proposed: {made.advice}"
        return
    yield f"proposed: {proposal_in_words(made)}"
    if made.advice:
        yield f"mind: {made.advice}"


def order_in_words(made: Plan) -> str:
    """The order with its uncertainty, or why there is none."""
    found = made.extrapolation
    if found.behaviour == "order assumed":
        return f"order {found.order:g} assumed: two pilots show none"
    if found.observed is None:
        return {"equal": "the pilots agree to rounding"}.get(found.behaviour, f"none, {found.behaviour}")
    order = f"observed order {found.observed:.2f} +- {found.order_uncertainty:.2f}"
    if found.order is None:
        return f"none, {found.behaviour}: {order}"
    return order if found.order == found.observed else f"{order}, taken as {found.order:g}"


def proposal_in_words(made: Plan) -> str:
    """The spacing, the error to expect with its uncertainty, and what the run takes."""
    from warpsph.cli.info import size_in_words
    from warpsph.cli.progress import duration

    proposal = made.proposal
    assert proposal is not None
    return (
        f"spacing {proposal.spacing:.4g} m; expected error {percent(proposal.error)}, with its uncertainty at most "
        f"{percent(proposal.uncertainty)}; about {proposal.particles:.3g} particles, {proposal.steps:.3g} steps, "
        f"{duration(proposal.wall_seconds)} on {proposal.machine}, {size_in_words(proposal.memory_bytes)}"
    )


def plan_in_words(record: Mapping[str, Any]) -> str:
    """The plan that a run follows, from its record: which spacing, for what."""
    proposal = record["proposal"]
    return (
        f"spacing {proposal['spacing']:.4g} m for {record['quantity']} within {percent(record['within'])}; "
        f"expected error {percent(proposal['error'])}, at most {percent(proposal['uncertainty'])}"
    )


def outcome_in_words(record: Mapping[str, Any]) -> str:
    """What a planned run shows itself of its accuracy, and what to do where that is not what was asked for."""
    shown, spacing = record["outcome"], record["proposal"]["spacing"]
    if shown["met"] is None:
        return "not known: a run has no value of the quantity"
    words = f"estimated error {percent(shown['error'])}, at most {percent(shown['uncertainty'])}"
    if shown["met"]:
        return f"met: {words}"
    pilots = ", ".join(f"{spacing * factor:.4g}" for factor in (2.0, 4.0 / 3.0, 1.0))
    return f"not met: {words}; plan again from here with accuracy.pilots: [{pilots}]"


def percent(part: float) -> str:
    """A part of a whole in percent."""
    return f"{100.0 * part:.3g} %"
