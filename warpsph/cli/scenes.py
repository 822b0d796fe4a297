"""`warpsph scenes`: what comes with the package."""

from __future__ import annotations

from warpsph.cli.failures import ExitCode, reported
from warpsph.cli.options import Verbose


@reported
def scenes(verbose: Verbose = False) -> ExitCode:
    """List the shipped scenes; each runs by its name."""
    from rich.table import Table

    from warpsph.cli.consoles import plain_console
    from warpsph.scene import load_scene, shipped_scenes

    table = Table("scene", "dimension", "references", "description", box=None, pad_edge=False)
    for name, path in shipped_scenes().items():
        scene = load_scene(path)
        description = " ".join(scene.description.split())
        table.add_row(name, f"{scene.dimension}D", str(len(scene.references)), description)
    plain_console().print(table)
    return ExitCode.OK
