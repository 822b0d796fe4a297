"""How a material point of a structure moves."""

from warpsph.frame import Frame
from warpsph.probes.material_point import MaterialPoint
from warpsph.probes.probe import Probe
from warpsph.scene.probes import DisplacementProbe as DisplacementSpec
from warpsph.scene.schema import Scene


class DisplacementProbe(Probe):
    """Displacement and velocity of a material point."""

    def __init__(self, name: str, spec: DisplacementSpec, scene: Scene) -> None:
        needs = {"structure": (*MaterialPoint.needs, "velocity")}
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._point = MaterialPoint(spec.structure, spec.at, scene, f"probes.{name}.at")

    def start(self, frame: Frame) -> None:
        """Find the particles around the point. Raises SceneError if it is not in the structure."""
        self._point.find(frame)

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Displacement [m], then velocity [m/s], by component."""
        values = (self._point.value(frame, field) for field in ("displacement", "velocity"))
        return tuple(float(component) for vector in values for component in vector)
