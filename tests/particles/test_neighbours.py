"""Neighbour lists against brute force and against Warp's hash grid."""

import numpy as np
import pytest
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic

from warpsph.particles.launch import Launcher
from warpsph.particles.neighbours import NeighbourSearch, Reordered, SearchSpace
from warpsph.particles.state import write_array

RADIUS, SKIN = 0.2, 0.02


def make_space(dimension: int, periodic: tuple[bool, ...], kill: float = np.inf) -> SearchSpace:
    return SearchSpace(
        low=np.zeros(dimension),
        high=np.ones(dimension),
        periodic=periodic,
        kill_low=np.full(dimension, -kill),
        kill_high=np.full(dimension, kill),
    )


def search(
    points: np.ndarray, space: SearchSpace, walls: int = 0, precision: str = "double", spacing: float = 0.1
):
    """A search over `points`, of which the last `walls` are walls; returns it with ids that follow the sorting."""
    launcher = Launcher("cpu", 2)
    dimension = points.shape[1]
    arithmetic = Arithmetic(dimension, precision)
    position = wp.array(points, dtype=arithmetic.point, device="cpu")
    ids = wp.array(np.arange(len(points)), dtype=wp.int64, device="cpu")
    fluids = len(points) - walls
    ranges = [(0, fluids), (fluids, walls)] if walls else [(0, fluids)]
    pairs = [(0, [[0], [1]]), (1, [[0]])] if walls else [(0, [[0]])]
    removable = [True, False][: len(ranges)]
    found = NeighbourSearch(
        launcher, arithmetic, space, ranges, removable, pairs, RADIUS, SKIN, spacing, position
    )
    found.take_positions([True] * len(ranges))
    removed = 0
    for k, table in enumerate(found.tables):
        arrays = [Reordered(launcher, array, table, table.first) for array in (position, ids)]
        removed += found.sort(k, arrays)
    found.list_neighbours()
    return found, ids.numpy(), removed


def listed_pairs(found: NeighbourSearch, ids: np.ndarray, rows: int, segment: int) -> set[tuple[int, int]]:
    lists = found.rows[rows]
    index, ends, first = lists.index.numpy(), lists.ends.numpy(), lists.targets.first
    pairs = []
    for i in range(lists.targets.count):
        begin = ends[i, segment - 1] if segment else 0
        pairs += [(int(ids[first + i]), int(ids[j])) for j in index[i, begin : ends[i, segment]]]
    assert len(pairs) == len(set(pairs)), "a neighbour is listed twice"
    return set(pairs)


def brute_force(
    points: np.ndarray, space: SearchSpace, targets: range, sources: range
) -> set[tuple[int, int]]:
    gap = points[:, None, :] - points[None, :, :]
    period = np.where(space.periodic, 1.0, np.inf)
    gap = np.where(np.isfinite(period), gap - np.round(gap / np.where(np.isfinite(period), period, 1.0)), gap)
    close = np.linalg.norm(gap, axis=2) < RADIUS + SKIN
    return {(i, j) for i in targets for j in sources if i != j and close[i, j]}


@pytest.mark.parametrize("precision", ["single", "double"])
@pytest.mark.parametrize(
    ("dimension", "periodic"),
    [
        (2, (False, False)),
        (2, (True, False)),
        (2, (True, True)),
        (3, (False, False, False)),
        (3, (True, False, True)),
    ],
)
def test_lists_equal_brute_force(dimension, periodic, precision):
    # Coordinates on a lattice of 1/1024 shifted against the radius: no pair is undecided in single precision.
    rng = np.random.default_rng(1)
    points = rng.integers(0, 1024, (400, dimension)) / 1024.0
    space = make_space(dimension, periodic)
    found, ids, _ = search(points, space, precision=precision)
    assert listed_pairs(found, ids, 0, 0) == brute_force(points, space, range(400), range(400))


