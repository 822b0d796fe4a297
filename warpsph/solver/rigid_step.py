"""Rigid bodies within the step of structures.

The halves of the velocity Verlet step are those of the other particles: the momenta are kicked by the forces at both
ends of the step, and in between the body flies freely. Forces are summed on the device and read after every step, so
that a step of rigid bodies is one look of the host at a few numbers.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Any

import numpy as np

from warpsph.sampling.kinematics import Pose
from warpsph.solver.rigid_assembly import RigidParts
from warpsph.solver.rigid_motion import (
    RigidBody,
    RigidForces,
    RigidState,
    angular_velocity,
    cross,
    drifted,
    holding_power,
    kicked,
    pose_of,
    quickness,
    rotation_of,
)

MOTION = ("position", "velocity", "angle", "angular_velocity", "force", "torque")
"""What `motion` returns, three components each."""


class RigidStepper:
    """Advances the rigid bodies among structures."""

    def __init__(self, parts: RigidParts, gravity: tuple[float, ...]) -> None:
        self._bodies, self._model = parts.bodies, parts.model
        self._dim = len(gravity)
        self._gravity = np.pad(np.asarray(gravity, dtype=np.float64), (0, 3 - self._dim))
        self._states = list(parts.initial)
        self._forces: list[RigidForces] = []
        self._power = np.zeros(len(self._bodies))
        self._time, self._dt = 0.0, 0.0

    @property
    def count(self) -> int:
        """Particles of rigid bodies."""
        return sum(body.count for body in self._bodies)

    def start(self) -> None:
        """Bring the particles to where their bodies are."""
        self._model.carry(self._poses())

    def begin(self, time: float, dt: float) -> None:
        """The coming steps begin at a time and have this size [s], with the accelerations that there are now."""
        self._dt = dt
        self._sense(time)

    def drift(self) -> None:
        """Advance the velocities over half a step and the bodies over the whole, and their particles with them."""
        half, end = 0.5 * self._dt, self._time + self._dt
        self._kick(half)
        self._states = [drifted(b, s, end, self._dt) for b, s in zip(self._bodies, self._states, strict=True)]
        self._time = end
        self._model.carry(self._poses())

    def kick(self) -> None:
        """Sum the forces at the end of the step, and advance the velocities over its second half."""
        half, before = 0.5 * self._dt, self._power
        self._sum_forces()
        self._kick(half)
        self._find_power()
        mass = np.array([body.mass for body in self._bodies])
        poses = self._poses()
        self._model.settle(poses, half * (before + self._power) / mass)
        self._model.turn(poses)

    def find_forces(self, time: float) -> None:
        """Sum the forces at the particles' present accelerations, of a time [s]; their strain has just been found."""
        self._sense(time)
        self._model.turn(self._poses())

    def quickest(self) -> float:
        """The largest angular velocity, or frequency of swinging, of all bodies [rad/s]."""
        together = zip(self._bodies, self._states, self._forces, strict=True)
        return max((quickness(*one) for one in together), default=0.0)

    def motion(self) -> dict[str, np.ndarray]:
        """How each body moves, by name: a row of three components for each of MOTION (6, 3).

        Position [m] and velocity [m/s] of the centre of mass; angle [rad], the integral of the angular velocity
        [rad/s]; and the force [N] and the torque [N m] about the centre of mass of all but what holds the body.
        """
        together = zip(self._bodies, self._states, self._forces, strict=True)
        return {body.name: self._motion(body, state, forces) for body, state, forces in together}

    @property
    def states(self) -> tuple[RigidState, ...]:
        """How the bodies move, to return to."""
        return tuple(self._states)

    def return_to(self, states: Sequence[RigidState]) -> None:
        """Go back to how the bodies moved."""
        self._states = list(states)

    def save(self) -> dict[str, Any]:
        """The rigid bodies' part of a checkpoint: each quantity of all bodies in one array."""
        names = [member.name for member in fields(RigidState)]
        return {f"rigid_{name}": np.array([getattr(s, name) for s in self._states]) for name in names}

    def load(self, saved: Mapping[str, Any], time: float) -> None:
        """Go on from what `save` returned at a time [s]; the state of the structures has been restored."""
        columns = [np.asarray(saved[f"rigid_{member.name}"]) for member in fields(RigidState)]
        self._states = [RigidState(*(column[k] for column in columns)) for k in range(len(self._bodies))]
        self.find_forces(time)

    def _motion(self, body: RigidBody, state: RigidState, forces: RigidForces) -> np.ndarray:
        rotation, spin = rotation_of(state.attitude), angular_velocity(body, state)
        arm = rotation @ body.offset
        force = forces.total(body)
        torque = forces.torque(body, rotation) - cross(arm, force)
        velocity = state.velocity + cross(spin, arm)
        return np.array([state.position + arm, velocity, state.angle, spin, force, torque])

    def _poses(self) -> list[Pose]:
        return [pose_of(b, s, self._dim) for b, s in zip(self._bodies, self._states, strict=True)]

    def _kick(self, dt: float) -> None:
        together = zip(self._bodies, self._states, self._forces, strict=True)
        self._states = [kicked(body, state, forces, dt) for body, state, forces in together]

    def _sense(self, time: float) -> None:
        self._time = time
        self._sum_forces()
        self._find_power()

    def _sum_forces(self) -> None:
        count, dim = len(self._bodies), self._dim
        force, moment = np.zeros((count, 3)), np.zeros((count, 3, 3))
        force[:, :dim], moment[:, :dim, :dim] = self._model.sums()
        self._forces = [RigidForces(f, m, self._gravity) for f, m in zip(force, moment, strict=True)]

    def _find_power(self) -> None:
        together = zip(self._bodies, self._states, self._forces, strict=True)
        self._power = np.array([holding_power(*one, self._time) for one in together])
