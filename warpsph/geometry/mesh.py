"""Closed surfaces of triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from warpsph.geometry.winding import signed_volume


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """A closed surface whose triangles face outwards; inner shells that face inwards bound cavities.

    vertices: (n, 3) [m]; faces: (m, 3), indices of the corners, counter-clockwise seen from outside.
    """

    vertices: np.ndarray
    faces: np.ndarray

    @property
    def corners(self) -> np.ndarray:
        """Corners (m, 3, 3) [m] of each triangle."""
        return self.vertices[self.faces]

    @property
    def volume(self) -> float:
        """Enclosed volume [m3]; what several overlapping shells enclose counts several times."""
        return signed_volume(self.corners)

    def scaled(self, factor: float) -> TriangleMesh:
        """The mesh with all lengths multiplied by a factor greater than zero."""
        return TriangleMesh(self.vertices * factor, self.faces)
