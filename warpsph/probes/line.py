"""Fluid fields at points of a line."""

from warpsph.frame import Frame
from warpsph.probes.point import PointProbe
from warpsph.probes.probe import Probe
from warpsph.scene.probes import LineProbe as LineSpec
from warpsph.scene.probes import PointProbe as PointSpec
from warpsph.scene.schema import Scene


class LineProbe(Probe):
    """What a probe at each of the points says, point by point."""

    def __init__(self, name: str, spec: LineSpec, scene: Scene) -> None:
        self._points = [PointProbe(name, PointSpec(at=x, fields=spec.fields), scene) for x in spec.at]
        super().__init__(spec.columns(name, scene.dimension), self._points[0].needs)

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """The fields of the first point in the order of the columns, then those of the next."""
        return tuple(value for point in self._points for value in point.evaluate(frame))
