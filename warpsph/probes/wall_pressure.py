"""Pressure that a gauge in a wall measures."""

import numpy as np

from warpsph.frame import Frame
from warpsph.probes.probe import Probe
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.probes import WallPressureProbe as WallPressureSpec
from warpsph.scene.schema import Scene


class WallPressureProbe(Probe):
    """Mean pressure of the wall particles that lie within the radius of the gauge's centre at the start.

    The gauge moves with its wall. Particles of a dry wall carry no pressure, so there the gauge reads zero.
    """

    def __init__(self, name: str, spec: WallPressureSpec, scene: Scene) -> None:
        needs = {"boundary": ("id", "position", "pressure")}
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._name = name
        self._spec = spec
        self._ids: np.ndarray | None = None

    def start(self, frame: Frame) -> None:
        """Choose the particles; SceneError if there are none within the radius."""
        wall = frame.set_named(self._spec.boundary)
        distance = np.linalg.norm(wall.fields["position"] - np.array(self._spec.at), axis=1)
        within = distance <= self._spec.radius
        if not within.any():
            raise SceneError([self._too_small(distance)])
        self._ids = np.array(wall.fields["id"][within])

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """The pressure [Pa]."""
        if self._ids is None:
            raise ValueError("start() comes before evaluate()")
        fields = frame.set_named(self._spec.boundary).fields
        return (float(np.mean(fields["pressure"][np.isin(fields["id"], self._ids)], dtype=np.float64)),)

    def _too_small(self, distance: np.ndarray) -> Problem:
        message = f"no particle of {self._spec.boundary!r} lies this close to the gauge"
        nearest = f"at least {distance.min():.6g} m, the distance of the nearest" if len(distance) else ""
        return Problem.at(f"probes.{self._name}.radius", message, nearest, self._spec.radius)
