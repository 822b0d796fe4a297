"""A perspective camera that frames a box."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

AZIMUTH, ELEVATION, FIELD_OF_VIEW = 25.0, 18.0, 28.0
"""Default view [deg]: from the front, a little to the right and from above, with a moderately long lens."""


@dataclass(frozen=True)
class Camera:
    """Position [m], the rows right, up and forward of its rotation, and the focal length in pixels."""

    eye: np.ndarray
    axes: np.ndarray
    focal: float
    width: int
    height: int

    def view(self, points: np.ndarray) -> np.ndarray:
        """Points (n, 3) in camera axes: right, up, depth [m]."""
        return (points - self.eye) @ self.axes.T

    def project(self, points: np.ndarray) -> np.ndarray:
        """Points (n, 3) in the world to (n, 3): column and row in pixels (row 0 on top) and depth [m]."""
        right, up, depth = self.view(points).T
        scale = self.focal / depth
        return np.stack([0.5 * self.width + scale * right, 0.5 * self.height - scale * up, depth], axis=1)

    def magnified(self, factor: int) -> Camera:
        """The same view with `factor` times as many pixels in either direction."""
        return replace(
            self, focal=factor * self.focal, width=factor * self.width, height=factor * self.height
        )


def look_direction(azimuth: float, elevation: float, up_axis: int) -> np.ndarray:
    """Rows right, up, forward of a camera that stands at these angles [deg] around the up axis.

    Azimuth 0 looks along the horizontal axis that is not x, so that x points right; it grows as the camera
    moves right.
    """
    up = np.eye(3)[up_axis]
    right_at_zero = np.eye(3)[0]
    forward_at_zero = np.cross(up, right_at_zero)
    a, e = np.radians([azimuth, elevation])
    horizontal = np.cos(a) * forward_at_zero - np.sin(a) * right_at_zero
    forward = np.cos(e) * horizontal - np.sin(e) * up
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(right, forward), forward])


def frame_box(
    low: np.ndarray,
    high: np.ndarray,
    size: tuple[int, int],
    *,
    up_axis: int,
    azimuth: float = AZIMUTH,
    elevation: float = ELEVATION,
    margin: float = 0.05,
) -> Camera:
    """The nearest camera in that direction that sees the whole box [m] with a margin on every side."""
    width, height = size
    axes = look_direction(azimuth, elevation, up_axis)
    focal = 0.5 * max(size) / np.tan(np.radians(FIELD_OF_VIEW) / 2.0)
    corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T
    right, up, forward = ((corners - (low + high) / 2.0) @ axes.T).T
    slope_x = (0.5 - margin) * width / focal
    slope_y = (0.5 - margin) * height / focal
    x, distance_x = _fit(right, forward, slope_x)
    y, distance_y = _fit(up, forward, slope_y)
    eye = (low + high) / 2.0 + np.array([x, y, -max(distance_x, distance_y)]) @ axes
    return Camera(eye, axes, focal, width, height)


def _fit(across: np.ndarray, forward: np.ndarray, slope: float) -> tuple[float, float]:
    """Sideways shift and distance of the eye at which both extreme rays touch the points.

    A point is seen if |across - shift| <= slope (forward + distance): two half-planes in (shift, distance).
    """
    right_most = np.max(across - slope * forward)
    left_most = np.max(-across - slope * forward)
    return (right_most - left_most) / 2.0, (right_most + left_most) / (2.0 * slope)
