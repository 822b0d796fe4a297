"""`warpsph run`: from a scene to the files of a run."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from warpsph.cli.failures import ExitCode, reported
from warpsph.cli.options import Device, OutDirectory, Overrides, SceneArgument, Threads, Verbose

if TYPE_CHECKING:
    from warpsph.scene.schema import Scene

Resume = Annotated[bool, typer.Option("--resume", help="Go on from the checkpoint in the run directory.")]
Frames = Annotated[int | None, typer.Option(min=1, help="Stop after this many frames.")]
Quiet = Annotated[bool, typer.Option("--quiet", help="Print nothing but errors.")]
PlanFirst = Annotated[
    bool,
    typer.Option("--plan", help="Take the spacing that the scene's accuracy needs, as `warpsph plan` does."),
]
EstimateError = Annotated[
    bool,
    typer.Option(
        "--estimate-error",
        help="Run twice the spacing too, and state the discretisation error of every reference.",
    ),
]
Render = Annotated[
    bool, typer.Option("--render", help="Draw the frames at the end, as `warpsph render` does.")
]


@reported
def run(
    scene: SceneArgument,
    out: OutDirectory = None,
    device: Device = None,
    threads: Threads = None,
    overrides: Overrides = None,
    plan: PlanFirst = False,
    estimate_error: EstimateError = False,
    resume: Resume = False,
    frames: Frames = None,
    render: Render = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> ExitCode:
    """Run a scene and write its frames, probes and summary.

    The files go to out/SCENE unless --out or the scene says otherwise. Exit code 0 if the run came to its
    end, 1 if it failed, 2 if the scene or the request is wrong, 130 after Ctrl-C. What a run has written so
    far stays readable.
    """
    from warpsph.cli.coarse_runs import prepared
    from warpsph.cli.consoles import plain_console
    from warpsph.cli.extras import require_render_extra
    from warpsph.cli.kept import stating_what_is_kept
    from warpsph.cli.progress import reporter_for
    from warpsph.cli.summary import show_summary
    from warpsph.cli.warp_runtime import start_warp

    if render:
        require_render_extra()
    console = plain_console(quiet=quiet)
    before = prepared(scene, overrides or (), out, plan=plan, estimate_error=estimate_error)
    directory, flags = before.directory, ["--plan"] * plan + ["--estimate-error"] * estimate_error
    again = resume_command(scene, directory, overrides or (), device, threads, flags)
    start_warp(device, verbose=verbose)
    before = before.run_coarse(console, device=device, threads=threads, quiet=quiet)
    with reporter_for(console, quiet=quiet) as reporter, stating_what_is_kept(directory, again, reporter):
        from warpsph.solver.run import run_scene

        finished = run_scene(
            before.scene,
            directory,
            device=device,
            threads=threads,
            resume=resume,
            frames=frames,
            reporter=reporter,
        )
    summary = before.completed(finished)
    show_summary(console, directory, summary)
    if before.remark:
        console.print(before.remark, soft_wrap=True)
    if render:
        from warpsph.cli.render import draw

        draw(directory, console)
    return ExitCode.OK


def default_directory(scene: Scene) -> Path:
    """Where the files of a run go if the command does not say."""
    return Path(scene.output.directory or Path("out") / scene.name)


def resume_command(
    scene: str,
    directory: Path,
    overrides: Sequence[str],
    device: str | None,
    threads: int | None,
    flags: Sequence[str] = (),
) -> str:
    """The command that goes on with a run that was cut short."""
    words = ["warpsph", "run", scene, "--out", str(directory)]
    for override in overrides:
        words += ["--set", override]
    if device is not None:
        words += ["--device", device]
    if threads is not None:
        words += ["--threads", str(threads)]
    return shlex.join([*words, *flags, "--resume"])
