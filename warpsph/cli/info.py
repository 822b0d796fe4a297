"""`warpsph info`: what would run."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from warpsph.cli.failures import ExitCode, reported
from warpsph.cli.options import Device, Overrides, SceneArgument, Threads, Verbose

if TYPE_CHECKING:
    from rich.console import Console


@reported
def info(
    scene: SceneArgument,
    device: Device = None,
    threads: Threads = None,
    overrides: Overrides = None,
    verbose: Verbose = False,
) -> ExitCode:
    """Say what a scene would run: sets, passes, fields, memory, step limits, and what it may cost."""
    from warpsph.cli.consoles import plain_console
    from warpsph.cli.warp_runtime import start_warp
    from warpsph.scene import load_scene

    loaded = load_scene(scene, overrides or ())
    start_warp(device, verbose=verbose)
    from warpsph.solver.simulation import Simulation

    simulation = Simulation(loaded, device=device, threads=threads)
    console = plain_console()
    console.print(f"{loaded.name}: {loaded.dimension}D, spacing {loaded.spacing:g} m, {simulation.device}")
    show_description(console, simulation.describe(), loaded.time.end)
    return ExitCode.OK


def show_description(console: Console, description: Mapping[str, Any], end: float) -> None:
    """The tables of `info`, from `Simulation.describe()`; `end` is the simulated time [s]."""
    from warpsph.cli.progress import duration

    sets = description["sets"]
    console.print(
        _table(("set", "kind", "particles"), ((s["name"], s["kind"], str(s["particles"])) for s in sets))
    )
    console.print()
    console.print(_table(_SHAPE_HEADER, map(_shape_row, description["shapes"])))
    console.print()
    fields = ((f["name"], f["unit"], size_in_words(f["bytes"])) for f in description["fields"])
    console.print(_table(("field", "unit", "memory"), fields))
    if "search_bytes" in description:
        console.print(f"cells and sorting {size_in_words(description['search_bytes'])}")
    console.print(f"neighbour lists {size_in_words(description['list_bytes'])}")
    console.print(f"in all {description['bytes_per_particle']:.0f} bytes a particle\n")
    limits = sorted(description["step_limits_s"].items(), key=lambda item: item[1])
    console.print(_table(("step limit", "dt [s]"), ((name, f"{dt:.3g}") for name, dt in limits)))
    console.print()
    console.print(f"passes a step: {', '.join(description['passes'])}", soft_wrap=True)
    console.print(f"pairs: {', '.join(description['pairs'])}", soft_wrap=True)
    console.print(
        f"estimate: {description['estimated_steps']} steps for {end:g} s, "
        f"{duration(description['estimated_wall_s'])} on two CPU cores",
        soft_wrap=True,
    )


_SHAPE_HEADER = (
    "set",
    "shape",
    "volume",
    "sampled",
    "error",
    "extent [m]",
    "sampled [m]",
    "unevenness",
    "closest [dp]",
    "spread [dp]",
)


def _shape_row(record: Mapping[str, Any]) -> tuple[str, ...]:
    """What a shape encloses beside what its particles do; of layers along a surface the volume is no error."""
    volume, sampled, even = record["volume"], record["sampled_volume"], record["evenness"]
    compared = volume is not None and record["is_filled"]
    return (
        record["name"],
        record["shape"],
        "-" if volume is None else f"{volume:.5g}",
        f"{sampled:.5g}",
        f"{sampled / volume - 1.0:+.2%}" if compared else "-",
        _extent(record["extent"]),
        _extent(record["sampled_extent"]),
        "-" if even is None else f"{even['unevenness']:.2%}",
        "-" if even is None else f"{even['closest']:.2f}",
        "-" if even is None else f"{even['spread']:.2f}",
    )


def _extent(corners: Sequence[Sequence[float]] | None) -> str:
    """The two ends of each axis, one axis a line."""
    if corners is None:
        return "endless"
    return "\n".join(f"{low:.4g} to {high:.4g}" for low, high in zip(*corners, strict=True))


def size_in_words(size: float) -> str:
    """Bytes in the unit that fits."""
    for unit in ("B", "kB", "MB"):
        if size < 1000.0:
            return f"{size:.3g} {unit}"
        size /= 1000.0
    return f"{size:.3g} GB"


def _table(header: Iterable[str], rows: Iterable[tuple[str, ...]]) -> Any:
    from rich.table import Table

    table = Table(*header, box=None, pad_edge=False)
    for row in rows:
        table.add_row(*row)
    return table
