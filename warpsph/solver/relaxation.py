"""Static equilibrium of structures by dynamic relaxation."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from warpsph.particles.state import host_view
from warpsph.physics.structure import SUB_STEPS
from warpsph.scene.schema import Scene
from warpsph.scene.structures import StaticSolution
from warpsph.solver.structure_assembly import StructureParts
from warpsph.solver.structure_step import StructureStepper
from warpsph.solver.system import StepReport

RAMP_STEPS = 8 * SUB_STEPS
"""Steps over which loads and clamps go from their last values to the next: a jump of a clamp by several spacings would
stiffen the particles beside it more than the step allows."""


class NotConverged(RuntimeError):
    """An equilibrium was not reached within the steps that the scene allows."""


class RelaxationStepper(StructureStepper):
    """Advances from equilibrium to equilibrium: pseudo-time steps at the loads of the time to land on.

    The motion is damped critically in its slowest mode, whose frequency is the Rayleigh quotient of what has changed
    lately (Underwood 1983, adaptive dynamic relaxation). Every other mode then decays as fast. The least quotient of
    one equilibrium counts: near the end nothing but rounding changes, whose frequency is that of the shortest waves.
    """

    def __init__(self, scene: Scene, parts: StructureParts) -> None:
        super().__init__(scene, parts)
        solution = scene.numerics.structure.solution
        assert isinstance(solution, StaticSolution)
        self._solution = solution
        self._mass = parts.mass[:, None]
        self._free = host_view(parts.model.reference.free).astype(np.float64)
        self._slowest = math.inf
        self._made = 0
        self.residual, self.remaining = math.inf, math.inf

    def step(self) -> StepReport:
        """Make a few pseudo-time steps; the time moves on when they have converged.

        Raises:
            NotConverged: if one equilibrium takes more steps than allowed.
        """
        kept = self.keep_state()
        before = kept.arrays
        at = self.target if math.isfinite(self.target) else self.time
        ramp = min((self._made + SUB_STEPS) / RAMP_STEPS, 1.0) if self._model.has_time_laws else 1.0
        dt = self.stable_step
        self._laws.write(self.time + ramp * (at - self.time))
        count = self._relax(SUB_STEPS, dt)
        if self.failed or self.is_unstable(dt):
            self.return_to(kept)
            self.find_forces_again()
            count = self._relax_with_care()
        self._made += count
        if self._model.has_time_laws and self._made <= RAMP_STEPS + SUB_STEPS:
            self._slowest = math.inf  # what has changed so far came from the loads in part
        self._estimate_frequency(before["displacement"], before["acceleration"])
        if ramp == 1.0 and self._converged():
            self.time, self._made, self._slowest = at, 0, math.inf
        elif self._made >= self._solution.max_steps:
            raise NotConverged(self._complaint(at))
        return StepReport(dt, "relaxation", count)

    def _relax(self, steps: int, dt: float) -> int:
        """Make damped steps of a size [s] at standing loads, then look at the state; return how many.

        They are fewer where the lists of contact would not do for all.
        """
        self._set_clock(dt, 2.0 * min(self._slowest, self.frequency))
        steps = self.allowed(dt, steps)
        for _ in range(steps):
            self.move()
        before = self.extremes["speed"]
        self.survey()
        self.listed(before, dt, steps)
        return steps

    def _relax_with_care(self) -> int:
        """As many steps with a look after each, as far as the state does not fail; return how many."""
        for made in range(SUB_STEPS):
            self._relax(1, self.stable_step)
            if self.failed:
                return made + 1
        return SUB_STEPS

    def save(self) -> dict[str, Any]:
        return super().save() | {"slowest": self._slowest, "made": self._made}

    def load(self, saved: Mapping[str, Any]) -> None:
        super().load(saved)
        self._slowest, self._made = float(saved["slowest"]), int(saved["made"])

    def _estimate_frequency(self, displacement: np.ndarray, acceleration: np.ndarray) -> None:
        """omega^2 = -sum m da . du / sum m du . du of what has changed."""
        state = self._model.state
        du = (host_view(state.displacement) - displacement) * self._free
        da = (host_view(state.acceleration) - acceleration) * self._free
        moved = float(np.sum(self._mass * du * du))
        stiffness = -float(np.sum(self._mass * da * du))
        if moved > 0.0 and stiffness > 0.0:
            self._slowest = min(self._slowest, math.sqrt(stiffness / moved))

    def _converged(self) -> bool:
        """Whether the unbalanced force and the motion that is left are below the tolerance.

        A critically damped mode of frequency omega at the speed v is v / omega away from its rest, late in its decay.
        """
        state = self._model.state
        acceleration = host_view(state.acceleration)
        unbalanced = _norm(self._mass * acceleration * self._free)
        balanced = _norm(self._mass * acceleration * (1.0 - self._free)) + self._external()
        speed, shift = _norm(host_view(state.velocity) * self._free), _norm(host_view(state.displacement))
        tiny = np.finfo(float).tiny
        self.residual = unbalanced / max(balanced, tiny)
        self.remaining = speed / self._slowest / max(shift, tiny) if speed > 0.0 else 0.0
        return max(self.residual, self.remaining) < self._solution.tolerance

    def _external(self) -> float:
        """Norm of gravity and loads at the present factors [N]."""
        model = self._model
        specific = np.tile(np.asarray(model.gravity), (len(self._mass), 1))
        factors = host_view(model.scratch.load_factor)[0]
        for k in range(model.options.loads):
            specific = specific + factors[k] * host_view(model.reference.load)[k]
        return _norm(self._mass * specific)

    def _complaint(self, at: float) -> str:
        return (
            f"no equilibrium at t = {at:g} s after {self._made} steps: the unbalanced force is {self.residual:.2g} "
            f"of the acting forces and the motion left {self.remaining:.2g} of the displacement, where "
            f"numerics.structure.solution.tolerance is {self._solution.tolerance:g}. Allow more max_steps "
            "or a larger tolerance; a structure that is not held has no equilibrium"
        )


def _norm(values: np.ndarray) -> float:
    return float(np.sqrt(np.sum(values * values)))
