"""Whether what has passed the open boundaries is what the fluid between them has gained."""

from __future__ import annotations

import numpy as np

from warpsph.frame import Frame
from warpsph.geometry.polygons import polygon_area
from warpsph.probes.material_point import MaterialPoint
from warpsph.probes.probe import Probe
from warpsph.sampling.patches import EDGE_MARGIN, FLUX_DEPTH, patches_of
from warpsph.sampling.walls import period_of
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
        self._patches, self._spacing, self._period = patches_of(scene), scene.spacing, period_of(scene)
        self._walls = [
            SweptLine(line, scene, f"probes.{name}.walls.{index}") for index, line in enumerate(spec.walls)
        ]
        self._start = np.zeros(3)

    def start(self, frame: Frame) -> None:
        """Note the fluid of the start, and find the walls. Raises SceneError where they lie in no structure."""
        self._start = self._inside(frame)
        for wall in self._walls:
            wall.find(frame)

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """Entered by the flux and by count, and gained since the start [kg]; what was gained less what entered by the
        flux, and in whole particles less what entered by count; with walls also volume gained and enclosed since the
        start, and the one less the other [m3].

        In the plane per metre of depth.
        """
        flux = sum(one.mass for one in frame.inflows.values())
        counted = sum(one.counted_mass for one in frame.inflows.values())
        whole, mass, volume = (self._inside(frame) - self._start).tolist()
        figures = (flux, counted, mass, mass - flux, whole - counted)
        if not self._walls:
            return figures
        enclosed = sum(wall.area(frame) for wall in self._walls)
        return (*figures, volume, enclosed, volume - enclosed)

    def _inside(self, frame: Frame) -> np.ndarray:
        """Of the fluid in the region, where there is one: mass of the particles that lie in no buffer [kg]; mass [kg]
        and volume [m3] where particles beside a patch count in part."""
        total = np.zeros(3)
        for fluid in frame.of_kind("fluid"):
            position = fluid.fields["position"]
            mass = fluid.fields["mass"].astype(np.float64)
            if self._region is not None:
                within = (position >= self._region.min) & (position <= self._region.max)
                mass = mass * np.all(within, axis=1)
            tag = fluid.fields["patch"]
            shared = mass * self._shares(position, tag)
            total += mass[tag < 0].sum(), shared.sum(), (shared / fluid.fields["density"]).sum()
        return total

    def _shares(self, position: np.ndarray, tag: np.ndarray) -> np.ndarray:
        """Part (n,) of each particle that lies between the patches, of which `tag` (n,) names the one behind it."""
        depth, margin = FLUX_DEPTH * self._spacing, EDGE_MARGIN * self._spacing
        shares = np.ones(len(position))
        for k, patch in enumerate(self._patches):
            share = patch.share_inside(position, tag == k, depth, margin, self._period)
            shares = np.minimum(shares, share)
        return shares


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
