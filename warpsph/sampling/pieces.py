"""A combined shape as the primitives whose surfaces bound it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from warpsph.sampling.distance import signed_distance
from warpsph.scene.placement import placement
from warpsph.scene.shapes import Difference, Shape, Transform


@dataclass(frozen=True)
class Piece:
    """A primitive as it stands in a combined shape.

    Its point y is at x = scale * rotation @ y + displacement [m]; with `cut_out` it is taken away.
    """

    primitive: Shape
    scale: float
    rotation: np.ndarray
    displacement: np.ndarray
    cut_out: bool

    def to_world(self, points: np.ndarray) -> np.ndarray:
        """Points (n, dimension) [m] of the primitive's coordinates in those of the scene."""
        return self.scale * points @ self.rotation.T + self.displacement

    def to_local(self, points: np.ndarray) -> np.ndarray:
        """The inverse of `to_world`."""
        return (points - self.displacement) @ self.rotation / self.scale

    def signed_distance(self, points: np.ndarray) -> np.ndarray:
        """Distance (n,) [m] of points (n, dimension) [m], in the combined shape's sense."""
        sense = -self.scale if self.cut_out else self.scale
        return sense * signed_distance(self.primitive, self.to_local(points))


def pieces_of(shape: Shape, place: Piece) -> Iterator[Piece]:
    """The primitives of a shape, which itself stands at `place`."""
    match shape:
        case Transform():
            rotation, displacement = placement(shape, len(place.displacement))
            inner = replace(
                place,
                scale=place.scale * shape.scale,
                rotation=place.rotation @ rotation,
                displacement=place.scale * place.rotation @ displacement + place.displacement,
            )
            yield from pieces_of(shape.shape, inner)
        case Difference():
            yield from pieces_of(shape.base, place)
            for part in shape.subtract:
                yield from pieces_of(part, replace(place, cut_out=not place.cut_out))
        case _:
            parts = [part for _, part in shape.parts()]
            for part in parts:
                yield from pieces_of(part, place)
            if not parts:
                yield replace(place, primitive=shape)
