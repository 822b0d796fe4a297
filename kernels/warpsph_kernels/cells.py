"""The cell grid and the neighbour lists.

Space is cut into cells at least as wide as the search radius. Cell coordinates wrap around the grid (modulo), so
the table stays small however far particles fly; along a periodic axis the wrap is the period itself. Particles
lie sorted by cell, x fastest, therefore the three cells that are adjacent along x are one contiguous range.
"""

from functools import cache
from typing import Any, Literal, NamedTuple

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic, make_narrow, make_separation
from warpsph_kernels.lanes import make_lanes

REMOVED = wp.constant(wp.int32(2147483647))
"""Sort key of a particle that leaves the run: it ends up behind all others."""


class CellKernels(NamedTuple):
    """Kernels of the neighbour search, in the order of their use."""

    take_positions: Any
    assign_cells: Any
    find_cell_starts: Any
    list_neighbours: Any
    module: str


@cache
def make_grid_struct(arithmetic: Arithmetic) -> Any:
    """Return the struct that describes a grid: low corner, 1/cell width per axis [1/m], cells per axis, period."""
    vector, integers = arithmetic.vector, arithmetic.integers

    class CellGrid:
        pass

    CellGrid.__annotations__ = {"low": vector, "inverse_width": vector, "cells": integers, "period": vector}
    return wp.struct(CellGrid)


