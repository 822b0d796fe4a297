"""Sums of mechanics that several probes take."""

import numpy as np


def cross(arm: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Arm cross force: (n, 1) about z in the plane, (n, 3) in space."""
    if arm.shape[1] == 2:
        return arm[:, :1] * force[:, 1:] - arm[:, 1:] * force[:, :1]
    return np.cross(arm, force)


def resultant(position: np.ndarray, force: np.ndarray, about: np.ndarray) -> tuple[float, ...]:
    """Components of the force [N], then of its torque [N m] about a point; in the plane per metre of depth."""
    force = np.asarray(force, dtype=np.float64)
    torque = cross(position - about, force)
    return (*map(float, force.sum(axis=0)), *map(float, torque.sum(axis=0)))
