"""Prescribed motion of walls as a function of time, with exact derivatives."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import reduce

import numpy as np

from warpsph.sampling.sets import SampledSet
from warpsph.sampling.time_laws import Displacement, displacement_of
from warpsph.scene.motion import Motion
from warpsph.scene.placement import cross_matrix, rotation_matrix
from warpsph.scene.schema import Scene

_SPEED_SAMPLES = 1000
_GOLDEN_RATIO = (np.sqrt(5.0) - 1.0) / 2.0


@dataclass(frozen=True)
class Pose:
    """Where a rigid body is and how it moves: its point first at X is at x = rotation @ X + translation.

    rotation: (d, d); translation: (d,) [m]; its velocity: (d,) [m/s] and acceleration: (d,) [m/s2], those of
    the body's point X = 0; angular_velocity: (3,) [rad/s]; angular_acceleration: (3,) [rad/s2]. d is the
    dimension; in 2D the angular vectors point along z.
    """

    rotation: np.ndarray
    translation: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    angular_velocity: np.ndarray
    angular_acceleration: np.ndarray

    def position_of(self, points: np.ndarray) -> np.ndarray:
        """Positions (n, d) [m] of the body's points, which were at `points` (n, d) [m] first."""
        return points @ self.rotation.T + self.translation

    def velocity_of(self, points: np.ndarray) -> np.ndarray:
        """Velocities (n, d) [m/s] of the body's points: v = omega x (R X) + velocity."""
        return self.velocity + _cross(self.angular_velocity, points @ self.rotation.T)

    def acceleration_of(self, points: np.ndarray) -> np.ndarray:
        """Accelerations (n, d) [m/s2]: a = d(omega)/dt x (R X) + omega x (omega x (R X)) + acceleration."""
        arm = points @ self.rotation.T
        centripetal = _cross(self.angular_velocity, _cross(self.angular_velocity, arm))
        return self.acceleration + _cross(self.angular_acceleration, arm) + centripetal

    def derivatives(self) -> dict[str, np.ndarray]:
        """A and b of x = A X + b with their first and second time derivatives, named as on the device.

        dA/dt = [omega] A and d2A/dt2 = ([d(omega)/dt] + [omega] [omega]) A with the matrices of the cross products.
        """
        dim = len(self.translation)
        spin, growth = cross_matrix(self.angular_velocity), cross_matrix(self.angular_acceleration)
        return {
            "rotation": self.rotation,
            "shift": self.translation,
            "rotation_rate": spin[:dim, :dim] @ self.rotation,
            "shift_rate": self.velocity,
            "rotation_acceleration": (growth + spin @ spin)[:dim, :dim] @ self.rotation,
            "shift_acceleration": self.acceleration,
        }

    def after(self, first: Pose) -> Pose:
        """This motion applied to a body that `first` has moved already (both in three dimensions).

        Differentiating x = R2 (R1 X + b1) + b2 twice gives the Coriolis term 2 omega2 x (R2 db1/dt) and, in
        the angular acceleration, omega2 x (R2 omega1).
        """
        r2, omega2 = self.rotation, self.angular_velocity
        carried = r2 @ first.angular_velocity
        relative = r2 @ first.velocity
        return Pose(
            rotation=r2 @ first.rotation,
            translation=self.position_of(first.translation),
            velocity=self.velocity_of(first.translation) + relative,
            acceleration=self.acceleration_of(first.translation)
            + 2.0 * _cross(omega2, relative)
            + r2 @ first.acceleration,
            angular_velocity=omega2 + carried,
            angular_acceleration=self.angular_acceleration
            + _cross(omega2, carried)
            + r2 @ first.angular_acceleration,
        )

    def in_dimension(self, dimension: int) -> Pose:
        """The same pose with vectors of that dimension; plane motions only where it is 2."""
        return Pose(
            self.rotation[:dimension, :dimension],
            self.translation[:dimension],
            self.velocity[:dimension],
            self.acceleration[:dimension],
            self.angular_velocity,
            self.angular_acceleration,
        )


RigidMotion = Callable[[float], Pose]
"""The pose of a body at a time [s]; the first position is that of time zero."""


def rigid_motions(scene: Scene) -> dict[str, RigidMotion]:
    """The motion of every boundary that moves, by its name.

    Raises SceneError where the file of a table cannot be used.
    """
    return {
        name: rigid_motion(scene, boundary.motion, f"boundaries.{name}.motion")
        for name, boundary in scene.boundaries.items()
        if boundary.motion
    }


def rigid_motion(scene: Scene, motions: Sequence[Motion], key: str) -> RigidMotion:
    """Motions one after the other, centres and axes fixed in space; `key` is where they stand in the scene.

    Raises SceneError where the file of a table cannot be used.
    """
    displacements = [
        displacement_of(motion, scene.base_directory, f"{key}.{index}")
        for index, motion in enumerate(motions)
    ]

    def pose_at(time: float) -> Pose:
        steps = (_pose(displacement, time) for displacement in displacements)
        return reduce(lambda moved, step: step.after(moved), steps).in_dimension(scene.dimension)

    return pose_at


def largest_speed(scene: Scene, sets: Sequence[SampledSet]) -> float:
    """Largest speed [m/s] that a wall particle reaches during the run, to about a per cent.

    Times are spread by the golden ratio, so that no periodic motion can hide between them.
    """
    motions = rigid_motions(scene)
    times = scene.time.end * (np.arange(_SPEED_SAMPLES) * _GOLDEN_RATIO % 1.0)
    speeds = [0.0]
    for moving in (sampled for sampled in sets if sampled.name in motions):
        corners = _corners(moving.position)
        for time in times:
            velocity = motions[moving.name](time).velocity_of(corners)
            speeds.append(float(np.linalg.norm(velocity, axis=1).max()))
    return max(speeds)


def _pose(step: Displacement, time: float) -> Pose:
    """Pose of a rotation about the step's centre followed by its translation: x = R (X - c) + c + d."""
    angle, rate, growth = step.angle(time)
    shift, velocity, acceleration = step.translation(time)
    about_center = Pose(
        rotation_matrix(angle, step.axis, 3),
        step.center + shift,
        velocity,
        acceleration,
        rate * step.axis,
        growth * step.axis,
    )
    return replace(
        about_center,
        translation=about_center.position_of(-step.center),
        velocity=about_center.velocity_of(-step.center),
        acceleration=about_center.acceleration_of(-step.center),
    )


def _cross(omega: np.ndarray, arms: np.ndarray) -> np.ndarray:
    """omega x arm for arms (..., d); in 2D omega points along z and the arms lie across it."""
    dimension = arms.shape[-1]
    return arms @ cross_matrix(omega)[:dimension, :dimension].T


def _corners(points: np.ndarray) -> np.ndarray:
    """Corners (2^d, d) of the box around the points; no point of the box is faster than all of them."""
    ends = np.stack([points.min(axis=0), points.max(axis=0)], axis=1)
    return np.stack(np.meshgrid(*ends, indexing="ij"), axis=-1).reshape(-1, points.shape[1])
