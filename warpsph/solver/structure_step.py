"""The step of structures alone, as a page of verbs.

Velocity Verlet (kick, drift, kick): of second order, symplectic, one force sum a step. A few steps of one size are made
between two looks of the host at the state.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from warpsph_kernels.structure import DAMPING, STEP
from warpsph_kernels.structure_survey import FAULTS, FLATTENING, SPEED, STIFFENING, WORST

from warpsph.particles.launch import Replay
from warpsph.particles.state import host_view, write_array
from warpsph.physics.structure import SUB_STEPS, arrays_in
from warpsph.scene.schema import Scene
from warpsph.solver.contact_step import ContactStepper
from warpsph.solver.rigid_motion import RigidState
from warpsph.solver.rigid_step import RigidStepper
from warpsph.solver.stability import largest_frequency
from warpsph.solver.structure_assembly import StructureParts
from warpsph.solver.system import StepReport
from warpsph.solver.time_laws import TimeLaws

STIFFNESS_GRADE = 1.1
"""Ratio of two stiffnesses between which the step does not tell a difference."""
UNEVEN = 0.75
"""Part of its own step that a structure makes in a fluid, whose steps change in size: at omega dt = 1.6 steps that go
to and fro by 5 % multiply the energy of the fastest waves within a few thousand, at 1.2 they leave it as it is."""
SMALL = 4000
"""Particles up to which the launches of a step cost about as much as what they compute, so that it is replayed."""
SHORTEST = 1000.0
"""By how much a step may be shortened where the state has changed faster than was foreseen."""
TURN = 0.1
"""Angle [rad] by which a rigid body may turn in a step, or its phase where forces could make it swing."""


@dataclass(frozen=True)
class Kept:
    """A state to which a stepper can return: arrays, and what contact, rigid bodies and the stepper remember."""

    arrays: Mapping[str, np.ndarray]
    contact: Mapping[str, np.ndarray]
    rigid: tuple[RigidState, ...]
    time: float
    extremes: np.ndarray


class StructureStepper:
    """Advances structures in time."""

    def __init__(self, scene: Scene, parts: StructureParts) -> None:
        self._model = parts.model
        self._contact = ContactStepper(parts.contact) if parts.contact else None
        self._rigid = RigidStepper(parts.rigid, scene.gravity) if parts.rigid else None
        self._cfl = scene.numerics.structure.cfl * (UNEVEN if scene.fluids else 1.0)
        self._max_step = scene.time.max_step or math.inf
        self._end = scene.time.end
        self._laws = TimeLaws(parts)
        self._extremes = np.zeros(5)
        self.time = 0.0
        self.target = math.inf
        self.stuck = False
        self.steps_made = 0
        alone = self._contact is None and self._rigid is None
        self._is_small = alone and parts.model.count <= SMALL and parts.model.launcher.device.is_cpu
        self._replay: Replay | None = None

    def start(self) -> None:
        """Measure the stability limit at rest, then find the forces of the initial state."""
        self._set_clock(0.0)
        self.frequency = largest_frequency(self._model) if self._is_flexible or self._contact else 0.0
        self._laws.write(self.time)
        if self._rigid:
            self._rigid.start()
        self.find_forces()

    def find_forces(self) -> None:
        """Bring stresses, forces and extremes to the time of the displacement."""
        self._set_clock(0.0)
        self._model.strain()
        if self._contact:
            self._contact.start()
        self._model.accelerate()
        if self._rigid:
            self._rigid.find_forces(self.time)
        self.survey()

    def find_forces_again(self) -> None:
        """Bring stresses and extremes to the time of a state that has been restored with its accelerations."""
        self.find_stresses()
        self.survey()

    def find_stresses(self) -> None:
        """Bring stresses to the time of a state that has been restored with its accelerations."""
        self._set_clock(0.0)
        self._model.strain()
        if self._rigid:
            self._rigid.find_forces(self.time)

    def step(self) -> StepReport:
        """Make a few steps of one size; if they were too long after all, shorter ones to the same time."""
        kept = self.keep_state()
        dt, planned, limit = self.choose_step()
        self.begin(dt, planned)
        count = self.allowed(dt, planned)
        limit = limit if count == planned else "contact"
        end = self.target if limit == "frame" else self.time + count * dt
        self.make_steps(count)
        before = self.extremes["speed"]
        self.survey()
        if self.failed or self.is_unstable(dt) or not self.listed(before, dt, count):
            self.return_to(kept)
            count = self.step_with_care(end, dt / SHORTEST)
        else:
            self.time = end
        return StepReport(dt, limit, count)

    def step_with_care(self, end: float, shortest: float) -> int:
        """Go on to a time [s] with a look at the state after every step; return the number of steps.

        Stops before that time when the state has failed, or does not allow even the shortest step [s].
        """
        self.find_forces_again()
        count = 0
        while self.time < end and not self.failed:
            left = math.ceil((end - self.time) / self.stable_step * (1.0 - 1e-9))
            dt = (end - self.time) / max(left, 1)
            self.stuck = left > 1 and dt < shortest
            self.begin(dt, 1)
            self.allowed(dt, 1)
            self.sub_step()
            before = self.extremes["speed"]
            self.survey()
            self.listed(before, dt, 1)
            self.time = end if left <= 1 else self.time + dt
            count += 1
        return count

    def allowed(self, dt: float, count: int) -> int:
        """How many of `count` steps, begun already, the lists of contact will do for; makes new ones if need be."""
        return self._contact.allow(self.extremes["speed"], dt, count) if self._contact else count

    def listed(self, before: float, dt: float, count: int) -> bool:
        """Whether the lists of contact were complete in the steps made, from the largest speed before [m/s] and now."""
        speed = max(before, self.extremes["speed"])
        return self._contact is None or self._contact.note(speed, dt, count)

    def make_steps(self, count: int) -> None:
        """Advance by so many steps of the size that was begun with."""
        if self._replay:
            self._replay.run(count)
            return
        for _ in range(count):
            self.sub_step()
        if self._is_small:
            self._replay = Replay(self._model.launcher, "structure steps", self.sub_step)

    def sub_step(self) -> None:
        """Advance by one step of the size that was begun with."""
        self.move()
        self._model.tick()

    def move(self) -> None:
        """Advance by one step; time laws stand."""
        self._model.drift()
        if self._rigid:
            self._rigid.drift()
        self._model.strain()
        if self._contact:
            self._contact.push()
        self._model.accelerate()
        if self._rigid:
            self._rigid.kick()

    def choose_step(self) -> tuple[float, int, str]:
        """Size [s], number and limit of the next steps: as the stiffness of the present state allows.

        All steps up to the time to land on have one size. A size that changes to and fro would pump energy into the
        fastest waves, for which a step is a large part of their period.
        """
        limits = self.limits | {"max_step": self._max_step}
        limit = min(limits, key=lambda name: limits[name])
        dt = limits[limit]
        left = self.target - self.time
        if math.isinf(left):
            return min(dt, self._end), SUB_STEPS, limit
        count = max(math.ceil(left / dt * (1.0 - 1e-9)), 1)
        return left / count, min(count, SUB_STEPS), "frame" if count <= SUB_STEPS else limit

    @property
    def stable_step(self) -> float:
        """The step that the present state allows [s]; infinite where nothing limits it."""
        return min(self.limits.values())

    @property
    def limits(self) -> dict[str, float]:
        """The steps that the present state allows [s], by what limits them.

        Elastic: cfl 2 / omega of the flexible structures, stiffened by contact; contact: the same of the material whose
        stiffness contact has, where all structures are rigid; rotation: what turns rigid bodies by a small angle. The
        stiffness is rounded up to a power of STIFFNESS_GRADE, so that the step seldom changes.
        """
        stiffening = max(float(self._extremes[STIFFENING]), 1.0)
        grade = math.ceil(math.log(stiffening) / math.log(STIFFNESS_GRADE) - 1e-3)
        square = self.frequency**2 * STIFFNESS_GRADE**grade
        if self._contact:
            square = self._contact.raised(square)
        limits = {"elastic" if self._is_flexible else "contact": _over(self._cfl * 2.0, math.sqrt(square))}
        return limits | ({"rotation": _over(TURN, self._rigid.quickest())} if self._rigid else {})

    @property
    def _is_flexible(self) -> bool:
        """Whether some structure is not rigid."""
        return self._rigid is None or self._rigid.count < self._model.count

    def is_unstable(self, dt: float) -> bool:
        """Whether a step [s] is beyond the stability limit of the present state."""
        return dt * self.frequency * math.sqrt(max(self._extremes[STIFFENING], 1.0)) > 2.0

    def begin(self, dt: float, count: int) -> None:
        """Set the step size, and the values of time laws for so many steps to come."""
        self._set_clock(dt)
        self._laws.write(self.time, dt, count)
        if self._rigid:
            self._rigid.begin(self.time, dt)

    def survey(self) -> None:
        """Find the extremes of the state."""
        self._model.survey()
        table = host_view(self._model.scratch.extremes)
        self._extremes = table.max(axis=0)
        self._extremes[WORST] = table[int(np.argmax(table[:, FLATTENING])), WORST]
        self._extremes[FAULTS] = table[:, FAULTS].sum()

    @property
    def extremes(self) -> Mapping[str, float]:
        """Largest speed [m/s], largest stiffening [1] and least J, negated [1]; with contact the penetration [m]."""
        touching = {"penetration": self._contact.depth} if self._contact else {}
        return {
            "speed": math.sqrt(self._extremes[SPEED]),
            "stiffening": float(self._extremes[STIFFENING]),
            "flattening": float(self._extremes[FLATTENING]),
            **touching,
        }

    @property
    def failed(self) -> bool:
        """Whether some particle is inverted or not finite, or would need steps too short to go on."""
        return bool(self.stuck or self.faults or self._extremes[FLATTENING] >= 0.0)

    @property
    def faults(self) -> int:
        """Particles that are not finite."""
        return int(self._extremes[FAULTS])

    @property
    def flattest(self) -> int:
        """The particle with the least J."""
        return int(self._extremes[WORST])

    def keep_state(self) -> Kept:
        """The present state, to which one may return."""
        return Kept(
            arrays={name: np.array(host_view(a)) for name, a in arrays_in(self._model.state).items()},
            contact=self._contact.memory() if self._contact else {},
            rigid=self._rigid.states if self._rigid else (),
            time=self.time,
            extremes=self._extremes.copy(),
        )

    def return_to(self, kept: Kept) -> None:
        """Go back to a state; stresses and time laws stay where they are."""
        for name, array in arrays_in(self._model.state).items():
            write_array(array, kept.arrays[name])
        self.time, self.stuck, self._extremes = kept.time, False, kept.extremes.copy()
        if self._contact:
            self._contact.remember(kept.contact)
        if self._rigid:
            self._rigid.return_to(kept.rigid)

    def look_ahead(self, time: float) -> np.ndarray:
        """Displacements [m] at a later time [s], if all that acts on the structures goes on; the state stays."""
        kept = self.keep_state()
        self.advance(time)
        ahead = np.array(host_view(self._model.state.displacement))
        self.return_to(kept)
        self._laws.write(self.time)
        self.find_stresses()
        return ahead

    def advance(self, time: float) -> None:
        """Make the steps to a time [s], or fewer if the state fails."""
        self.target = time
        while self.time < time and not self.failed:
            self.steps_made += self.step().count

    def _set_clock(self, dt: float, damping: float = 0.0) -> None:
        values = np.zeros(3)
        values[STEP], values[DAMPING] = dt, damping
        write_array(self._model.clock, values)

    def save(self) -> dict[str, Any]:
        """The stepper's own part of a checkpoint."""
        own: dict[str, Any] = {"time": self.time, "frequency": self.frequency}
        own |= self._rigid.save() if self._rigid else {}
        return own | (self._contact.save() if self._contact else {})

    def load(self, saved: Mapping[str, Any]) -> None:
        """Go on from what `save` returned; the state's arrays have been restored."""
        self.time, self.frequency = float(saved["time"]), float(saved["frequency"])
        self._laws.write(self.time)
        self.find_forces_again()
        if self._rigid:
            self._rigid.load(saved, self.time)
        if self._contact:
            self._contact.load(saved)

    def rigid_motion(self) -> dict[str, np.ndarray]:
        """How rigid bodies move, see `RigidStepper.motion`; none without them."""
        return self._rigid.motion() if self._rigid else {}


def _over(value: float, rate: float) -> float:
    """A value over a rate, infinite where the rate is zero."""
    return value / rate if rate > 0.0 else math.inf
