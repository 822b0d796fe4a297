"""What a run should conserve, at its start and at its end, from the ledger in its summary."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from warpsph.report.words import quantity_in_words
from warpsph.scene.types import AXES

NAMES = {
    "strain": "strain energy",
    "hourglass": "hourglass energy",
    "work": "work of loads and clamps",
    "dissipated": "dissipated energy",
}


@dataclass(frozen=True)
class Entry:
    """A total in its unit at the start and, unless the run broke off, at the end."""

    name: str
    unit: str
    start: float
    end: float | None

    @property
    def change(self) -> float | None:
        """End less start."""
        return None if self.end is None else self.end - self.start


def entries_of(summary: Mapping[str, Any]) -> tuple[Entry, ...]:
    """Mass, energies and momentum of a run; in two dimensions per metre of depth."""
    start, end = summary["ledger"]["start"], summary["ledger"]["end"]
    after = {} if end is None else {name: value for name, _, value in _totals(end)}
    return tuple(Entry(name, unit, value, after.get(name)) for name, unit, value in _totals(start))


def _totals(ledger: Mapping[str, Any]) -> Iterator[tuple[str, str, float]]:
    mass, energy, momentum = (
        ("kg/m", "J/m", "kg/s") if len(ledger["momentum"]) == 2 else ("kg", "J", "kg m/s")
    )
    yield "mass", mass, ledger["mass"]
    yield "kinetic energy", energy, ledger["kinetic_energy"]
    yield "potential energy", energy, ledger["potential_energy"]
    for name, value in ledger["energies"].items():
        yield NAMES.get(name, quantity_in_words(name)), energy, value
    for axis, value in zip(AXES, ledger["momentum"], strict=False):
        yield f"momentum {axis}", momentum, value
