"""One step of fluids and structures together, as a page of verbs.

The fluid makes one step of its own size; structures make as many within it as they need. The force between them is
found once, in the middle of the step, where the fluid finds its own, and both sides receive it over the whole step:
momentum is conserved to rounding.

Densities follow at the end of the step from the velocities there. Of structures the fluid sees the mean velocity
(Zhang, Rezavand & Hu 2021), over a step that is centred there: from the middle of this step to that of the next, half a
step ahead, which the structures make under the present force and take back. A mean over the step that has been made
would be half a step old, and the velocity of the moment is that of vibrations much faster than the step: both feed
energy to a structure.
"""

from __future__ import annotations

import math
from dataclasses import replace

from warpsph.physics.faces import HALF_STEP, NOW
from warpsph.scene.schema import Scene
from warpsph.solver.face_assembly import FaceParts
from warpsph.solver.step import Stepper
from warpsph.solver.structure_step import StructureStepper
from warpsph.solver.system import StepReport

GRADE = 1.05
"""Ratio of two sizes between which the step does not tell a difference."""
GROWTH = 3
"""Grades by which a longer step must be allowed before it is made. So the step seldom changes: for the fastest waves of
a structure one that goes to and fro is a source of energy."""
LIGHT_STEP, LIGHT_POWER = 0.5, 0.6
"""The step of the fluid beside a structure is at most this part of the time that sound takes across a smoothing length,
times this power of the ratio of their densities: see `inertial_step`."""


class CoupledStepper:
    """Advances fluids and structures in time; both have been started."""

    def __init__(
        self,
        scene: Scene,
        fluid: Stepper,
        structure: StructureStepper,
        parts: FaceParts,
        inertial_step: float,
    ) -> None:
        """`inertial_step` is the longest that light structures allow [s], see the function `inertial_step`."""
        sub_steps = scene.coupling.sub_steps
        self._fluid, self._structure = fluid, structure
        self.inertial_step = inertial_step
        self._walls, self._faces = parts.model, parts.faces
        self._most_sub_steps = math.inf if sub_steps == "auto" else sub_steps
        self.target = math.inf
        self.lead = 0.0
        self.size = 0.0

    def step(self) -> StepReport:
        """Advance by one step of the fluid."""
        report, made_before = self.choose_step(), self._structure.steps_made
        self._fluid.keep_lists(report.dt)
        self._fluid.move_walls(self._fluid.time - 0.5 * report.dt)
        self._faces.place(HALF_STEP)
        self._fluid.find_forces()
        self.push_structures()
        self._fluid.advance()
        self.advance_structures(report.dt)
        self._fluid.move_walls(self._fluid.time)
        self._faces.place(NOW)
        self._fluid.find_densities()
        return replace(report, sub_steps=self._structure.steps_made - made_before)

    def choose_step(self) -> StepReport:
        """As long as the fluid allows, and as the structures do where their steps are counted.

        All steps up to the time to land on have one size, unless the limit changes meanwhile.
        """
        begin = self._fluid.time
        dt, limit = self._longest_step()
        left = self.target - begin
        if math.isfinite(left):
            steps = max(math.ceil(left / dt * (1.0 - 1e-9)), 1)
            dt = left / steps
            limit = "frame" if steps == 1 else limit
        end = self.target if limit == "frame" else begin + dt
        self._fluid.set_clock(STEP=dt, TIME=end)
        return StepReport(dt, limit)

    def _longest_step(self) -> tuple[float, str]:
        fluid = self._fluid.choose_step()
        limits = {fluid.limit: fluid.dt}
        if self._faces.meet_fluid:
            limits["added_mass"] = self.inertial_step
        if math.isfinite(self._most_sub_steps):
            limits["structure"] = self._most_sub_steps * self._structure.stable_step
        limit = min(limits, key=lambda name: limits[name])
        return self._steady(limits[limit]) if self._faces.meet_fluid else limits[limit], limit

    def _steady(self, longest: float) -> float:
        """A size of at most that [s] that seldom changes."""
        allowed = GRADE ** math.floor(math.log(longest) / math.log(GRADE))
        if not self.size <= allowed < 0.99 * GRADE**GROWTH * self.size:
            self.size = allowed
        return self.size

    def push_structures(self) -> None:
        """Hand the forces of the fluid to the structures."""
        self._walls.react()
        self._faces.push()

    def advance_structures(self, dt: float) -> None:
        """Let the structures catch up with the fluid after a step [s], and show it how they move."""
        now, lead = self._fluid.time, 0.5 * dt
        self._faces.keep_places()
        self._structure.advance(now)
        if self._faces.looks_ahead:
            ahead = self._structure.look_ahead(now + lead)
            self._faces.show_motion_to(ahead, lead, window=dt - self.lead + lead)
            self.lead = lead
        else:
            self._faces.show_motion(dt)
            self.lead = 0.0


def inertial_step(density_ratio: float, smoothing_length: float, sound_speed: float) -> float:
    """The longest step of the fluid [s] beside a structure of that density over the fluid's [1].

    A plate of mass m an area rests on compressible fluid as on a spring K, of the order of rho c^2 over the smoothing
    length. The force of the fluid is held over its step dt, in which a mode of the plate swings by theta = omega dt,
    and, where the fluid sees the velocity at the end, the eigenvalues of this map are 1 and a pair of product 1 and sum
    2 cos(theta) - kappa sin(theta), kappa = K dt^2 / (m theta): a little below each multiple of pi the mode grows, by
    up to kappa / 2 a step, and a structure that makes many steps in one of the fluid has modes there. What the fluid
    dissipates outweighs that while K dt^2 / m is small enough, hence about the root of the ratio. The two numbers bound
    what did not grow, but for rare resonances, at ratios from 0.03 to 1 and over two decades of stiffness
    (docs/coupling.md). The centred mean narrows the resonances. One shared step has no such modes.
    """
    return LIGHT_STEP * density_ratio**LIGHT_POWER * smoothing_length / sound_speed