@cache
def make_cell_functions(arithmetic: Arithmetic) -> tuple[Any, Any, Any]:
    """Return the device functions of a walk through the cells around a place.

    wrap(coordinate, count): a cell coordinate brought into the grid; cell_of(x, grid): the cell of a position in run
    coordinates; row_base(cell, row, grid): the bucket at x = 0 of the row-th of the rows adjacent to a cell.
    """
    dim, real = arithmetic.dimension, arithmetic.real
    vector, integers = arithmetic.vector, arithmetic.integers
    grid_type = make_grid_struct(arithmetic)

    @wp.func
    def wrap(coordinate: int, count: int):
        remainder = coordinate % count
        return wp.where(remainder < 0, remainder + count, remainder)

    @wp.func
    def cell_of(x: vector, grid: grid_type):
        out = integers()
        for k in range(wp.static(dim)):
            # A particle may be further away than an int can count: bring it near in floating point first.
            turns = wp.floor((x[k] - grid.low[k]) * grid.inverse_width[k] / real(grid.cells[k]))
            near = (x[k] - grid.low[k]) * grid.inverse_width[k] - turns * real(grid.cells[k])
            out[k] = wp.clamp(int(near), 0, grid.cells[k] - 1)
        return out

    @wp.func
    def row_base(cell: integers, row: int, grid: grid_type):
        """Return the bucket at x = 0 of the row-th of the rows adjacent to a cell."""
        y = wrap(cell[1] + row % 3 - 1, grid.cells[1])
        if wp.static(dim == 2):
            return y * grid.cells[0]
        z = wrap(cell[wp.static(dim - 1)] + row // 3 - 1, grid.cells[wp.static(dim - 1)])
        return (z * grid.cells[1] + y) * grid.cells[0]

    return wrap, cell_of, row_base


def module_of(arithmetic: Arithmetic, periodic: tuple[bool, ...], lanes: int) -> str:
    """Name of the module of the search's kernels."""
    axes = "".join("p" if flag else "o" for flag in periodic)
    return f"warpsph_cells_{arithmetic.label}_{axes}_{lanes}"


Sided = Literal["neither", "targets", "sources"]


@cache
def make_list_kernel(
    arithmetic: Arithmetic, periodic: tuple[bool, ...], sided: Sided = "neither", lanes: int = 1
) -> Any:
    """Return the kernel `list_neighbours`; particles that are `sided` take part only in pairs on their own side.

    It looks at as many candidates at a time as there are `lanes`.
    """
    dim, real, vector = arithmetic.dimension, arithmetic.real, arithmetic.vector
    grid_type = make_grid_struct(arithmetic)
    separation = make_separation(arithmetic, periodic)
    rows = 3 ** (dim - 1)
    wrap, cell_of, row_base = make_cell_functions(arithmetic)
    module = module_of(arithmetic, periodic, lanes) + ("" if sided == "neither" else f"_sided_{sided}")
    block = make_lanes(arithmetic, lanes)
    stretch, hits_type, append = block.stretch, block.hits, block.append

    @wp.kernel(module=module, enable_backward=False)
    def list_neighbours(
        offset: int,
        first_target: int,
        listed_position: wp.array(dtype=vector),
        radius: real,
        grid: grid_type,
        first_source: int,
        start: wp.array(dtype=wp.int32),
        segment: int,
        continues: int,
        side: wp.array(dtype=vector),
        neighbours: wp.array2d(dtype=wp.int32),
        ends: wp.array2d(dtype=wp.int32),
    ):
        """One target particle: append all sources within the radius (but not itself) to its row.

        Segment s of row i holds the neighbours ends[i, s-1] .. ends[i, s]; if it `continues`, it has neighbours of an
        earlier range already. What does not fit into the row is counted and not stored; the host then makes the rows
        longer and repeats. A sided particle s has a vector n_s in `side`, and makes no pair with particles at x where
        n_s . (x - x_s) < 0.

        Candidates are appended a block at a time: the last place of a row holds no neighbour, and the arrays of the
        candidates end with `lanes` entries that are none.
        """
        i = offset + wp.tid()
        a = first_target + i
        x_a = listed_position[a]
        cell = cell_of(x_a, grid)
        found = int(0)
        if segment > 0:
            found = ends[i, segment - 1]
        if continues > 0:
            found = ends[i, segment]
        # Only at the ends of a row of cells do the three adjacent cells fall into separate ranges.
        at_end = cell[0] == 0 or cell[0] == grid.cells[0] - 1
        ranges = wp.where(at_end, 3, 1)
        width = wp.where(at_end, 1, 3)
        for row in range(wp.static(rows)):
            base = row_base(cell, row, grid)
            for r in range(ranges):
                bucket = base + wrap(cell[0] - 1 + r, grid.cells[0])
                j = int(start[bucket])
                stop = start[bucket + width]
                while j < stop:
                    x_b = stretch(listed_position, first_source + j)
                    if wp.static(sided == "sources"):
                        sides = stretch(side, j)
                    hits = hits_type()
                    k = int(0)
                    while k < wp.static(lanes):
                        x = vector()
                        for d in range(wp.static(dim)):
                            x[d] = x_b[wp.static(dim) * k + d]
                        x_ab = separation(x_a, x, grid.period)
                        reach = wp.where(
                            j + k < stop and first_source + j + k != a, radius * radius, real(0.0)
                        )
                        if wp.static(sided == "sources"):
                            away = real(0.0)
                            for d in range(wp.static(dim)):
                                away += sides[wp.static(dim) * k + d] * x_ab[d]
                            reach = wp.where(away >= real(0.0), reach, real(0.0))
                        if wp.static(sided == "targets"):
                            reach = wp.where(wp.dot(side[i], x_ab) <= real(0.0), reach, real(0.0))
                        hits[k] = wp.where(wp.dot(x_ab, x_ab) < reach, 1, 0)
                        k += 1
                    found = append(neighbours, i, found, first_source + j, hits)
                    j += wp.static(lanes)
        ends[i, segment] = found

    return list_neighbours


@cache
def make_cell_kernels(arithmetic: Arithmetic, periodic: tuple[bool, ...], lanes: int) -> CellKernels:
    """Return the kernels of the neighbour search for one dimension, precision and set of periodic axes."""
    dim, vector, point = arithmetic.dimension, arithmetic.vector, arithmetic.point
    grid_type = make_grid_struct(arithmetic)
    narrow = make_narrow(arithmetic)
    module = module_of(arithmetic, periodic, lanes)
    _, cell_of, _ = make_cell_functions(arithmetic)

    @wp.kernel(module=module, enable_backward=False)
    def take_positions(
        offset: int,
        first: int,
        origin: point,
        low: point,
        period: point,
        position: wp.array(dtype=point),
        listed_position: wp.array(dtype=vector),
    ):
        """One particle: bring it back into the period, and note the position that the lists are made from."""
        i = first + offset + wp.tid()
        x = position[i]
        for k in range(wp.static(dim)):
            if wp.static(periodic[k]):
                x[k] = x[k] - period[k] * wp.floor((x[k] - low[k]) / period[k])
        position[i] = x
        listed_position[i] = narrow(x, origin)

    @wp.kernel(module=module, enable_backward=False)
    def assign_cells(
        offset: int,
        listed_position: wp.array(dtype=vector),
        first: int,
        kill_low: vector,
        kill_high: vector,
        grid: grid_type,
        key: wp.array(dtype=wp.int32),
        order: wp.array(dtype=wp.int32),
    ):
        """One particle: write its bucket, or REMOVED outside of the kill box, and its index before sorting."""
        i = offset + wp.tid()
        x = listed_position[first + i]
        inside = bool(True)
        for k in range(wp.static(dim)):
            inside = inside and x[k] >= kill_low[k] and x[k] <= kill_high[k]
        cell = cell_of(x, grid)
        bucket = cell[1] * grid.cells[0] + cell[0]
        if wp.static(dim == 3):
            bucket += cell[wp.static(dim - 1)] * grid.cells[0] * grid.cells[1]
        key[i] = wp.where(inside, bucket, REMOVED)
        order[i] = i

    @wp.kernel(module=module, enable_backward=False)
    def find_cell_starts(
        offset: int, key: wp.array(dtype=wp.int32), count: int, start: wp.array(dtype=wp.int32)
    ):
        """One bucket: write the index of the first sorted particle whose key is not below it (bisection)."""
        bucket = offset + wp.tid()
        low = int(0)
        high = int(count)
        while low < high:
            middle = (low + high) // 2
            if key[middle] < bucket:
                low = middle + 1
            else:
                high = middle
        start[bucket] = low

    return CellKernels(
        take_positions,
        assign_cells,
        find_cell_starts,
        make_list_kernel(arithmetic, periodic, lanes=lanes),
        module,
    )
