"""Hold estimates of the discretisation error against errors that are known, in docs/accuracy.md.

python tools/error_estimates.py

Takes the runs of docs/validation.jsonl: figures with a reference value at two or more resolutions. The estimate knows
the values alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
import pages

from warpsph.scene import load_scene, shipped_scenes
from warpsph.scene.references import FeatureReference, InlineTable, Reference, SeriesReference
from warpsph.validation.convergence import is_change
from warpsph.validation.richardson import Extrapolation, extrapolate

ROOT = Path(__file__).resolve().parents[1]
RECORD, PAGE = ROOT / "docs/validation.jsonl", ROOT / "docs/accuracy.md"
BEGIN, END = "<!-- estimates:begin -->", "<!-- estimates:end -->"
COLUMNS = ("scene", "quantity", "spacings [m]", "order", "estimate", "at most", "true error", "covered")

Row = Mapping[str, Any]


@dataclass(frozen=True)
class Trial:
    """An estimate at the finest of some spacings beside the true error, all relative to the reference."""

    scene: str
    quantity: str
    spacings: tuple[float, ...]
    found: Extrapolation
    estimate: float
    at_most: float
    true: float
    uncertainty: float

    @property
    def covered(self) -> bool:
        """Whether the true error is as small as was said, as far as the reference is known."""
        return self.true <= self.at_most + self.uncertainty


def trials(rows: Iterable[Row], references: Mapping[tuple[str, str], Reference]) -> Iterator[Trial]:
    """A trial with the two finest runs of every figure, and one with the three finest where there are three."""
    usable = [row for row in rows if _is_usable(row, references.get((row["scene"], row["quantity"])))]
    usable.sort(key=lambda row: (row["scene"], row["quantity"], -row["resolution"]))
    for _, group in groupby(usable, key=lambda row: (row["scene"], row["quantity"])):
        own = list(group)
        for count in range(2, min(len(own), 3) + 1):
            yield trial(own[-count:])


def trial(rows: list[Row]) -> Trial:
    """The trial of one figure at spacings, coarse ones first."""
    finest, spacings = rows[-1], tuple(row["resolution"] for row in rows)
    found = extrapolate(spacings, [np.array([row["value"]]) for row in rows])
    scale = abs(finest["reference"])
    return Trial(
        scene=finest["scene"],
        quantity=finest["quantity"],
        spacings=spacings,
        found=found,
        estimate=found.error / scale,
        at_most=found.uncertainty / scale,
        true=abs(finest["value"] - finest["reference"]) / scale,
        uncertainty=finest.get("uncertainty") or 0.0,
    )


def table(found: Iterable[Trial]) -> str:
    """A Markdown table of all trials, and how many are covered."""
    found = list(found)
    counts = "; ".join(
        f"with {count} spacings {sum(t.covered for t in own)} of {len(own)}"
        for count in (2, 3)
        if (own := [t for t in found if len(t.spacings) == count])
    )
    lines = [
        f"The true error is within what was said: {counts}.",
        "",
        *pages.table(COLUMNS, map(_cells, found)),
    ]
    return "\n".join(lines)


def _is_usable(row: Row, reference: Reference | None) -> bool:
    """Whether the value is one figure, with one reference value that is not a coarser run."""
    of_one_time = (
        isinstance(reference, SeriesReference)
        and isinstance(reference.table, InlineTable)
        and len(reference.at or reference.table.time) == 1
    )
    known = row["value"] is not None and row["reference"]
    return bool(known) and not is_change(row) and (of_one_time or isinstance(reference, FeatureReference))


def _cells(one: Trial) -> list[str]:
    found = one.found
    return [
        f"`{one.scene}`",
        one.quantity.replace("_", " "),
        ", ".join(f"{spacing:.4g}" for spacing in one.spacings),
        _order(found),
        *(f"{100.0 * part:.2g} %" for part in (one.estimate, one.at_most, one.true)),
        "yes" if one.covered else "**no**",
    ]


def _order(found: Extrapolation) -> str:
    observed = "" if found.observed is None else f"{found.observed:.2f} observed"
    if found.order is None:
        return ", ".join(filter(None, (f"none, {found.behaviour}", observed)))
    used = "" if found.relies_on_observation else f"{found.order:g} assumed"
    return ", ".join(filter(None, (observed, used)))


def main() -> None:
    """Write the table anew."""
    references = {
        (name, quantity): reference
        for name, path in shipped_scenes().items()
        for quantity, reference in load_scene(path).references.items()
    }
    rows = pages.read_rows(RECORD)
    pages.rewrite(PAGE, BEGIN, END, table(trials(rows, references)))


if __name__ == "__main__":
    main()
