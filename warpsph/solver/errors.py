"""How a run can fail."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class SimulationDiverged(RuntimeError):
    """A particle left the range in which the scheme means anything.

    `limit` says which range, `value` what was found there, `particle` the id in `set`, `position` its place [m].
    """

    set: str
    particle: int
    position: tuple[float, ...]
    time: float
    step: int
    limit: str
    value: float
    advice: str

    def __str__(self) -> str:
        place = ", ".join(f"{x:.6g}" for x in self.position)
        return (
            f"the run diverged at t = {self.time:.6g} s (step {self.step}): particle {self.particle} of "
            f"{self.set} at ({place}) m: {self.limit} (found {self.value:.6g}). {self.advice}"
        )