def test_segments_hold_fluid_then_walls():
    points = np.random.default_rng(2).random((300, 2))
    space = make_space(2, (False, False))
    found, ids, _ = search(points, space, walls=100)
    fluid, walls = range(200), range(200, 300)
    assert listed_pairs(found, ids, 0, 0) == brute_force(points, space, fluid, fluid)
    assert listed_pairs(found, ids, 0, 1) == brute_force(points, space, fluid, walls)
    assert listed_pairs(found, ids, 1, 0) == brute_force(points, space, walls, fluid)


def test_particles_that_fly_far_away_are_found_and_cost_no_memory():
    points = np.random.default_rng(3).random((200, 2))
    points[150:] += np.array([1.0e6, -3.0e5])
    space = make_space(2, (False, False))
    found, ids, _ = search(points, space)
    assert listed_pairs(found, ids, 0, 0) == brute_force(points, space, range(200), range(200))
    assert found.tables[0].start.shape[0] < 10_000


def test_rows_grow_where_particles_crowd():
    points = 0.05 * np.random.default_rng(4).random((300, 2))
    space = make_space(2, (False, False))
    found, ids, _ = search(points, space)
    assert listed_pairs(found, ids, 0, 0) == brute_force(points, space, range(300), range(300))


def test_kill_box_removes_and_counts():
    points = np.random.default_rng(5).random((200, 2))
    points[:7] += 5.0
    found, ids, removed = search(points, make_space(2, (False, False), kill=2.0))
    assert removed == 7
    assert found.tables[0].count == 193
    assert set(ids[:193]) == set(range(7, 200))


def test_walls_outside_the_kill_box_stay():
    points = np.random.default_rng(8).random((300, 2))
    space = make_space(2, (False, False), kill=0.5)
    found, ids, removed = search(points, space, walls=100)
    inside = np.flatnonzero(np.all(points[:200] <= 0.5, axis=1))
    assert removed == 200 - len(inside)
    assert found.tables[1].count == 100
    expected = {(i, j) for i, j in brute_force(points, space, range(200), range(200, 300)) if i in inside}
    assert listed_pairs(found, ids, 0, 1) == expected


def test_no_particles_at_all():
    found, _, removed = search(np.zeros((0, 2)), make_space(2, (False, False)))
    assert removed == 0
    assert found.tables[0].count == 0


def test_sorted_particles_share_cells():
    points = np.random.default_rng(6).random((500, 3))
    found, ids, _ = search(points, make_space(3, (False,) * 3))
    key = found.tables[0].key.numpy()[:500]
    assert np.all(np.diff(key) >= 0)
    assert set(ids) == set(range(500))


@wp.kernel(module="test_hash_grid", enable_backward=False)
def count_by_hash_grid(
    grid: wp.uint64, points: wp.array(dtype=wp.vec3), radius: float, count: wp.array(dtype=wp.int32)
):
    i = wp.tid()
    found = int(0)
    for j in wp.hash_grid_query(grid, points[i], radius):
        if i != j and wp.length(points[i] - points[j]) < radius:
            found += 1
    count[i] = found


def test_lists_agree_with_warps_hash_grid():
    points = np.random.default_rng(7).random((500, 3)).astype(np.float32)
    grid = wp.HashGrid(16, 16, 16, device="cpu")
    on_device = wp.array(points, dtype=wp.vec3, device="cpu")
    grid.build(on_device, RADIUS + SKIN)
    count = wp.zeros(500, dtype=wp.int32, device="cpu")
    wp.launch(count_by_hash_grid, 500, inputs=[grid.id, on_device, RADIUS + SKIN, count], device="cpu")
    found, ids, _ = search(points.astype(np.float64), make_space(3, (False,) * 3), precision="single")
    ours = np.zeros(500, dtype=int)
    ours[ids] = found.rows[0].ends.numpy()[:, 0]
    # The search computes relative to the middle of the box, so pairs within rounding of the radius may differ.
    assert np.abs(ours - count.numpy()).sum() <= 2


def test_write_array_keeps_identity():
    array = wp.zeros(3, dtype=wp.float32, device="cpu")
    view = array.numpy()
    write_array(array, np.array([1.0, 2.0]))
    assert view.tolist() == [1.0, 2.0, 0.0]
