"""The cell-centred lattice that fluids and walls share.

One particle stands in the middle of each cell. A cell belongs to a shape if its centre lies inside, so a
length that is no multiple of the spacing is rounded to the nearest multiple (a half upwards), and what lies
on the two sides of a surface fits together without gap or overlap.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from warpsph.sampling.distance import signed_distance
from warpsph.scene.bounds import bounding_box
from warpsph.scene.shapes import Shape

# In units of the spacing: centres that fall on a surface but for rounding count to its lower side.
TIE = 1e-6

_BLOCK = 8


@dataclass(frozen=True)
class Lattice:
    """Cubic cells of edge `spacing` [m], with edges along the columns of `rotation` (dimension, dimension).

    `origin` (dimension,) [m] is the corner of a cell, as coordinates along those columns.
    """

    spacing: float
    origin: np.ndarray
    rotation: np.ndarray

    def centers(self, cells: np.ndarray) -> np.ndarray:
        """Centres (n, dimension) [m] of cells, given by their indices (n, dimension)."""
        return (self.origin + (cells + 0.5) * self.spacing) @ self.rotation.T

    def cells_of(self, centers: np.ndarray) -> np.ndarray:
        """Indices (n, dimension) of the cells with these centres (n, dimension) [m]: the inverse of `centers`."""
        return np.rint((centers @ self.rotation - self.origin) / self.spacing - 0.5).astype(np.int64)

    def cells_between(self, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """First cell and number of cells (dimension,) whose centres lie in a box along the lattice's axes."""
        first = np.ceil((low - self.origin) / self.spacing - 0.5 - TIE)
        last = np.floor((high - self.origin) / self.spacing - 0.5 + TIE)
        return first.astype(np.int64), np.maximum(last - first + 1, 0).astype(np.int64)


@dataclass(frozen=True)
class CellBlock:
    """A contiguous block of lattice cells, each marked or not; `mask[i]` is the cell `first + i`."""

    lattice: Lattice
    first: np.ndarray
    mask: np.ndarray

    def positions(self) -> np.ndarray:
        """Centres (n, dimension) [m] of the marked cells."""
        return self.lattice.centers(np.argwhere(self.mask) + self.first)


def cells_inside(lattice: Lattice, shape: Shape) -> CellBlock:
    """The cells of a bounded shape. Needs memory for one byte a cell of the shape's bounding box.

    Whole blocks of cells far from the surface are decided by the distance of their centre, so that the cost
    grows with the surface, not with the volume.
    """
    first, count = lattice.cells_between(*bounding_box(shape, lattice.rotation))
    blocks = -(-count // _BLOCK)
    mask = np.zeros(blocks * _BLOCK, dtype=bool)
    by_block = _block_view(mask, blocks)
    reach = 0.5 * _BLOCK * lattice.spacing * np.sqrt(len(count))
    distance = _block_distances(lattice, shape, first, blocks)
    by_block[distance < -reach] = True
    for near in _portions(np.argwhere(np.abs(distance) <= reach)):
        by_block[tuple(near.T)] = _evaluate_blocks(lattice, shape, first, near)
    return CellBlock(lattice, first, mask[tuple(slice(n) for n in count)])


def _block_view(mask: np.ndarray, blocks: np.ndarray) -> np.ndarray:
    """View of the mask with the block's indices first and the cell's indices within its block last."""
    dimension = len(blocks)
    split = mask.reshape([n for count in blocks for n in (count, _BLOCK)])
    return split.transpose([*range(0, 2 * dimension, 2), *range(1, 2 * dimension, 2)])


def _block_distances(lattice: Lattice, shape: Shape, first: np.ndarray, blocks: np.ndarray) -> np.ndarray:
    corner = first + np.moveaxis(np.indices(tuple(blocks)), 0, -1).reshape(-1, len(blocks)) * _BLOCK
    return signed_distance(shape, lattice.centers(corner + 0.5 * (_BLOCK - 1))).reshape(blocks)


def _evaluate_blocks(lattice: Lattice, shape: Shape, first: np.ndarray, blocks: np.ndarray) -> np.ndarray:
    """Which cells of the given blocks (n, dimension) lie inside: (n, _BLOCK, ..., _BLOCK)."""
    dimension = blocks.shape[1]
    within = np.moveaxis(np.indices((_BLOCK,) * dimension), 0, -1).reshape(-1, dimension)
    cells = (first + blocks * _BLOCK)[:, None, :] + within - TIE
    inside = signed_distance(shape, lattice.centers(cells.reshape(-1, dimension))) < 0.0
    return inside.reshape(len(blocks), *(_BLOCK,) * dimension)


def _portions(blocks: np.ndarray, cells: int = 1 << 20) -> list[np.ndarray]:
    """Portions of blocks whose cells together stay near the given number, to bound the scratch memory."""
    size = max(1, cells // _BLOCK ** blocks.shape[1])
    return [blocks[start : start + size] for start in range(0, len(blocks), size)]
