"""Which places lie behind the surface of a wall, where fluid must not be."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from warpsph.sampling.distance import signed_distance
from warpsph.sampling.kinematics import RigidMotion, rigid_motions
from warpsph.sampling.walls import beyond_open_faces, layer_count
from warpsph.scene.schema import Boundary, Scene
from warpsph.scene.shapes import Plane


class BehindWalls:
    """Tells places more than a spacing behind the surface of a wall, wherever its motion has put it.

    That far behind it the first layer of its particles ends; into a notch of that layer, as where a structure begins,
    fluid may be pressed.

    Behind an obstacle is its inside. Behind a tank, or a plane of some extent, are its layers, since farther out there
    may be other tanks; but what is outside of all tanks, and not before an open face of one, is behind the nearest.
    """

    def __init__(self, scene: Scene) -> None:
        self._spacing = scene.spacing
        self._walls = dict(scene.boundaries)
        self._motions: Mapping[str, RigidMotion] = rigid_motions(scene)
        self._tanks = [name for name, wall in self._walls.items() if _is_tank(wall)]
        # Layers thinner than the support have no inside where fluid could be told from fluid before them.
        self._thickness = {
            name: max(layer_count(wall, scene) * scene.spacing, scene.support_radius)
            for name, wall in self._walls.items()
            if _is_tank(wall) or _is_bounded(wall)
        }

    def rows(self, points: np.ndarray, time: float) -> dict[str, np.ndarray]:
        """Rows of the points (n, dim) [m] that lie behind each wall at a time [s]."""
        depths = {name: self._depth(name, points, time) for name in self._walls}
        behind = {name: depth > self._spacing for name, depth in depths.items()}
        for name, thickness in self._thickness.items():
            behind[name] &= depths[name] < thickness - 0.5 * self._spacing
        if self._tanks:
            outside = np.stack([depths[name] for name in self._tanks])
            lost, nearest = outside.min(axis=0) > self._spacing, outside.argmin(axis=0)
            for k, name in enumerate(self._tanks):
                behind[name] |= lost & (nearest == k)
        return {name: np.flatnonzero(found) for name, found in behind.items()}

    def _depth(self, name: str, points: np.ndarray, time: float) -> np.ndarray:
        """How far (n,) [m] points are behind the surface; infinitely far before it where there is no wall."""
        wall, rest = self._walls[name], self._at_rest(name, points, time)
        distance = signed_distance(wall.shape, rest)
        depth = distance if wall.side == "outside" else -distance
        return np.where(_has_no_wall(wall, rest, distance), -np.inf, depth)

    def _at_rest(self, name: str, points: np.ndarray, time: float) -> np.ndarray:
        """Where the points would be if the wall had not moved."""
        if name not in self._motions:
            return points
        pose = self._motions[name](time)
        return (points - pose.translation) @ pose.rotation


def _is_tank(wall: Boundary) -> bool:
    return wall.side == "outside" and not isinstance(wall.shape, Plane)


def _is_bounded(wall: Boundary) -> bool:
    return isinstance(wall.shape, Plane) and wall.shape.bounds is not None


def _has_no_wall(wall: Boundary, points: np.ndarray, distance: np.ndarray) -> np.ndarray:
    """Which points (n, dim) [m] are beyond an open face or beside the extent of a plane."""
    bare = beyond_open_faces(points, wall, 0.0) if wall.open else np.zeros(len(points), dtype=bool)
    if isinstance(wall.shape, Plane) and wall.shape.bounds is not None:
        normal = np.array(wall.shape.normal) / np.linalg.norm(wall.shape.normal)
        foot, across = points - distance[:, None] * normal, np.abs(normal) < 1.0 - 1e-6
        low, high = np.array(wall.shape.bounds.min), np.array(wall.shape.bounds.max)
        bare |= (((foot < low) | (foot > high)) & across).any(axis=1)
    return bare
