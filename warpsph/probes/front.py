"""How far fluid has reached along an axis."""

import math

import numpy as np

from warpsph.frame import Frame
from warpsph.probes.bodies import connected_bodies
from warpsph.probes.probe import Probe
from warpsph.probes.smoothing import Smoothing
from warpsph.scene.probes import FrontProbe as FrontSpec
from warpsph.scene.schema import Scene
from warpsph.scene.types import AXES

CONNECTED_WITHIN = 2.0
"""Particles this close hang together, in spacings."""

SMALLEST_BODY = 0.05
"""Bodies with a smaller part of the particles are spray."""


class FrontProbe(Probe):
    """Largest coordinate along the axis of the fluid's particles, plus half a spacing; spray does not count.

    Particles within two spacings of each other hang together (`connected_bodies`); a body with less than 5 %
    of the particles is spray. NaN where there is no fluid.
    """

    def __init__(self, name: str, spec: FrontSpec, scene: Scene) -> None:
        needs = {"fluid": ("position",)}
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._axis = AXES.index(spec.axis)
        self._fluid = spec.fluid
        self._offset = 0.5 * scene.spacing - spec.origin
        self._spacing = scene.spacing
        self._periods = Smoothing.of(scene).periods

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """The coordinate of the front [m], relative to the origin of the probe."""
        fluids = [s for s in frame.of_kind("fluid") if self._fluid in (None, s.name)]
        position = np.concatenate([s.fields["position"] for s in fluids])
        if not len(position):
            return (math.nan,)
        body, sizes = connected_bodies(position, CONNECTED_WITHIN * self._spacing, self._periods)
        counts = sizes[body] >= SMALLEST_BODY * len(position)
        return (float(position[counts, self._axis].max() + self._offset),)
