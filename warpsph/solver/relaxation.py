"""Static equilibrium of structures by dynamic relaxation."""

from __future__ import annotations

import math

import numpy as np

from warpsph.particles.state import host_view
from warpsph.physics.structure import SUB_STEPS
from warpsph.scene.schema import Scene
from warpsph.scene.structures import StaticSolution
from warpsph.solver.structure_assembly import StructureParts
from warpsph.solver.structure_step import StructureStepper
from warpsph.solver.system import StepReport


class NotConverged(RuntimeError):
    """An equilibrium was not reached within the steps that the scene allows."""


class RelaxationStepper(StructureStepper):
    """Advances from equilibrium to equilibrium: pseudo-time steps at the loads of the time to land on.

    The motion is damped critically in its slowest mode, whose frequency is the Rayleigh quotient of the latest
    change of the state (Underwood 1983, adaptive dynamic relaxation). Every other mode then decays as fast.
    """

    def __init__(self, scene: Scene, parts: StructureParts) -> None:
        super().__init__(scene, parts)
        solution = scene.numerics.structure.solution
        assert isinstance(solution, StaticSolution)
        self._solution = solution
        self._mass = parts.mass[:, None]
        self._free = host_view(parts.model.reference.free).astype(np.float64)
        self._slowest = 0.0
        self._made = 0
        self.residual, self.remaining = math.inf, math.inf

    def step(self) -> StepReport:
        """Make a few pseudo-time steps; the time moves on when they have converged.

        Raises:
            NotConverged: if one equilibrium takes more steps than allowed.
        """
        self.keep_state()
        before = self._before
        at = self.target if math.isfinite(self.target) else self.time
        dt = self.stable_step
        self._set_clock(dt, 2.0 * self._slowest)
        self._laws.write(at, 0.0)
        for _ in range(SUB_STEPS):
            self._model.drift()
            self._model.strain()
            self._model.accelerate()
        self.survey()
        self._made += SUB_STEPS
        self._estimate_frequency(before["displacement"], before["acceleration"])
        if self._converged():
            self.time, self._made = at, 0
        elif self._made >= self._solution.max_steps:
            raise NotConverged(self._complaint(at))
        return StepReport(dt, "relaxation", SUB_STEPS)

    def _estimate_frequency(self, displacement: np.ndarray, acceleration: np.ndarray) -> None:
        """omega^2 = -sum m da . du / sum m du . du of what has changed."""
        state = self._model.state
        du = (host_view(state.displacement) - displacement) * self._free
        da = (host_view(state.acceleration) - acceleration) * self._free
        moved = float(np.sum(self._mass * du * du))
        stiffness = -float(np.sum(self._mass * da * du))
        if moved > 0.0 and stiffness > 0.0:
            self._slowest = min(math.sqrt(stiffness / moved), self.frequency)

    def _converged(self) -> bool:
        """Whether the unbalanced force and the motion that it could still cause are below the tolerance."""
        state = self._model.state
        acceleration = host_view(state.acceleration)
        unbalanced = _norm(self._mass * acceleration * self._free)
        balanced = _norm(self._mass * acceleration * (1.0 - self._free)) + self._external()
        speed, shift = _norm(host_view(state.velocity) * self._free), _norm(host_view(state.displacement))
        if self._slowest == 0.0 or shift == 0.0:
            self.residual = self.remaining = 0.0 if unbalanced == 0.0 else math.inf
        else:
            self.residual = unbalanced / max(balanced, np.finfo(float).tiny)
            still = _norm(acceleration * self._free) / self._slowest**2 + speed / self._slowest
            self.remaining = still / shift
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
