"""Options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

SceneArgument = Annotated[
    str, typer.Argument(metavar="SCENE", help="A scene file, or a shipped scene's name.")
]
Overrides = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY=VALUE", help="Override a value of the scene, as in time.end=0.5; repeatable."
    ),
]
Device = Annotated[
    str | None, typer.Option(help="Device, such as cpu or cuda:0. Default: a GPU if there is one.")
]
Threads = Annotated[int | None, typer.Option(min=1, help="CPU threads. Default: every core.")]
Verbose = Annotated[bool, typer.Option("--verbose", help="Show what Warp says, and tracebacks of errors.")]
NoProgress = Annotated[bool, typer.Option("--quiet", help="Show no progress.")]
OutDirectory = Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Directory of the run.")]
