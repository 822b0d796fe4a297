"""Motion of one rigid body, in double precision and always in three dimensions.

A body is given by a point of it, its origin: the centre of mass, or a pivot that stays where it is. With the momentum
m v and the angular momentum L about the origin, forces f_a and R the rotation since the start,

    m dv/dt = sum f_a + m g,    dL/dt = sum R r_a x f_a + m R d x g,    L = R I R^T omega,

r_a and d being the arms of the particles and of the centre of mass at rest. In the plane only x, y and the rotation
about z are free.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from warpsph.sampling.kinematics import Pose, RigidMotion

LARGEST_TURN = 0.1
"""Angle [rad] that one rotation turns at most; the error of energy in a step is about a hundredth of its square."""
ITERATIONS = 30
"""Of the midpoint's angular velocity; each gains a digit or more."""
PRECISION = 1e-15


@dataclass(frozen=True)
class RigidBody:
    """What never changes of a body.

    first, count: its particles; mass: m [kg]; origin: (3,) at rest [m]; offset: d (3,) [m]; inertia: I (3, 3) about the
    origin at rest [kg m2]; moves, turns: (3,) whether translation along and rotation about each axis are free;
    motion: of what is not, None where it is held.
    """

    name: str
    first: int
    count: int
    mass: float
    origin: np.ndarray
    offset: np.ndarray
    inertia: np.ndarray
    moves: np.ndarray
    turns: np.ndarray
    motion: RigidMotion | None

    @cached_property
    def axes(self) -> np.ndarray:
        """Indices of the axes about which it is free to turn."""
        return np.flatnonzero(self.turns)

    @cached_property
    def compliance(self) -> np.ndarray:
        """Inverse of I (3, 3)."""
        return np.linalg.inv(self.inertia)

    @cached_property
    def least_moment(self) -> float:
        """Smallest moment of inertia of all axes [kg m2]."""
        return float(np.linalg.eigvalsh(self.inertia)[0])


@dataclass(frozen=True)
class RigidState:
    """Where a body is and how it moves.

    position, velocity: (3,) of its origin [m], [m/s]; attitude: unit quaternion (w, x, y, z) of R; angular_momentum: L
    of the free axes (3,) [kg m2/s]; spin: angular velocity (3,) [rad/s] where the rotation is prescribed, else zero;
    angle: (3,) integral of the angular velocity [rad].
    """

    position: np.ndarray
    velocity: np.ndarray
    attitude: np.ndarray
    angular_momentum: np.ndarray
    spin: np.ndarray
    angle: np.ndarray


@dataclass(frozen=True)
class RigidForces:
    """What acts on a body.

    force: without gravity (3,) [N]; moment: tensor sum r_a (x) f_a (3, 3) [N m]; gravity: g (3,) [m/s2].
    """

    force: np.ndarray
    moment: np.ndarray
    gravity: np.ndarray

    def total(self, body: RigidBody) -> np.ndarray:
        """Force with gravity (3,) [N]."""
        return self.force + body.mass * self.gravity

    def torque(self, body: RigidBody, rotation: np.ndarray) -> np.ndarray:
        """Torque about the origin (3,) [N m] of a body turned by `rotation`."""
        turned = rotation @ self.moment
        own = np.array(
            [turned[1, 2] - turned[2, 1], turned[2, 0] - turned[0, 2], turned[0, 1] - turned[1, 0]]
        )
        return own + body.mass * cross(rotation @ body.offset, self.gravity)


def kicked(body: RigidBody, state: RigidState, forces: RigidForces, dt: float) -> RigidState:
    """The free momenta after forces have acted for a time [s]."""
    torque = forces.torque(body, rotation_of(state.attitude))
    return replace(
        state,
        velocity=state.velocity + dt / body.mass * body.moves * forces.total(body),
        angular_momentum=state.angular_momentum + dt * body.turns * torque,
    )


def drifted(body: RigidBody, state: RigidState, time: float, dt: float) -> RigidState:
    """The body after a step [s] of free flight that ends at a time [s], with its other axes as prescribed."""
    position = state.position + dt * body.moves * state.velocity
    state = replace(state, position=position)
    if body.turns.any():
        state = _turned(body, state, dt)
    return prescribed(body, state, time)


