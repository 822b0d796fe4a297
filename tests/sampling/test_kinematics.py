"""Rigid motion: composition, and velocities and accelerations that are the derivatives of positions."""

from typing import Any

import numpy as np
import pytest
from sampling.tank_scenes import box, make_scene

from warpsph.sampling import sample
from warpsph.sampling.kinematics import RigidMotion, largest_speed, rigid_motion, rigid_motions
from warpsph.scene.schema import Scene

HEAVE = {"type": "sinusoid", "translation": [0.1, 0.3], "frequency": 0.8, "phase": 30.0, "ramp": 0.5}
PITCH = {"type": "sinusoid", "rotation": 25.0, "center": [0.2, 0.1], "frequency": 1.1}
SPIN = {"type": "rotation", "rate": 100.0, "center": [1.0, 0.0]}
DRIFT = {"type": "linear", "velocity": [0.5, -0.2]}

HEAVE_3D = {**HEAVE, "translation": [0.1, 0.3, -0.2]}
PITCH_3D = {**PITCH, "center": [0.2, 0.1, 0.0], "axis": [1.0, 2.0, 0.5]}
SPIN_3D = {**SPIN, "center": [1.0, 0.0, 0.3], "axis": [0.0, -1.0, 1.0]}
DRIFT_3D = {"type": "linear", "velocity": [0.5, -0.2, 0.1]}

COMPOSED = {
    "rotation then translation": [PITCH, HEAVE],
    "translation then rotation": [DRIFT, SPIN],
    "two rotations and two translations": [SPIN, HEAVE, PITCH, DRIFT],
    "in space": [PITCH_3D, DRIFT_3D, SPIN_3D, HEAVE_3D],
}


def moving(motions: list[dict[str, Any]], **more: Any) -> Scene:
    dimension = 3 if any(len(m.get("velocity", m.get("center", (0, 0)))) == 3 for m in motions) else 2
    body = {"shape": box([0.0] * dimension, [0.5] * dimension), "side": "solid", "motion": motions}
    water = box([5.0] * dimension, [6.0] * dimension)
    return make_scene(0.25, {"water": water}, {"body": body}, dimension=dimension, **more)


def motion_of(motions: list[dict[str, Any]]) -> RigidMotion:
    scene = moving(motions)
    return rigid_motion(scene, scene.boundaries["body"].motion, "boundaries.body.motion")


@pytest.mark.parametrize("motions", COMPOSED.values(), ids=COMPOSED)
@pytest.mark.parametrize("time", [0.2, 0.9, 2.3])
def test_velocity_and_acceleration_are_derivatives_of_the_position(
    motions: list[dict[str, Any]], time: float
) -> None:
    """Central differences with a step of 1e-4 s; their error is step^2 / 6 times a jerk below 1e4 m/s3."""
    motion, step = motion_of(motions), 1e-4
    dimension = len(motion(0.0).translation)
    points = np.random.default_rng(3).uniform(-1.0, 1.0, (10, dimension))
    before, now, after = motion(time - step), motion(time), motion(time + step)
    velocity = (after.position_of(points) - before.position_of(points)) / (2.0 * step)
    acceleration = (after.velocity_of(points) - before.velocity_of(points)) / (2.0 * step)
    assert now.velocity_of(points) == pytest.approx(velocity, abs=2e-5)
    assert now.acceleration_of(points) == pytest.approx(acceleration, abs=2e-4)


@pytest.mark.parametrize("motions", COMPOSED.values(), ids=COMPOSED)
def test_bodies_stay_rigid_and_start_where_they_are(motions: list[dict[str, Any]]) -> None:
    motion = motion_of(motions)
    rotation = motion(1.7).rotation
    assert rotation @ rotation.T == pytest.approx(np.eye(len(rotation)), abs=1e-13)
    assert np.linalg.det(rotation) == pytest.approx(1.0)
    assert motion(0.0).rotation == pytest.approx(np.eye(len(rotation)))
    assert motion(0.0).translation == pytest.approx(np.zeros(len(rotation)), abs=1e-15)


def test_motions_apply_in_order_with_centres_fixed_in_space() -> None:
    """A quarter turn about (1, 0) after moving one metre up, and before."""
    up = {"type": "linear", "velocity": [0.0, 1.0], "end": 1.0}
    turn = {"type": "rotation", "rate": 90.0, "center": [1.0, 0.0], "end": 1.0}
    corner = np.zeros((1, 2))
    assert motion_of([up, turn])(5.0).position_of(corner)[0] == pytest.approx([0.0, -1.0])
    assert motion_of([turn, up])(5.0).position_of(corner)[0] == pytest.approx([1.0, 0.0])


def test_velocity_of_a_steady_rotation_by_hand() -> None:
    pose = motion_of([{"type": "rotation", "rate": 180.0, "center": [1.0, 0.0]}])(0.5)
    assert pose.angular_velocity == pytest.approx([0.0, 0.0, np.pi])
    assert pose.position_of(np.zeros((1, 2)))[0] == pytest.approx([1.0, -1.0])
    assert pose.velocity_of(np.zeros((1, 2)))[0] == pytest.approx([np.pi, 0.0])
    assert pose.acceleration_of(np.zeros((1, 2)))[0] == pytest.approx([0.0, np.pi**2])


def test_only_boundaries_with_motions_move() -> None:
    fixed = {"shape": box([0.0, 0.0], [1.0, 1.0]), "side": "solid"}
    moved = {"shape": box([2.0, 0.0], [3.0, 1.0]), "side": "solid", "motion": [DRIFT]}
    scene = make_scene(0.25, {"water": box([5.0, 5.0], [6.0, 6.0])}, {"a": fixed, "b": moved}, dimension=2)
    assert list(rigid_motions(scene)) == ["b"]


def test_largest_speed_of_a_rotating_box_is_that_of_its_farthest_particle() -> None:
    scene = moving([{"type": "rotation", "rate": 180.0, "center": [0.0, 0.0]}])
    assert largest_speed(scene, sample(scene)) == pytest.approx(np.pi * np.hypot(0.375, 0.375))


@pytest.mark.parametrize("frequency", [0.1, 1.0, 1000.0])
def test_largest_speed_of_an_oscillation_is_found_whatever_its_frequency(frequency: float) -> None:
    motion = {"type": "sinusoid", "translation": [0.1, 0.0], "frequency": frequency}
    scene = moving([motion], time={"end": 10.0, "frame_rate": 1.0})
    assert largest_speed(scene, sample(scene)) == pytest.approx(0.2 * np.pi * frequency, rel=0.01)


def test_nothing_moves_without_motions() -> None:
    scene = moving([])
    assert largest_speed(scene, sample(scene)) == 0.0
