"""Pressure that a gauge in a wall or a structure measures."""

import numpy as np

from warpsph.frame import Frame, SetFrame
from warpsph.probes.probe import Probe
from warpsph.probes.smoothing import Smoothing
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.probes import WallPressureProbe as WallPressureSpec
from warpsph.scene.schema import Scene

OCCUPIED = 0.85
"""A place holds a particle if one is nearer than this many spacings."""


class WallPressureProbe(Probe):
    """Mean pressure of the surface particles of a wall or structure within the radius of the gauge at the start.

    A particle lies at the surface if the place one spacing before it is empty, looking along the normal that the wall
    particles around it give, and if the gauge is before it, not behind (Marrone et al. 2010, for free surfaces). The
    first layer lies half a spacing behind the surface: where it is wet, rho g over this way is taken off. The gauge
    moves with its wall. Particles of a dry wall carry no pressure, so there the gauge reads zero.
    """

    def __init__(self, name: str, spec: WallPressureSpec, scene: Scene) -> None:
        needs = dict.fromkeys(("boundary", "structure"), ("id", "position", "pressure"))
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._name = name
        self._spec = spec
        self._spacing = scene.spacing
        self._reach = Smoothing.of(scene).support_radius
        density = next(iter(scene.fluids.values())).density
        self._weight = density * np.array(scene.gravity)
        self._ids = np.empty(0, dtype=np.int64)
        self._head = np.empty(0)

    def start(self, frame: Frame) -> None:
        """Choose the particles; SceneError if there are none within the radius."""
        wall = frame.set_named(self._spec.solid)
        distance = np.linalg.norm(wall.fields["position"] - np.array(self._spec.at), axis=1)
        chosen, normals = self._surface(wall, np.flatnonzero(distance <= self._spec.radius))
        if not len(chosen):
            raise SceneError([self._too_small(wall, distance)])
        order = np.argsort(wall.fields["id"][chosen])
        self._ids = np.array(wall.fields["id"][chosen])[order]
        self._head = (0.5 * self._spacing * normals @ self._weight)[order]

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """The pressure [Pa]."""
        if not len(self._ids):
            raise ValueError("start() comes before evaluate()")
        fields = frame.set_named(self._spec.solid).fields
        chosen = np.flatnonzero(np.isin(fields["id"], self._ids))
        pressure = fields["pressure"][chosen[np.argsort(fields["id"][chosen])]].astype(np.float64)
        return (float(np.mean(np.where(pressure == 0.0, 0.0, pressure + self._head))),)

    def _surface(self, wall: SetFrame, candidates: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Which of the candidates lie at the surface before which the gauge is, and their normals."""
        position = wall.fields["position"]
        normals = np.array([self._normal(position, index) for index in candidates])
        if not len(candidates):
            return candidates, normals
        ahead = position[candidates] + self._spacing * normals
        gaps = np.array([np.linalg.norm(position - place, axis=1).min() for place in ahead])
        before = np.einsum("ij,ij->i", np.array(self._spec.at) - position[candidates], normals) > 0.0
        kept = (gaps >= OCCUPIED * self._spacing) & before
        return candidates[kept], normals[kept]

    def _normal(self, position: np.ndarray, index: int) -> np.ndarray:
        """Unit vector away from the wall particles around one of them."""
        away = position[index] - position
        distance = np.linalg.norm(away, axis=1)
        weight = np.maximum(1.0 - distance / self._reach, 0.0) ** 3
        total = weight @ away
        return total / max(float(np.linalg.norm(total)), 1e-300)

    def _too_small(self, wall: SetFrame, distance: np.ndarray) -> Problem:
        message = f"no surface particle of {self._spec.solid!r} lies this close to the gauge"
        near = np.flatnonzero(distance <= distance.min() + self._reach) if len(distance) else distance
        surface, _ = self._surface(wall, np.asarray(near, dtype=np.int64))
        nearest = (
            f"at least {distance[surface].min():.6g} m, the distance of the nearest" if len(surface) else ""
        )
        return Problem.at(f"probes.{self._name}.radius", message, nearest, self._spec.radius)
