"""How far a prescribed motion has gone at a time, and its first and second derivative."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import singledispatch
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline, make_interp_spline

from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.motion import Linear, Motion, Sinusoid, Sliding, SteadyRotation, Table
from warpsph.scene.tables import TableError, read_columns
from warpsph.scene.types import AXES

Law = Callable[[float], np.ndarray]
"""Value, first and second derivative at a time [s], along the first axis."""


@dataclass(frozen=True)
class Displacement:
    """A rotation about a fixed point, then a translation, over time; all vectors have three components.

    angle: (3,) [rad], [rad/s], [rad/s2]; translation: (3, 3) [m], [m/s], [m/s2]; axis: (3,), of length one;
    center: (3,) [m].
    """

    angle: Law
    translation: Law
    axis: np.ndarray
    center: np.ndarray


@singledispatch
def displacement_of(motion: Motion, base_directory: Path, key: str) -> Displacement:
    """The displacement that a motion of a scene prescribes, zero at time zero.

    Raises SceneError at the motion's `key` where the file of a table cannot be used.
    """
    raise TypeError(f"no displacement is defined for {type(motion).__name__}")


@displacement_of.register
def _(motion: Sinusoid, base_directory: Path, key: str) -> Displacement:
    amplitude = np.deg2rad(motion.rotation or 0.0)
    return Displacement(
        angle=lambda time: amplitude * _oscillation(motion, time),
        translation=lambda time: np.outer(_oscillation(motion, time), _in_space(motion.translation)),
        axis=_unit_axis(motion.axis),
        center=_in_space(motion.center),
    )


@displacement_of.register
def _(motion: Linear, base_directory: Path, key: str) -> Displacement:
    return Displacement(
        angle=_nothing,
        translation=lambda time: np.outer(_time_in_motion(motion, time), _in_space(motion.velocity)),
        axis=_unit_axis(None),
        center=np.zeros(3),
    )


@displacement_of.register
def _(motion: Sliding, base_directory: Path, key: str) -> Displacement:
    """No displacement at all, and yet a velocity: the second row without the first."""
    velocity_only = np.array([0.0, 1.0, 0.0])
    return Displacement(
        angle=_nothing,
        translation=lambda time: np.outer(
            velocity_only * _time_in_motion(motion, time), _in_space(motion.velocity)
        ),
        axis=_unit_axis(None),
        center=np.zeros(3),
    )


@displacement_of.register
def _(motion: SteadyRotation, base_directory: Path, key: str) -> Displacement:
    rate = np.deg2rad(motion.rate)
    return Displacement(
        angle=lambda time: rate * _time_in_motion(motion, time),
        translation=_no_translation,
        axis=_unit_axis(motion.axis),
        center=_in_space(motion.center),
    )


@displacement_of.register
def _(motion: Table, base_directory: Path, key: str) -> Displacement:
    columns = motion.translation or {}
    names = [motion.time, *columns.values(), *([motion.rotation] if motion.rotation else [])]
    time, *values = _read(base_directory / motion.file, names, f"{key}.file", motion.file)
    laws = [_interpolation(time, value, motion.interpolation) for value in values]
    moved = [AXES.index(axis) for axis in columns]

    def translation(at: float) -> np.ndarray:
        result = np.zeros((3, 3))
        for axis, law in zip(moved, laws, strict=False):
            result[:, axis] = law(at)
        return result

    return Displacement(
        angle=(lambda at: np.deg2rad(laws[-1](at))) if motion.rotation else _nothing,
        translation=translation,
        axis=_unit_axis(motion.axis),
        center=_in_space(motion.center),
    )


def _oscillation(motion: Sinusoid, time: float) -> np.ndarray:
    """ramp * (sin(omega tau + phase) - sin(phase)) with tau = time - start, and its derivatives."""
    tau = time - motion.start
    if tau < 0.0:
        return np.zeros(3)
    omega, phase = 2.0 * np.pi * motion.frequency, np.deg2rad(motion.phase)
    sine, cosine = np.sin(omega * tau + phase), np.cos(omega * tau + phase)
    f, df, ddf = sine - np.sin(phase), omega * cosine, -(omega**2) * sine
    r, dr, ddr = smooth_ramp(tau, motion.ramp)
    return np.array([r * f, dr * f + r * df, ddr * f + 2.0 * dr * df + r * ddf])


def smooth_ramp(tau: float, duration: float) -> tuple[float, float, float]:
    """10 s^3 - 15 s^4 + 6 s^5 with s = tau / duration, then 1: no step in value, slope or curvature."""
    if tau >= duration:
        return 1.0, 0.0, 0.0
    s = tau / duration
    slope, curvature = 30.0 * s**2 * (1.0 - s) ** 2, 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s**2), slope / duration, curvature / duration**2


def _time_in_motion(motion: Linear | Sliding | SteadyRotation, time: float) -> np.ndarray:
    end = np.inf if motion.end is None else motion.end
    moving = motion.start <= time < end
    return np.array([np.clip(time, motion.start, end) - motion.start, float(moving), 0.0])


def _interpolation(time: np.ndarray, value: np.ndarray, kind: str) -> Law:
    """Law through a table, counted from time zero; at rest before the first and after the last row."""
    curve = CubicSpline(time, value) if kind == "cubic" else make_interp_spline(time, value, k=1)
    start = curve(np.clip(0.0, time[0], time[-1]))

    def law(at: float) -> np.ndarray:
        reached = float(curve(np.clip(at, time[0], time[-1])) - start)
        if not time[0] <= at <= time[-1]:
            return np.array([reached, 0.0, 0.0])
        return np.array([reached, curve(at, 1), curve(at, 2) if kind == "cubic" else 0.0])

    return law


def _read(path: Path, names: Sequence[str], key: str, file: str) -> tuple[np.ndarray, ...]:
    allowed = f"a CSV file with the columns {', '.join(names)} and at least two rows in the order of time"
    try:
        columns = read_columns(path, names)
    except TableError as error:
        raise SceneError([Problem.at(key, str(error), allowed, file)]) from error
    time = columns[0]
    if len(time) < 2:
        raise SceneError([Problem.at(key, "one row is no motion", allowed, file)])
    backwards = np.flatnonzero(np.diff(time) <= 0.0)
    if len(backwards):
        before, after = time[backwards[0]], time[backwards[0] + 1]
        message = f"the time does not increase from {before:g} s to {after:g} s"
        raise SceneError([Problem.at(key, message, allowed, file)])
    return columns


def _nothing(time: float) -> np.ndarray:
    return np.zeros(3)


def _no_translation(time: float) -> np.ndarray:
    return np.zeros((3, 3))


def _unit_axis(axis: Sequence[float] | None) -> np.ndarray:
    direction = np.array([0.0, 0.0, 1.0] if axis is None else axis)
    return direction / np.linalg.norm(direction)


def _in_space(vector: Sequence[float] | None) -> np.ndarray:
    """A vector of the scene with three components; zero where there is none."""
    return np.pad(np.array(vector or (), dtype=np.float64), (0, 3 - len(vector or ())))
