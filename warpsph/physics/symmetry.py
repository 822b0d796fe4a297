"""Planes of symmetry: where they are, and the images of the fluid that they make."""

from __future__ import annotations

import numpy as np
import warp as wp
from warpsph_kernels.symmetry import make_planes_struct, make_symmetry_kernels

from warpsph.particles.neighbours import CellTable, NeighbourSearch, Reordered
from warpsph.physics.assembly import Assembly
from warpsph.scene.schema import Scene
from warpsph.scene.types import AXES


def images_of(scene: Scene, fluids: int) -> int:
    """Return the largest number of images that the fluid particles of a scene can have together.

    A particle is near at most one plane of each axis, and has an image for each combination of those it is near.
    """
    axes = {face[0] for face in scene.domain.symmetry}
    return fluids * (2 ** len(axes) - 1)


class SymmetryModel:
    """The passes of symmetry planes.

    Args:
        images: table of the search that the images fill.
        reach: distance from a plane within which a particle has an image [m].
    """

    def __init__(self, scene: Scene, assembly: Assembly, search: NeighbourSearch, images: CellTable) -> None:
        a, device = assembly, assembly.launcher.device
        self._assembly, self._search, self._images = assembly, search, images
        self._fluid = search.tables[0]
        capacity = images.count
        self._counts = wp.zeros(self._fluid.count, dtype=wp.int32, device=device)
        self._ends = wp.zeros(self._fluid.count, dtype=wp.int32, device=device)
        source = wp.zeros(capacity, dtype=wp.int32, device=device)
        mirrors = wp.zeros(capacity, dtype=wp.int32, device=device)
        self.image_arrays = tuple(Reordered(a.launcher, array, images, 0) for array in (source, mirrors))
        kernels, bind = make_symmetry_kernels(a.options.arithmetic), a.launcher.bind
        low, high = _planes(scene)
        planes = _device_planes(a, low, high, search.reach)
        point, state, first = a.options.arithmetic.point, a.state, images.first
        records = a.scratch.position_pressure, a.scratch.position_density
        self._reflect = bind(
            "reflect",
            kernels.reflect,
            point(*low),
            point(*high),
            state.position,
            state.velocity_volume,
            state.acceleration,
        )
        self._count = bind("images", kernels.count_images, planes, search.listed_position, self._counts)
        self._make = bind(
            "images",
            kernels.make_images,
            planes,
            first,
            self._counts,
            self._ends,
            search.listed_position,
            source,
            mirrors,
        )
        common = (planes, first, source, mirrors)
        self._mirror_pressure = bind(
            "mirror",
            kernels.mirror_pressure,
            *common,
            records[0],
            state.velocity_volume,
            state.density_deviation,
        )
        self._mirror_density = bind(
            "mirror", kernels.mirror_density, *common, records[1], state.velocity_volume
        )

    def reflect(self) -> None:
        """Bring back particles that have passed a plane."""
        self._reflect.run(self._fluid.count)

    def make_images(self) -> None:
        """Find the images of the fluid, which is sorted already, and sort them by cell."""
        count = self._fluid.count
        self._count.run(count)
        wp.utils.array_scan(self._counts[:count], self._ends[:count], inclusive=True)
        self._images.count = int(self._ends[count - 1 : count].numpy()[0]) if count else 0
        self._make.run(count)
        self._search.sort(self._search.tables.index(self._images), self.image_arrays)

    def mirror_pressure(self) -> None:
        """Bring the images to the pressures of the fluid."""
        self._mirror_pressure.run(self._images.count)

    def mirror_density(self) -> None:
        """Bring the images to the densities of the fluid."""
        self._mirror_density.run(self._images.count)


def _planes(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates of the planes at the low and the high end of each axis [m], infinite where there is none."""
    low, high = np.full(scene.dimension, -np.inf), np.full(scene.dimension, np.inf)
    for face, coordinate in scene.domain.symmetry.items():
        (low if face.endswith("min") else high)[AXES.index(face[0])] = coordinate
    return low, high


def _device_planes(assembly: Assembly, low: np.ndarray, high: np.ndarray, reach: float) -> object:
    vector, origin = assembly.options.arithmetic.vector, assembly.space.origin
    planes = make_planes_struct(assembly.options.arithmetic)()
    planes.low, planes.high, planes.reach = vector(*(low - origin)), vector(*(high - origin)), reach
    return planes
