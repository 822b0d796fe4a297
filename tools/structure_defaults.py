"""Error against cost of structures over smoothing length and hourglass stiffness: the table behind the defaults.

Runs CSM3 of Turek & Hron (the first two swings) and writes the table of docs/structure_defaults.md:

    python tools/structure_defaults.py
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from trials import run_trial, write_table

PAGE = Path(__file__).parents[1] / "docs/structure_defaults.md"
THICKNESS = 0.02
SMOOTHING = (0.7, 0.8, 0.9, 1.0, 1.3)
HOURGLASS = (0.1, 0.3, 0.4, 0.5, 0.7)
DEFAULT = (0.8, 0.4)
COLUMNS = (
    "t/dp",
    "h/dp",
    "hourglass",
    "first minimum",
    "period",
    "hourglass energy",
    "neighbours",
    "steps",
    "CPU [s]",
    "M particle-steps/s",
)


@dataclass(frozen=True)
class Trial:
    """What one choice costs and how far it is off; errors are relative, signed where the reference has a sign."""

    layers: int
    smoothing: float
    hourglass: float
    minimum: float
    period: float
    share: float
    neighbours: float
    particles: int
    steps: int
    seconds: float


def swing(layers: int, smoothing: float, hourglass: float) -> Trial:
    """Two swings of the bar with so many particles through its thickness, on one thread."""
    choice = [f"numerics.structure.h_over_dp={smoothing}", f"numerics.structure.hourglass={hourglass}"]
    summary, seconds = run_trial(
        "turek_hron_csm3", [f"spacing={THICKNESS / layers!r}", "time.end=2.0", *choice]
    )
    rows = {row["quantity"]: row for row in summary["references"]}
    energies = summary["ledger"]["end"]["energies"]
    return Trial(
        layers,
        smoothing,
        hourglass,
        _signed(rows["first_minimum"]),
        _signed(rows["period"]),
        energies["hourglass"] / (energies["strain"] + energies["hourglass"]),
        summary["neighbours"],
        summary["particles"],
        summary["steps"]["count"],
        seconds,
    )


def _signed(row: Mapping[str, Any]) -> float:
    return float(row["value"] / row["reference"] - 1.0)


def trials(layers: Iterable[int]) -> Iterator[Trial]:
    """Every choice at each resolution, those of the default line first; the finest resolution only along that line."""
    counts = sorted(layers)
    for count in counts:
        for smoothing in SMOOTHING:
            for hourglass in HOURGLASS:
                on_line = smoothing == DEFAULT[0] or hourglass == DEFAULT[1]
                if on_line or count < counts[-1]:
                    yield swing(count, smoothing, hourglass)


def cells(r: Trial) -> list[str]:
    """A row of the table, the default in bold."""
    mark = "**" if (r.smoothing, r.hourglass) == DEFAULT else ""
    return [
        f"{mark}{r.layers}{mark}",
        f"{mark}{r.smoothing:g}{mark}",
        f"{mark}{r.hourglass:g}{mark}",
        f"{100.0 * r.minimum:+.2f} %",
        f"{100.0 * r.period:+.2f} %",
        f"{100.0 * r.share:.1f} %",
        f"{r.neighbours:.1f}",
        str(r.steps),
        f"{r.seconds:.1f}",
        f"{r.steps * r.particles / r.seconds / 1e6:.1f}",
    ]


def main() -> None:
    """Run all trials and replace the table of the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--layers", type=int, nargs="+", default=[4, 8, 16], help="particles through the thickness"
    )
    rows = []
    for trial in trials(parser.parse_args().layers):
        print(trial, file=sys.stderr, flush=True)
        rows.append(trial)
    write_table(PAGE, COLUMNS, [cells(row) for row in rows])


if __name__ == "__main__":
    main()