def prescribed(body: RigidBody, state: RigidState, time: float) -> RigidState:
    """The body with all axes that are not free as they are at a time [s]."""
    if body.motion is None:
        return state
    pose = in_space(body.motion(time))
    place, velocity = pose.position_of(body.origin), pose.velocity_of(body.origin)
    state = replace(
        state,
        position=np.where(body.moves, state.position, place),
        velocity=np.where(body.moves, state.velocity, velocity),
    )
    if body.turns.any():
        return state
    attitude = quaternion_of(pose.rotation)
    return replace(
        state,
        attitude=attitude,
        spin=pose.angular_velocity,
        angle=state.angle + _rotation_vector(_product(attitude, _inverse(state.attitude))),
    )


def holding_power(body: RigidBody, state: RigidState, forces: RigidForces, time: float) -> float:
    """Power [W] of what moves the prescribed axes: of the forces missing to the prescribed accelerations."""
    if body.motion is None:
        return 0.0
    pose = in_space(body.motion(time))
    missing = body.mass * pose.acceleration_of(body.origin) - forces.total(body)
    power = float(missing @ np.where(body.moves, 0.0, state.velocity))
    if body.turns.any():
        return power
    rotation = rotation_of(state.attitude)
    inertia, spin = rotation @ body.inertia @ rotation.T, state.spin
    change = inertia @ pose.angular_acceleration + cross(spin, inertia @ spin)
    return power + float((change - forces.torque(body, rotation)) @ spin)


def angular_velocity(body: RigidBody, state: RigidState) -> np.ndarray:
    """Angular velocity (3,) [rad/s]."""
    return state.spin + _free_spin(body, state.attitude, state.angular_momentum)


def kinetic_energy(body: RigidBody, state: RigidState) -> float:
    """Kinetic energy [J] of a body about its centre of mass or a pivot at rest."""
    rotation, spin = rotation_of(state.attitude), angular_velocity(body, state)
    turning = spin @ rotation @ body.inertia @ rotation.T @ spin
    return float(0.5 * body.mass * state.velocity @ state.velocity + 0.5 * turning)


def quickness(body: RigidBody, state: RigidState, forces: RigidForces) -> float:
    """How fast the body may turn, or swing under forces of the moment tensor M [rad/s]: sqrt(2 |M| / I)."""
    if not body.turns.any():
        return 0.0
    arm = forces.moment + body.mass * np.outer(body.offset, forces.gravity)
    swing = math.sqrt(2.0 * float(np.linalg.norm(arm)) / least_inertia(body, state))
    return max(fastest_turn(body, state), swing)


def fastest_turn(body: RigidBody, state: RigidState) -> float:
    """Largest angular velocity [rad/s] that the body can reach with its angular momentum, |L| / I.

    In free flight it stays the same: steps that followed the angular velocity itself would let the energy drift.
    """
    return float(np.linalg.norm(state.angular_momentum)) / least_inertia(body, state)


def least_inertia(body: RigidBody, state: RigidState) -> float:
    """Moment of inertia about the only free axis, or the smallest of all axes [kg m2]."""
    if len(body.axes) > 1:
        return body.least_moment
    axis = rotation_of(state.attitude)[body.axes[0]]
    return float(axis @ body.inertia @ axis)


def pose_of(body: RigidBody, state: RigidState, dimension: int) -> Pose:
    """Place and velocity of the body in the scene's dimension, without accelerations."""
    rotation, spin = rotation_of(state.attitude), angular_velocity(body, state)
    arm = rotation @ body.origin
    nothing = np.zeros(3)
    place, velocity = state.position - arm, state.velocity - cross(spin, arm)
    return Pose(rotation, place, velocity, nothing, spin, nothing).in_dimension(dimension)


def in_space(pose: Pose) -> Pose:
    """A pose of the plane with vectors of three components."""
    missing = 3 - len(pose.translation)
    rotation = np.eye(3)
    rotation[: 3 - missing, : 3 - missing] = pose.rotation
    place, velocity, acceleration = (
        np.pad(vector, (0, missing)) for vector in (pose.translation, pose.velocity, pose.acceleration)
    )
    return Pose(rotation, place, velocity, acceleration, pose.angular_velocity, pose.angular_acceleration)


