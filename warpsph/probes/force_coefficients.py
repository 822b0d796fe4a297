"""Drag, lift and moment coefficients of bodies in a flow."""

import numpy as np

from warpsph.frame import Frame
from warpsph.probes.mechanics import cross
from warpsph.probes.probe import Probe
from warpsph.scene.probes import ForceCoefficientsProbe as ForceCoefficientsSpec
from warpsph.scene.schema import Scene


class ForceCoefficientsProbe(Probe):
    """Forces and moment of the fluid on several walls and structures together, over those of the dynamic pressure.

    The viscous part is that of the viscous pair forces; what is left of a coefficient is that of the pressure.
    """

    def __init__(self, name: str, spec: ForceCoefficientsSpec, scene: Scene) -> None:
        needs = dict.fromkeys(("boundary", "structure"), ("position", "force", "viscous_force"))
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._solids = (*spec.boundaries, *spec.structures)
        self._drag, self._lift = (
            _unit_vector(spec.direction("drag", scene.dimension)),
            _unit_vector(spec.direction("lift", scene.dimension)),
        )
        density = spec.density or next(iter(scene.fluids.values())).density
        self._scale = 0.5 * density * spec.speed**2 * spec.length * (spec.span or 1.0)
        self._length = spec.length
        self._about = None if spec.about is None else np.array(spec.about)

    def start(self, frame: Frame) -> None:
        """Take the centre of mass, where the scene names no other point."""
        if self._about is None:
            self._about = self._gather(frame, "position").mean(axis=0)

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Coefficients of drag, lift and moment, of viscous drag and lift, then drag and lift [N, N/m]."""
        if self._about is None:
            raise ValueError("start() comes before evaluate()")
        force, viscous = self._gather(frame, "force"), self._gather(frame, "viscous_force").sum(axis=0)
        axis = cross(self._drag[None], self._lift[None])[0]
        moment = cross(self._gather(frame, "position") - self._about, force).sum(axis=0) @ axis
        drag, lift = force.sum(axis=0) @ self._drag, force.sum(axis=0) @ self._lift
        forces = np.array([drag, lift, moment / self._length, viscous @ self._drag, viscous @ self._lift])
        return (*map(float, forces / self._scale), float(drag), float(lift))

    def _gather(self, frame: Frame, field: str) -> np.ndarray:
        """A field of the particles of all bodies (n, dimension)."""
        values = [frame.set_named(name).fields[field] for name in self._solids]
        return np.concatenate([np.asarray(v, dtype=np.float64) for v in values])


def _unit_vector(direction: tuple[float, ...]) -> np.ndarray:
    return np.array(direction) / np.linalg.norm(direction)
