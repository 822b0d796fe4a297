"""Which particles hang together."""

import itertools

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

BITS_PER_AXIS = 21
FARTHEST_CELL = 2 ** (BITS_PER_AXIS - 1) - 2


def connected_bodies(
    position: np.ndarray, distance: float, periods: tuple[float | None, ...]
) -> tuple[np.ndarray, np.ndarray]:
    """Number of the body of each particle (n,), and how many particles each body has.

    Space is divided into cubes with edges of `distance` [m]; particles in the same cube, or in cubes that
    share at least a corner, hang together. So do all that are closer than `distance`, and none that are more
    than twice the cube's diagonal apart. `periods` [m] are None along axes that are not periodic.
    """
    counts = tuple(None if period is None else int(period // distance) for period in periods)
    cells = _cells(position, distance, periods, counts)
    keys, cell_of_particle = np.unique(_keys(cells), return_inverse=True)
    pairs = [_neighbour_pairs(keys, offset, counts) for offset in _half_of_the_neighbours(len(periods))]
    first, second = np.concatenate(pairs, axis=1)
    graph = coo_array((np.ones(len(first), dtype=bool), (first, second)), shape=(len(keys), len(keys)))
    _, body_of_cell = connected_components(graph, directed=False)
    body = body_of_cell[cell_of_particle]
    return body, np.bincount(body)


def _cells(
    position: np.ndarray,
    distance: float,
    periods: tuple[float | None, ...],
    counts: tuple[int | None, ...],
) -> np.ndarray:
    """Cube of each particle (n, dimension); those millions of cubes away share the outermost."""
    cells = np.empty(position.shape, dtype=np.int64)
    for axis, (period, count) in enumerate(zip(periods, counts, strict=True)):
        x = np.asarray(position[:, axis], dtype=np.float64)
        if period is None or count is None:
            number = np.floor((x - np.median(x)) / distance)
            cells[:, axis] = np.clip(number, -FARTHEST_CELL, FARTHEST_CELL)
        else:
            cells[:, axis] = np.floor(x / (period / count)) % count
    return cells


def _keys(cells: np.ndarray) -> np.ndarray:
    """One integer a cube."""
    keys = np.zeros(len(cells), dtype=np.int64)
    for axis in range(cells.shape[1]):
        keys = (keys << BITS_PER_AXIS) | (cells[:, axis] + FARTHEST_CELL + 1)
    return keys


def _cells_of(keys: np.ndarray, dimension: int) -> np.ndarray:
    mask = (1 << BITS_PER_AXIS) - 1
    columns = [(keys >> (BITS_PER_AXIS * (dimension - 1 - axis))) & mask for axis in range(dimension)]
    return np.column_stack(columns) - FARTHEST_CELL - 1


def _half_of_the_neighbours(dimension: int) -> list[tuple[int, ...]]:
    """Steps to adjacent cubes, one of each opposite pair."""
    return [step for step in itertools.product((-1, 0, 1), repeat=dimension) if step > (0,) * dimension]


def _neighbour_pairs(keys: np.ndarray, step: tuple[int, ...], counts: tuple[int | None, ...]) -> np.ndarray:
    """Pairs (2, m) of occupied cubes, as indices into the sorted keys, that lie one step apart."""
    cells = _cells_of(keys, len(step)) + np.array(step)
    for axis, count in enumerate(counts):
        if count is not None:
            cells[:, axis] %= count
    neighbours = _keys(cells)
    place = np.minimum(np.searchsorted(keys, neighbours), len(keys) - 1)
    found = np.flatnonzero(keys[place] == neighbours)
    return np.stack([found, place[found]])
