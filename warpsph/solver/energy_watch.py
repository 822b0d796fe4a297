"""Watches the energy of what is closed: it must not grow beyond what it had and what was put in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from warpsph.probes.energy import EnergyProbe
from warpsph.scene.probes import EnergyProbe as EnergySpec
from warpsph.scene.schema import Scene
from warpsph.scene.types import AXES
from warpsph.solver.culprit import particle_with_extreme
from warpsph.solver.errors import SimulationDiverged
from warpsph.solver.ledger import sum_up
from warpsph.solver.simulation import Simulation
from warpsph.solver.structure_assembly import is_static

NOTABLE = 0.05
"""Energy gained, over what there was to gain it from, of which the run warns."""
FATAL = 1.0
"""The same at which it is stopped: as much again as all that there was."""
ADVICE = (
    "Energy comes from nothing where the step is too long for what happens in it, or particles are too few: try a "
    "smaller time.cfl or spacing, a higher numerics.sound_speed, or more viscosity."
)
STORED = ("strain_energy", "hourglass_energy", "contact_energy")
RESTING_MACH = 1.0e-4
"""Speed over sound speed below which a body counts as one at rest."""


def why_not_closed(scene: Scene) -> str | None:
    """What brings energy into a scene without being counted; None if its budget can be drawn up."""
    driven = [axis for axis in scene.domain.periodic if scene.gravity[AXES.index(axis)]]
    moved = [s for s in scene.structures.values() if s.loads or any(c.motion for c in s.clamps.values())]
    if scene.open_boundaries:
        return "open boundaries"
    if driven:
        return f"gravity along the periodic axis {driven[0]}"
    if is_static(scene):
        return "a static solution"
    if any(s.rigid and (s.rigid.motion or s.loads) for s in scene.structures.values()):
        return "rigid bodies that are loaded or moved"
    if scene.fluids and moved:
        return "structures in a fluid that are loaded or moved"
    if scene.structures and scene.contact and any(b.motion for b in scene.boundaries.values()):
        return "structures that may touch moving walls" if scene.fluids else None
    return None


@dataclass(frozen=True)
class _Balance:
    """Energies of one time [J]: kinetic, potential, and stored in what is compressed or strained; the work that loads
    and moving clamps have done so far [J], and the power of moving walls [W]; the mass of all that moves [kg]."""

    time: float
    kinetic: float
    potential: float
    stored: float
    work: float
    power: float
    mass: float

    @property
    def total(self) -> float:
        return self.kinetic + self.potential + self.stored


class EnergyWatch:
    """Draws up the budget: kinetic, potential, compression and elastic energy, less the work of walls and loads.

    What there is to gain energy from is the kinetic and stored energy of the start, the largest fall of the potential
    energy since, and all work whatever its sign. Beside it, what lifts everything by one spacing, and a Mach number of
    1e-4, count as rest. The power of moving walls is that of the forces on their particles, by the trapezoidal rule
    between looks.
    """

    name = "energy"

    def __init__(self, scene: Scene) -> None:
        self.warnings: list[str] = []
        # A look takes a few milliseconds where a step of few structure particles takes a tenth of one.
        self.every = 250 if scene.fluids else 2000
        self._gravity = np.asarray(scene.gravity)
        self._fluid = EnergyProbe("energy", EnergySpec(), scene) if scene.fluids else None
        self._moving = {name for name, boundary in scene.boundaries.items() if boundary.motion}
        self._first: _Balance | None = None
        self._last: _Balance | None = None
        self._lowest = 0.0
        self._work = self._gross = 0.0
        self._gained = self._largest = 0.0
        self._carried = 0.0
        self._removed = 0

    def start(self, sim: Simulation) -> None:
        """Take the energy of the start."""
        self._first = self._last = self._balance(sim)
        self._lowest, self._removed = self._first.potential, sim.removed_count

    def look(self, sim: Simulation) -> None:
        """Compare the energy with the budget. Raises SimulationDiverged where it has doubled."""
        assert self._first is not None
        assert self._last is not None
        now = self._balance(sim)
        self._add_work(self._last, now)
        gained = now.total - self._first.total - self._work - self._carried
        if sim.removed_count != self._removed:
            # What has left took its energy along, which is no loss of those who stay.
            self._carried += gained - self._gained
            self._removed = sim.removed_count
        else:
            self._gained = gained
        self._last, self._lowest = now, min(self._lowest, now.potential)
        self._judge(sim, now)

    def _add_work(self, last: _Balance, now: _Balance) -> None:
        by_walls = 0.5 * (last.power + now.power) * (now.time - last.time)
        done = by_walls + now.work - last.work
        self._work, self._gross = self._work + done, self._gross + abs(done)

    def _judge(self, sim: Simulation, now: _Balance) -> None:
        assert self._first is not None
        fallen = self._first.potential - self._lowest
        source = self._first.kinetic + self._first.stored + fallen + self._gross
        height = float(np.linalg.norm(self._gravity)) * sim.scene.spacing
        rest = now.mass * (height + (RESTING_MACH * sim.sound_speed) ** 2)
        self._largest = max(self._largest, self._gained / (source + rest))
        if self._gained > 10.0 * rest + FATAL * source:
            raise self._stopped(sim, source)
        if self._gained > rest + NOTABLE * source and not self.warnings:
            culprit = particle_with_extreme(sim, "velocity")
            self.warnings.append(
                f"at t = {sim.time:.6g} s there was {self._gained:.3g} J more energy than at the start and had been "
                f"put in, {self._gained / (source + rest):.0%} of all that there was to gain it from; fastest was "
                f"{culprit}. {ADVICE}"
            )

    def _stopped(self, sim: Simulation, source: float) -> SimulationDiverged:
        limit = (
            "it is the fastest of all, whose energy has grown by more than all that there was to gain it from, "
            f"{source:.3g} J"
        )
        return particle_with_extreme(sim, "velocity").diverged(sim, limit, self._gained, ADVICE)

    def _balance(self, sim: Simulation) -> _Balance:
        asked = {"velocity", "mass", "density", "pressure", "work", *STORED}
        asked |= {"force"} if self._moving else set()
        frame = sim.frame(sorted(asked & sim.system.fields), ordered=False)
        flowing = self._fluid.evaluate(frame) if self._fluid else (0.0, 0.0, 0.0)
        solid = frame.of_kind("structure")
        totals = sum_up(sim.time, solid, self._gravity)
        strained = sum(float(s.fields[name].sum()) for s in solid for name in STORED)
        moving = [s for s in frame.of_kind("boundary") if s.name in self._moving and "force" in s.fields]
        fluid_mass = sum(float(s.fields["mass"].sum()) for s in frame.of_kind("fluid"))
        return _Balance(
            time=sim.time,
            kinetic=flowing[0] + totals.kinetic_energy,
            potential=flowing[1] + totals.potential_energy,
            stored=flowing[2] + strained,
            work=0.0 if self._fluid else sum(float(s.fields["work"].sum()) for s in solid),
            power=-sum(float(np.sum(s.fields["force"] * s.fields["velocity"])) for s in moving),
            mass=fluid_mass + totals.mass,
        )

    def record(self) -> dict[str, Any]:
        """Energy gained at last [J], its largest part of what there was to gain it from, and the work put in [J]."""
        return {"gained_J": self._gained, "largest_share": self._largest, "work_J": self._work}

    def save(self) -> dict[str, Any]:
        """Everything as plain values."""
        balances = {"first": self._first, "last": self._last}
        plain = ("lowest", "work", "gross", "gained", "largest", "carried", "removed")
        return {name: getattr(self, f"_{name}") for name in plain} | {
            name: asdict(balance) if balance else None for name, balance in balances.items()
        }

    def load(self, saved: Mapping[str, Any]) -> None:
        """Go on from what `save` returned."""
        for name in ("lowest", "work", "gross", "gained", "largest", "carried", "removed"):
            setattr(self, f"_{name}", saved[name])
        self._first, self._last = (
            _Balance(**saved[name]) if saved[name] else None for name in ("first", "last")
        )
