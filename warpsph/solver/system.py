"""What a simulation advances: the particles and models of a scene behind one interface."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import warp as wp

from warpsph.frame import Inflow, SetFrame
from warpsph.solver.ledger import Ledger


@dataclass(frozen=True)
class StepReport:
    """What a step did: its size [s], the limit that ruled it, and how many steps of that size were made at once.

    `sub_steps` are the steps that structures made within a step of the fluid, those ahead of it included.
    """

    dt: float
    limit: str
    count: int = 1
    sub_steps: int = 0


class System(Protocol):
    """The particles and models of a scene.

    A kind of system is a set of models that share a step: fluids with their walls, structures alone.
    """

    @property
    def time(self) -> float:
        """Simulated time [s]."""

    @property
    def particle_count(self) -> int:
        """Particles alive, of every kind."""

    @property
    def removed_count(self) -> int:
        """Particles that have left the kill box."""

    @property
    def list_builds(self) -> int:
        """How often neighbour lists have been made."""

    @property
    def sound_speed(self) -> float:
        """Largest sound speed at rest of all materials [m/s]."""

    @property
    def sets(self) -> tuple[tuple[str, str, int], ...]:
        """Name, kind and number of living particles of each set."""

    @property
    def extremes(self) -> Mapping[str, float]:
        """Largest values at the last choice of a step, by name; `speed` [m/s] is always there."""

    @property
    def fields(self) -> frozenset[str]:
        """Names of the fields that frames can carry."""

    @property
    def arrays(self) -> Mapping[str, wp.array]:
        """State arrays that a user may look at, by name."""

    def step(self, step_count: int) -> StepReport:
        """Advance by one step, or by a few equal ones; raises SimulationDiverged."""

    def set_target(self, time: float) -> None:
        """Let a coming step land on a time [s]; infinity: on none."""

    def frame_sets(self, fields: Sequence[str] | None, ordered: bool) -> tuple[SetFrame, ...]:
        """The particles as NumPy arrays, set by set; None stands for the usual fields. Raises KeyError."""

    def ledger(self) -> Ledger:
        """Conserved quantities of the present state."""

    def warnings(self, largest: Mapping[str, float]) -> list[str]:
        """What a reader of the results should know, from the largest extremes of the whole run."""

    def inflows(self) -> Mapping[str, Inflow]:
        """What has passed the open boundaries, by name."""

    def describe(self) -> dict[str, Any]:
        """What runs: passes, pairs, fields, memory and step limits."""

    def save(self) -> dict[str, Any]:
        """Everything that a run needs to go on with the same bits."""

    def load(self, saved: Mapping[str, Any]) -> None:
        """Go on from what `save` returned."""


def in_order(columns: Mapping[str, np.ndarray], ordered: bool, chosen: np.ndarray) -> dict[str, np.ndarray]:
    """The chosen particles of all columns, in the order of their ids if `ordered`."""
    if ordered:
        chosen = chosen[np.argsort(columns["id"][chosen])]
    return {name: values[chosen] for name, values in columns.items()}
