"""Neighbour search: cells, physical order, and lists with a skin.

One search serves every pair of particle kinds: a row of a list holds the neighbours of one particle, first those
among the fluid, then those among the walls.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.cells import make_cell_kernels, make_grid_struct, make_list_kernel
from warpsph_kernels.reorder import gather_words

from warpsph.particles.launch import Launcher, Pass, lanes_on

CELLS_PER_PARTICLE = 2
"""Largest number of cells in relation to the particles: beyond it the grid wraps around instead of growing."""
FIRST_CAPACITY_MARGIN = 1.25
GROWTH = 1.3


def first_capacity(reach: float, dimension: int) -> int:
    """Neighbours for which a row has room at first: a quarter more than a lattice has within so many spacings."""
    ball = math.pi * reach**2 if dimension == 2 else 4.0 / 3.0 * math.pi * reach**3
    return math.ceil(FIRST_CAPACITY_MARGIN * ball)


@dataclass(frozen=True)
class SearchSpace:
    """Where particles are searched for, in metres and world coordinates.

    `low` and `high` bound the particles of the start; they size the grid and do not limit motion. Along a periodic
    axis they are the period. Particles outside of the kill box are removed.
    """

    low: np.ndarray
    high: np.ndarray
    periodic: tuple[bool, ...]
    kill_low: np.ndarray
    kill_high: np.ndarray

    @property
    def origin(self) -> np.ndarray:
        """Origin of the single-precision coordinates."""
        return 0.5 * (self.low + self.high)

    @property
    def period(self) -> np.ndarray:
        return np.where(self.periodic, self.high - self.low, 0.0)


class CellTable:
    """A contiguous range of particles sorted by cell, with the start of every cell.

    Args:
        first: index of the range's first particle.
        capacity: number of places, never exceeded; all are taken unless `count` is lowered.
    """

    def __init__(self, launcher: Launcher, first: int, capacity: int, buckets: int) -> None:
        device = launcher.device
        self.first = first
        self.count = capacity
        self.start = wp.zeros(buckets + 1, dtype=wp.int32, device=device)
        self.key = wp.zeros(2 * max(capacity, 1), dtype=wp.int32, device=device)
        self.order = wp.zeros(2 * max(capacity, 1), dtype=wp.int32, device=device)
        self._spare = wp.empty(0, dtype=wp.uint32, device=device)

    @property
    def bytes(self) -> int:
        """Memory of the table and of what sorting takes."""
        return sum(int(array.capacity) for array in (self.start, self.key, self.order, self._spare))

    def spare(self, words: int) -> wp.array:
        """Scratch for an array of so many 4-byte words a particle, the same memory for all that follow the table."""
        size = len(self.order) // 2
        if len(self._spare) < size * words:
            self._spare = wp.empty(size * words, dtype=wp.uint32, device=self._spare.device)
        return self._spare[: size * words].reshape((size, words))


class NeighbourRows:
    """Neighbour rows of a range of target particles, one segment for each group of source tables."""

    def __init__(
        self, launcher: Launcher, targets: CellTable, sources: Sequence[Sequence[CellTable]], capacity: int
    ) -> None:
        self.targets = targets
        self.sources = tuple(tuple(tables) for tables in sources)
        self._launcher = launcher
        rows = max(targets.count, 1)
        self.ends = wp.zeros((rows, max(len(self.sources), 1)), dtype=wp.int32, device=launcher.device)
        self.index = self._allocate(rows, capacity)

    @property
    def capacity(self) -> int:
        """Neighbours for which a row has room; the place behind them is spent by the listing."""
        return int(self.index.shape[1]) - 1

    def grow(self, capacity: int) -> None:
        """Make room for `capacity` neighbours a row; the lists have to be filled again."""
        self.index = self._allocate(self.index.shape[0], capacity)

    def _allocate(self, rows: int, capacity: int) -> wp.array:
        # A CPU core reads its row from end to end, a GPU warp reads the same column of 32 rows at once.
        places = capacity + 1
        if self._launcher.device.is_cuda:
            return wp.empty((places, rows), dtype=wp.int32, device=self._launcher.device).transpose()
        return wp.empty((rows, places), dtype=wp.int32, device=self._launcher.device)


class NeighbourSearch:
    """Keeps particles sorted by cell and lists their neighbours within `radius + skin`.

    Args:
        ranges: (first, count) of each particle range that is searched in.
        removable: whether a range's particles leave the run outside of the kill box.
        pairs: (target range, source ranges) of each list, by position in `ranges`: one group of ranges a segment.
        radius, skin: metres. Lists stay complete while no particle has moved more than half the skin.
        position: master positions of all particles, (n,) double vectors [m].
        sides: by position in `ranges`, a vector for each particle of a sided range: it is listed only with particles
            on the side to which its vector points, or all round where that is zero. Not for pairs of two such ranges.
            Behind the last one are `lanes_on(device, dimension)` entries that are none.
    """

    def __init__(
        self,
        launcher: Launcher,
        arithmetic: Arithmetic,
        space: SearchSpace,
        ranges: Sequence[tuple[int, int]],
        removable: Sequence[bool],
        pairs: Sequence[tuple[int, Sequence[Sequence[int]]]],
        radius: float,
        skin: float,
        spacing: float,
        position: wp.array,
        sides: Mapping[int, wp.array] | None = None,
    ) -> None:
        self.arithmetic = arithmetic
        self.space = space
        self.skin = skin
        self.builds = 0
        self._launcher = launcher
        self.reach = radius + skin
        lanes = lanes_on(launcher.device, arithmetic.dimension)
        self._kernels = make_cell_kernels(arithmetic, space.periodic, lanes)
        particles = sum(count for _, count in ranges)
        self.cells = self._choose_cells(particles)
        self.grid = self._describe_grid()
        buckets = int(np.prod(self.cells))
        self.tables = [CellTable(launcher, first, count, buckets) for first, count in ranges]
        # The listing loads candidates a few at a time, and so looks beyond the last one.
        self.listed_position = wp.zeros(particles + lanes, dtype=arithmetic.vector, device=launcher.device)
        self._first_capacity = first_capacity(self.reach / spacing, arithmetic.dimension)
        self.rows = [
            NeighbourRows(
                launcher,
                self.tables[target],
                [[self.tables[s] for s in group] for group in groups],
                self._first_capacity,
            )
            for target, groups in pairs
        ]
        self._sides = {self.tables[index]: side for index, side in (sides or {}).items()}
        self._sideless = wp.zeros(1, dtype=arithmetic.vector, device=launcher.device)
        if self._sides:
            self._list_kernels = {
                sided: make_list_kernel(arithmetic, space.periodic, sided, lanes)
                for sided in ("targets", "sources")
            }
        self._listed = [
            Reordered(launcher, self.listed_position, table, table.first) for table in self.tables
        ]
        self._take = [self._bind_take(table, position) for table in self.tables]
        self._assign = [
            self._bind_assign(table, leaves) for table, leaves in zip(self.tables, removable, strict=True)
        ]

    def take_positions(self, moving: Sequence[bool]) -> None:
        """Note the present positions of the tables that move, as those that the next lists are made from."""
        for table, take, moves in zip(self.tables, self._take, moving, strict=True):
            if moves:
                take.run(table.count)

    def sort(
        self, table_index: int, arrays: Sequence[Reordered], remove: Callable[[], None] | None = None
    ) -> int:
        """Sort a table and its arrays by cell; return how many particles are gone: those that left the kill box, and
        those whose keys `remove` has set to REMOVED."""
        table = self.tables[table_index]
        self._assign[table_index].run(table.count)
        if remove:
            remove()
        if table.count:
            wp.utils.radix_sort_pairs(table.key, table.order, table.count)
        for array in (*arrays, self._listed[table_index]):
            array.apply(table.count)
        before = table.count
        self._find_starts(table)
        table.count = int(table.start[-1:].numpy()[0])
        return before - table.count

    def list_neighbours(self) -> None:
        """Fill every list from the sorted tables, with longer rows where they overflow."""
        self.builds += 1
        for rows in self.rows:
            self._fill_completely(rows)

    def _listing(self, targets: CellTable, source: CellTable) -> tuple[Any, wp.array]:
        """The kernel that lists these pairs, and the sides that it looks at."""
        if source in self._sides:
            return self._list_kernels["sources"], self._sides[source]
        if targets in self._sides:
            return self._list_kernels["targets"], self._sides[targets]
        return self._kernels.list_neighbours, self._sideless

    def list_once(self, target: int, source: int) -> NeighbourRows:
        """Return rows of one table's particles with another's (or its own), for a single use."""
        rows = NeighbourRows(
            self._launcher, self.tables[target], [[self.tables[source]]], self._first_capacity
        )
        self._fill_completely(rows)
        return rows

    def must_rebuild(self, displacement: float, speed: float, step: float) -> bool:
        """Tell whether a particle may leave half the skin within the next step [m, m/s, s]."""
        return 2.0 * (displacement + speed * step) > self.skin

    @property
    def bytes(self) -> int:
        """Memory of cell tables and sorting, without the lists."""
        return sum(table.bytes for table in self.tables) + int(self.listed_position.capacity)

    @property
    def list_bytes(self) -> int:
        """Memory of the neighbour lists."""
        return sum(int(rows.index.capacity + rows.ends.capacity) for rows in self.rows)

    def _choose_cells(self, particles: int) -> np.ndarray:
        extent = self.space.high - self.space.low
        cells = np.maximum(np.floor(extent / self.reach).astype(int), 3)
        periodic = np.asarray(self.space.periodic)
        budget = max(CELLS_PER_PARTICLE * particles, 4096)
        while np.prod(cells[~periodic], dtype=float) * np.prod(cells[periodic], dtype=float) > budget:
            free = np.where(periodic, 0, cells)
            widest = int(np.argmax(free))
            if free[widest] <= 3:
                break
            cells[widest] = max(3, cells[widest] // 2)
        return cells

    def _describe_grid(self) -> Any:
        arithmetic, space = self.arithmetic, self.space
        width = np.where(space.periodic, (space.high - space.low) / self.cells, self.reach)
        grid = make_grid_struct(arithmetic)()
        grid.low = arithmetic.vector(*(space.low - space.origin))
        grid.inverse_width = arithmetic.vector(*(1.0 / width))
        grid.cells = arithmetic.integers(*(int(n) for n in self.cells))
        grid.period = arithmetic.vector(*space.period)
        return grid

    def _bind_take(self, table: CellTable, position: wp.array) -> Pass:
        space, point = self.space, self.arithmetic.point
        return self._launcher.bind(
            "sort",
            self._kernels.take_positions,
            table.first,
            point(*space.origin),
            point(*space.low),
            point(*space.period),
            position,
            self.listed_position,
        )

    def _bind_assign(self, table: CellTable, leaves: bool) -> Pass:
        space, vector = self.space, self.arithmetic.vector
        everywhere = np.full(self.arithmetic.dimension, np.inf)
        low = space.kill_low - space.origin if leaves else -everywhere
        high = space.kill_high - space.origin if leaves else everywhere
        return self._launcher.bind(
            "sort",
            self._kernels.assign_cells,
            self.listed_position,
            table.first,
            vector(*low),
            vector(*high),
            self.grid,
            table.key,
            table.order,
        )

    def _find_starts(self, table: CellTable) -> None:
        buckets = table.start.shape[0]
        self._launcher.bind("sort", self._kernels.find_cell_starts, table.key, table.count, table.start).run(
            buckets
        )

    def _fill_completely(self, rows: NeighbourRows) -> None:
        self._fill(rows)
        longest = self._longest(rows)
        if longest > rows.capacity:
            rows.grow(math.ceil(GROWTH * longest))
            self._fill(rows)

    def _fill(self, rows: NeighbourRows) -> None:
        groups = enumerate(rows.sources)
        places = [(segment, k > 0, table) for segment, group in groups for k, table in enumerate(group)]
        for segment, continues, source in places:
            kernel, side = self._listing(rows.targets, source)
            self._launcher.bind(
                "list neighbours",
                kernel,
                rows.targets.first,
                self.listed_position,
                self.arithmetic.real(self.reach),
                self.grid,
                source.first,
                source.start,
                segment,
                int(continues),
                side,
                rows.index,
                rows.ends,
            ).run(rows.targets.count)

    def _longest(self, rows: NeighbourRows) -> int:
        ends = rows.ends.numpy()[: rows.targets.count]
        return int(ends[:, -1].max()) if ends.size else 0


class Reordered:
    """An array that follows the order of a table, in place.

    Args:
        first: index in the array of the table's first particle.
    """

    def __init__(self, launcher: Launcher, array: wp.array, table: CellTable, first: int) -> None:
        words = wp.types.type_size_in_bytes(array.dtype) // 4
        size = max(table.count, 1)
        self._scratch = table.spare(words)
        self._own = self._scratch if not table.count else _words_of(array[first : first + size], words)
        self._gather = launcher.bind("sort", gather_words, table.order, self._own, self._scratch)
        self._owner = array  # the words above are a view of its memory

    @property
    def words(self) -> wp.array:
        """The array as words of 4 bytes, shape (places, words of an entry)."""
        return self._own

    def apply(self, count: int) -> None:
        """Bring the first `count` entries into the new order."""
        if count == 0:
            return
        self._gather.run(count)
        wp.copy(self._own, self._scratch, count=count * self._own.shape[1])


def _words_of(array: wp.array, words: int) -> wp.array:
    return wp.array(ptr=array.ptr, dtype=wp.uint32, shape=(len(array), words), device=array.device)
