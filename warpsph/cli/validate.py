"""`warpsph validate`: how good are the numbers, and what do they cost."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from warpsph.cli.failures import BadInput, ExitCode, reported
from warpsph.cli.options import Device, NoProgress, Overrides, Threads, Verbose

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rich.console import Console

    from warpsph.scene.schema import Scene
    from warpsph.validation.options import ComparedOption
    from warpsph.validation.runner import Case, CaseResult, RunScene

Scenes = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="[SCENE]...",
        help="Scene files or names of shipped scenes. Default: all shipped ones with references.",
    ),
]
Quick = Annotated[
    bool, typer.Option("--quick", help="Only the coarse resolutions that the scenes name for this.")
]
Resolutions = Annotated[
    str | None, typer.Option(metavar="DP,DP,...", help="Particle spacings [m] instead of the scenes' own.")
]
Compare = Annotated[
    list[str] | None,
    typer.Option(
        "--compare",
        metavar="KEY=VALUE,VALUE,...",
        help="Run with each of these values of the scene, as in numerics.kernel=wendland_c2,cubic_spline; repeatable: "
        "then with every combination.",
    ),
]
Hard = Annotated[
    bool,
    typer.Option(
        "--hard",
        help="Run the hard cases, meant to break the scheme, instead of scenes; SCENE names some of them.",
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object a line instead of a table.")]
Report = Annotated[
    bool,
    typer.Option("--report", help="Write report.html and its pictures too; they need the extra `render`."),
]
Resume = Annotated[
    bool,
    typer.Option(
        "--resume", help="Take complete runs of the same scenes from the directory, run the others."
    ),
]
Jobs = Annotated[
    int,
    typer.Option(
        min=1,
        help="Runs at the same time, each in a process of its own on one thread, unless --threads says otherwise.",
    ),
]
Out = Annotated[Path, typer.Option("--out", metavar="DIR", help="Directory of all runs.")]


@reported
def validate(
    scenes: Scenes = None,
    quick: Quick = False,
    hard: Hard = False,
    resolutions: Resolutions = None,
    compare: Compare = None,
    json_lines: Json = False,
    report: Report = False,
    resume: Resume = False,
    jobs: Jobs = 1,
    out: Out = Path("out/validation"),
    device: Device = None,
    threads: Threads = None,
    overrides: Overrides = None,
    quiet: NoProgress = False,
    verbose: Verbose = False,
) -> ExitCode:
    """Run scenes over their resolutions and compare them with their references.

    Progress goes to stderr, results to stdout, and all figures also to report.json in the directory of the runs. Exit
    code 0 if every bound holds, 1 if one does not or a run fails, 2 if a scene or the request is wrong, which is
    found before the first run.
    """
    from warpsph.cli.consoles import plain_console
    from warpsph.cli.kept import require_directory
    from warpsph.cli.tables import validation_table
    from warpsph.cli.warp_runtime import start_warp
    from warpsph.validation.convergence import judged

    if hard:
        of_scenes = {"--quick": quick, "--resolutions": resolutions, "--compare": compare, "--set": overrides}
        refuse_with_hard({**of_scenes, "--resume": resume, "--jobs": jobs > 1})
        start_warp(device, verbose=verbose)
        from warpsph.cli.hard import validate_hard
        from warpsph.validation.hard.case import Machine

        console = plain_console(stderr=True, quiet=quiet)
        chosen = Machine(device, threads)
        return validate_hard(scenes or (), chosen, out, console, json_lines=json_lines, with_page=report)
    spacings = parse_spacings(resolutions)
    compared = parse_compared(compare or ())
    cases = planned_cases(scenes, quick, spacings, overrides or (), compared)
    require_directory(out)
    progress = plain_console(stderr=True, quiet=quiet)
    start_warp(device, verbose=verbose)
    found = (
        _one_by_one(cases, out, progress, runner_with(progress, quiet, device, threads, resume=resume))
        if jobs == 1
        else _side_by_side(cases, out, progress, jobs, device, threads or 1, resume=resume, verbose=verbose)
    )
    results: list[CaseResult] = []
    try:
        for result in found:
            results.append(judged(result, results, cases))
            if json_lines:
                print_json_lines(results[-1])
    finally:
        if results and not json_lines:
            plain_console().print(validation_table(results))
        if results:
            write_report(results, out, progress, with_page=report)
    return ExitCode.OK if all(result.holds for result in results) else ExitCode.FAILED


def _one_by_one(cases: Sequence[Case], out: Path, progress: Console, run: RunScene) -> Iterator[CaseResult]:
    """The result of each case in turn; shows how its run goes."""
    from warpsph.validation.runner import run_case

    for number, case in enumerate(cases, start=1):
        progress.print(f"{number}/{len(cases)} {in_words(case)}", soft_wrap=True)
        yield run_case(case, out, run)


def _side_by_side(
    cases: Sequence[Case],
    out: Path,
    progress: Console,
    jobs: int,
    device: str | None,
    threads: int,
    *,
    resume: bool,
    verbose: bool,
) -> Iterator[CaseResult]:
    """The results of all cases in their order, several of which run at the same time; says which are done."""
    from warpsph.cli.warp_runtime import start_warp
    from warpsph.validation.side_by_side import side_by_side

    run = partial(run_alone, out=out, device=device, threads=threads, resume=resume)
    begin = partial(start_warp, device, verbose=verbose)
    done = side_by_side(cases, run, jobs, begin)
    for number, (case, result) in enumerate(zip(cases, done, strict=True), start=1):
        seconds = (result.summary or {}).get("wall_s")
        took = "" if seconds is None else f" took {seconds:.3g} s"
        progress.print(f"{number}/{len(cases)} {in_words(case)}{took}", soft_wrap=True)
        yield result


def run_alone(case: Case, out: Path, device: str | None, threads: int, *, resume: bool) -> CaseResult:
    """The result of a case whose run says nothing."""
    from warpsph.cli.consoles import plain_console
    from warpsph.validation.runner import run_case

    silent = plain_console(stderr=True, quiet=True)
    return run_case(case, out, runner_with(silent, True, device, threads, resume=resume))


def refuse_with_hard(given: Mapping[str, Any]) -> None:
    """Raise BadInput for the first option that was given although hard cases have no use for it."""
    for option, value in given.items():
        if value:
            raise BadInput(
                f"{option} is of no use with --hard: the cases are fixed; allowed: names of cases, --json, --report, "
                "--out, --device and --threads"
            )


def in_words(case: Case) -> str:
    """Which case it is, for the progress."""
    options = f" with {', '.join(case.options)}" if case.options else ""
    skipped = f", without {', '.join(case.skipped)}, beyond its end" if case.skipped else ""
    return f"{case.scene.name} at spacing {case.scene.spacing:g} m{options}{skipped}"


def write_report(
    results: Sequence[CaseResult], directory: Path, console: Console, *, with_page: bool
) -> None:
    """Write what was found beside the runs, and say where it is and, even if progress is not shown, what is missing."""
    from warpsph.cli.consoles import plain_console
    from warpsph.report.content import scene_reports
    from warpsph.report.write import write_page, write_record

    reports = scene_reports(results)
    console.print(f"report {write_record(reports, directory)}", soft_wrap=True)
    if with_page:
        path, notice = write_page(reports, directory)
        console.print(f"report {path}", soft_wrap=True)
        if notice:
            plain_console(stderr=True).print(notice, soft_wrap=True)


def planned_cases(
    scenes: Sequence[str] | None,
    quick: bool,
    resolutions: Sequence[float] | None,
    overrides: Sequence[str],
    compared: Sequence[ComparedOption],
) -> tuple[Case, ...]:
    """Every run of the validation, all loaded, so that bad input shows before the first run."""
    from warpsph.validation.runner import cases_of, scenes_with_references

    return tuple(
        case
        for scene in scenes or scenes_with_references()
        for case in cases_of(
            scene, quick=quick, resolutions=resolutions, overrides=overrides, compared=compared
        )
    )


def runner_with(
    progress: Console, quiet: bool, device: str | None, threads: int | None, *, resume: bool
) -> RunScene:
    """A function that runs a scene into a directory and shows how it goes, unless a kept run spares it."""
    from warpsph.cli.progress import reporter_for
    from warpsph.solver.run import run_scene
    from warpsph.validation.kept import kept_summary

    def run(scene: Scene, directory: Path) -> Mapping[str, Any]:
        kept = kept_summary(scene, directory) if resume else None
        if kept is not None:
            progress.print(f"kept {directory}", soft_wrap=True)
            return kept
        with reporter_for(progress, quiet=quiet) as reporter:
            return run_scene(scene, directory, device=device, threads=threads, reporter=reporter)

    return run


def parse_spacings(text: str | None) -> tuple[float, ...] | None:
    """Particle spacings [m] from such as 0.02,0.01. Raises BadInput."""
    if text is None:
        return None
    try:
        spacings = tuple(float(part) for part in text.split(","))
    except ValueError:
        spacings = ()
    if not spacings or not all(0.0 < spacing < float("inf") for spacing in spacings):
        raise BadInput(f"--resolutions {text}: give particle spacings [m] greater than 0, as in 0.02,0.01")
    return spacings


def parse_compared(texts: Sequence[str]) -> tuple[ComparedOption, ...]:
    """Options and their values from such as numerics.kernel=wendland_c2,cubic_spline. Raises BadInput."""
    from warpsph.validation.options import compared_options

    try:
        return compared_options(texts)
    except ValueError as error:
        raise BadInput(f"--compare {error}") from error


def print_json_lines(result: CaseResult) -> None:
    """One object a line, on disk at once where stdout is a file."""
    for row in result.rows:
        print(json.dumps(row, allow_nan=False), flush=True)
