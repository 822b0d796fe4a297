"""The command line: `warpsph COMMAND`."""

from __future__ import annotations

from typing import Annotated

import typer

from warpsph import __version__
from warpsph.cli.bench import bench
from warpsph.cli.info import info
from warpsph.cli.plan import plan
from warpsph.cli.render import render
from warpsph.cli.run import run
from warpsph.cli.scenes import scenes
from warpsph.cli.schema import schema
from warpsph.cli.validate import validate

app = typer.Typer(
    name="warpsph",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
for command in (run, plan, info, scenes, validate, bench, schema, render):
    app.command()(command)


def _print_version(asked: bool) -> None:
    if asked:
        print(f"warpsph {__version__}")
        raise typer.Exit


Version = Annotated[
    bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version.")
]


@app.callback()
def warpsph(version: Version = False) -> None:
    """Smoothed particle hydrodynamics on NVIDIA Warp: from a YAML scene to a USD point cache."""


def main() -> None:
    """Entry point of the `warpsph` command."""
    app()
