"""`warpsph render`: pictures and a movie from the frames of a run."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from warpsph.cli.extras import require_render_extra
from warpsph.cli.failures import BadInput, ExitCode, reported
from warpsph.cli.options import Verbose

if TYPE_CHECKING:
    from rich.console import Console

Source = Annotated[Path, typer.Argument(metavar="RUN", help="A run directory, or a USD file of particles.")]
Field = Annotated[str, typer.Option(help="Field that colours the particles; a vector by its magnitude.")]
Size = Annotated[str, typer.Option(metavar="WxH", help="Size of the pictures in pixels.")]
Frames = Annotated[
    str, typer.Option(metavar="SLICE", help="Frames to draw: one number, or 10:50, ::5, -1 ...")
]
Fps = Annotated[
    float | None, typer.Option(min=0.1, help="Frames a second of the movie. Default: real time, 60 at most.")
]
Streamlines = Annotated[
    bool, typer.Option("--streamlines", help="Draw the streamlines of each moment; in two dimensions.")
]
Paths = Annotated[
    bool, typer.Option("--paths", help="Draw the paths of particles too, which output.paths records.")
]

DEFAULT_SIZE = "1280x720"


@reported
def render(
    source: Source,
    field: Field = "velocity",
    size: Size = DEFAULT_SIZE,
    frames: Frames = ":",
    fps: Fps = None,
    streamlines: Streamlines = False,
    paths: Paths = False,
    verbose: Verbose = False,
) -> ExitCode:
    """Draw the frames of a run: a PNG each and one MP4, in the directory `render` beside the frames.

    Needs the extra `render` of the package, but no display and no graphics driver.
    """
    from warpsph.cli.consoles import plain_console
    from warpsph.cli.warp_runtime import start_warp

    require_render_extra()
    start_warp(verbose=verbose)
    draw(
        source,
        plain_console(),
        field=field,
        size=parse_size(size),
        frames=frames,
        fps=fps,
        streamlines=streamlines,
        paths=paths,
    )
    return ExitCode.OK


def draw(
    source: Path,
    console: Console,
    *,
    field: str = "velocity",
    size: tuple[int, int] | None = None,
    frames: str = ":",
    fps: float | None = None,
    streamlines: bool = False,
    paths: bool = False,
) -> None:
    """Draw with a progress bar, and say where the pictures are."""
    require_render_extra()
    from rich.progress import Progress

    from warpsph.rendering.movie import render as render_run

    with Progress(console=console, disable=console.quiet or not console.is_terminal) as bar:
        task = bar.add_task("drawing", total=None)
        pictures = render_run(
            source,
            field=field,
            size=size or parse_size(DEFAULT_SIZE),
            frames=frames,
            fps=fps,
            streamlines=streamlines,
            paths=paths,
            progress=lambda done, total: bar.update(task, completed=done, total=total),
        )
    console.print(f"{len(pictures.images)} pictures in {pictures.images[0].parent}", soft_wrap=True)
    if pictures.movie:
        console.print(f"movie {pictures.movie}", soft_wrap=True)


def parse_size(text: str) -> tuple[int, int]:
    """Width and height from such as 1280x720. Raises BadInput."""
    match = re.fullmatch(r"(\d+)x(\d+)", text)
    if not match:
        raise BadInput(f"--size {text}: give width x height in pixels, as in {DEFAULT_SIZE}")
    return int(match[1]), int(match[2])