def rotation_of(attitude: np.ndarray) -> np.ndarray:
    """Matrix (3, 3) of a unit quaternion (w, x, y, z)."""
    w, x, y, z = attitude
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def quaternion_of(rotation: np.ndarray) -> np.ndarray:
    """Unit quaternion (w, x, y, z) of a rotation matrix, from its largest component (Shepperd 1978)."""
    xx, yy, zz = np.diag(rotation)
    squares = np.array([1.0 + xx + yy + zz, 1.0 + xx - yy - zz, 1.0 - xx + yy - zz, 1.0 - xx - yy + zz])
    w = np.array(
        [rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]]
    )
    both = rotation + rotation.T
    products = np.array(
        [
            [squares[0], *w],
            [w[0], squares[1], both[0, 1], both[0, 2]],
            [w[1], both[0, 1], squares[2], both[1, 2]],
            [w[2], both[0, 2], both[1, 2], squares[3]],
        ]
    )
    row = products[int(np.argmax(squares))]
    return row / np.linalg.norm(row)


def _turned(body: RigidBody, state: RigidState, dt: float) -> RigidState:
    """The body after its free rotation for a time [s], in parts of at most LARGEST_TURN."""
    spin = _free_spin(body, state.attitude, state.angular_momentum)
    parts = max(math.ceil(dt * fastest_turn(body, state) / LARGEST_TURN), 1)
    attitude, angle = state.attitude, state.angle
    for _ in range(parts):
        spin = _middle_spin(body, attitude, state.angular_momentum, dt / parts, spin)
        attitude = _product(_exponential(dt / parts * spin), attitude)
        attitude = attitude / np.linalg.norm(attitude)
        angle = angle + dt / parts * spin
    return replace(state, attitude=attitude, angle=angle)


def _middle_spin(
    body: RigidBody, attitude: np.ndarray, momentum: np.ndarray, dt: float, guess: np.ndarray
) -> np.ndarray:
    """Angular velocity (3,) that belongs to L and to the attitude that it leads to in half the time.

    The rule is symmetric in time and of second order: the energy oscillates but does not drift, and L is kept exactly.
    """
    spin = guess
    for _ in range(ITERATIONS):
        middle = _product(_exponential(0.5 * dt * spin), attitude)
        better = _free_spin(body, middle, momentum)
        change, size = float(np.abs(better - spin).max()), float(np.abs(better).max())
        spin = better
        if change <= PRECISION * size:
            break
    return spin


def _free_spin(body: RigidBody, attitude: np.ndarray, momentum: np.ndarray) -> np.ndarray:
    """omega (3,) of the free axes: those rows and columns of R I R^T omega = L; about all others there is none."""
    free, spin = body.axes, np.zeros(3)
    if not len(free):
        return spin
    rotation = rotation_of(attitude)
    if len(free) == len(spin):
        return rotation @ (body.compliance @ (rotation.T @ momentum))
    inertia = rotation @ body.inertia @ rotation.T
    spin[free] = np.linalg.solve(inertia[np.ix_(free, free)], momentum[free])
    return spin


def _product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Quaternion of the rotation b followed by a."""
    w, x, y, z = a
    return np.array([[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]]) @ b


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """a x b of two vectors (3,)."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def _inverse(a: np.ndarray) -> np.ndarray:
    return a * np.array([1.0, -1.0, -1.0, -1.0])


def _exponential(turn: np.ndarray) -> np.ndarray:
    """Quaternion of a rotation vector (3,) [rad]."""
    x, y, z = turn
    angle = math.hypot(x, y, z)
    share = math.sin(0.5 * angle) / angle if angle > 0.0 else 0.5
    return np.array([math.cos(0.5 * angle), share * x, share * y, share * z])


def _rotation_vector(attitude: np.ndarray) -> np.ndarray:
    """Rotation vector (3,) [rad] of a unit quaternion, of length pi at most."""
    sine = float(np.linalg.norm(attitude[1:]))
    if sine == 0.0:
        return np.zeros(3)
    half = math.atan2(sine, abs(attitude[0]))
    return math.copysign(2.0, attitude[0]) * half / sine * attitude[1:]
