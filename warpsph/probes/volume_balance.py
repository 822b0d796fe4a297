"""Whether what has passed the open boundaries is what the fluid between them has gained."""

from __future__ import annotations

import numpy as np

from warpsph.frame import Frame
from warpsph.geometry.polygons import polygon_area
from warpsph.probes.material_point import MaterialPoint
from warpsph.probes.probe import Probe
from warpsph.scene.probes import VolumeBalanceProbe as VolumeBalanceSpec
from warpsph.scene.probes import WallLine
from warpsph.scene.schema import Scene


class VolumeBalanceProbe(Probe):
    """Mass that has entered, gain of the fluid between the patches, and room that flexible walls have given to it.

    The balances of a whole domain: int rho dV less its start = int of the flux over the patches, and, of a full vessel,
    int dV less its start = the area that its walls have swept.
    """

    def __init__(self, name: str, spec: VolumeBalanceSpec, scene: Scene) -> None:
        needs: dict[str, tuple[str, ...]] = {"fluid": ("position", "mass", "density", "patch")}
        if spec.walls:
            needs["structure"] = MaterialPoint.needs
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._region = spec.region
        self._walls = [
            SweptLine(line, scene, f"probes.{name}.walls.{index}") for index, line in enumerate(spec.walls)
        ]
        self._start = (0.0, 0.0)

    def start(self, frame: Frame) -> None:
        """Note the fluid of the start, and find the walls. Raises SceneError where they lie in no structure."""
        self._start = self._inside(frame)
        for wall in self._walls:
            wall.find(frame)

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Entered by the flux and by count, and gained since the start [kg]; what was gained less what entered by
        either; with walls also volume gained and enclosed since the start, and the one less the other [m3].

        In the plane per metre of depth.
        """
        flux = sum(one.mass for one in frame.inflows.values())
        counted = sum(one.counted_mass for one in frame.inflows.values())
        mass, volume = (now - start for now, start in zip(self._inside(frame), self._start, strict=True))
        figures = (flux, counted, mass, mass - flux, mass - counted)
        if not self._walls:
            return figures
        enclosed = sum(wall.area(frame) for wall in self._walls)
        return (*figures, volume, enclosed, volume - enclosed)

    def _inside(self, frame: Frame) -> tuple[float, float]:
        """Mass [kg] and volume [m3] of the fluid that lies in no buffer, and in the region where there is one."""
        total = np.zeros(2)
        for fluid in frame.of_kind("fluid"):
            position = fluid.fields["position"]
            counts = fluid.fields["patch"] < 0
            if self._region is not None:
                within = (position >= self._region.min) & (position <= self._region.max)
                counts = counts & np.all(within, axis=1)
            mass = fluid.fields["mass"][counts].astype(np.float64)
            total += mass.sum(), (mass / fluid.fields["density"][counts]).sum()
        return float(total[0]), float(total[1])


class SweptLine:
    """A line on the surface of a structure in the plane, and the area over which it has moved."""

    def __init__(self, line: WallLine, scene: Scene, key: str) -> None:
        start, end = np.array(line.start), np.array(line.end)
        parts = max(int(np.ceil(np.linalg.norm(end - start) / scene.spacing)), 1)
        ways = np.linspace(0.0, 1.0, parts + 1)[:, None]
        self._points = [
            MaterialPoint(line.structure, point, scene, key) for point in start + ways * (end - start)
        ]
        self._rest = np.array([point.rest for point in self._points])

    def find(self, frame: Frame) -> None:
        """Find the particles around its points. Raises SceneError if they are not in the structure."""
        for point in self._points:
            point.find(frame)

    def area(self, frame: Frame) -> float:
        """Area [m2] between the line at rest and the present one, positive to the right of its direction."""
        present = self._rest + np.array([point.value(frame, "displacement") for point in self._points])
        return polygon_area(np.concatenate([present, self._rest[::-1]]))
