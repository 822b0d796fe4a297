"""Blocked pair loops: they see every neighbour once, and find the sums of the plain loop."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.fluid import make_fluid_kernels
from warpsph_kernels.lanes import make_lanes

from warpsph.scene import load_scene
from warpsph.solver.simulation import Simulation

ROUNDING = 2e-5
"""Of some hundred terms in single precision, relative to the largest sum: their order differs."""

THICK = tuple(f"fluids.{name}.kinematic_viscosity=0.01" for name in ("square", "tall"))


@pytest.mark.parametrize(
    ("dimension", "precision", "count"), [(2, "single", 8), (3, "single", 16), (3, "double", 8)]
)
def test_blocks_hold_the_components_of_the_listed_entries(dimension: int, precision: str, count: int) -> None:
    arithmetic = Arithmetic(dimension, precision)
    lanes, width = make_lanes(arithmetic, count), dimension + 1
    entries = np.arange(40.0 * width).reshape(40, width)
    row = np.random.default_rng(0).integers(5, 45, size=(1, count + 3)).astype(np.int32)
    first, end = 2, count + 1  # one neighbour less than there are lanes

    @wp.kernel(module=f"test_lanes_{arithmetic.label}_{count}", enable_backward=False)
    def load(
        neighbours: wp.array2d(dtype=wp.int32),
        array: wp.array(dtype=arithmetic.record),
        out: wp.array(dtype=arithmetic.real),
    ):
        index = lanes.take(neighbours, 0, first, end)
        block = lanes.records(array, index, 5)
        for k in range(wp.static(count * (dimension + 1))):
            out[k] = block[k]

    out = wp.zeros(count * width, dtype=arithmetic.real, device="cpu")
    array = wp.array(entries, dtype=arithmetic.record, device="cpu")
    wp.launch(load, 1, inputs=[wp.array(row, dtype=wp.int32, device="cpu"), array, out], device="cpu")
    chosen = [*row[0, first:end], row[0, end - 1]]
    np.testing.assert_array_equal(out.numpy().reshape(width, count), entries[np.array(chosen) - 5].T)


@pytest.mark.parametrize("count", [1, 8, 16])
def test_hits_are_appended_as_far_as_there_is_room(count: int) -> None:
    # Behind three neighbours, in rows with room for a whole block, for a part of it, and for nothing.
    lanes = make_lanes(Arithmetic(3, "single"), count)
    hits = np.random.default_rng(1).integers(0, 2, count)
    kept = 100 + np.flatnonzero(hits)

    @wp.kernel(module=f"test_append_{count}", enable_backward=False)
    def append(
        marks: wp.array(dtype=lanes.hits),
        neighbours: wp.array2d(dtype=wp.int32),
        found: wp.array(dtype=wp.int32),
    ):
        found[0] = lanes.append(neighbours, 0, 3, 100, marks[0])

    for places in (count + 3, count // 2 + 4, 3):
        neighbours = wp.array(-np.ones((1, places)), dtype=wp.int32, device="cpu")
        found = wp.zeros(1, dtype=wp.int32, device="cpu")
        marks = wp.array(hits[None], dtype=lanes.hits, device="cpu")
        wp.launch(append, 1, inputs=[marks, neighbours, found], device="cpu")
        assert found.numpy()[0] == 3 + len(kept)
        # The last place is spent where the row is full.
        room = min(len(kept), places - 4)
        if room > 0:
            np.testing.assert_array_equal(neighbours.numpy()[0, 3 : 3 + room], kept[:room])


@pytest.mark.parametrize(
    "overrides",
    [
        (),
        ("numerics.pressure_form=riemann", "numerics.viscosity={type: none}"),
        ("numerics.viscosity={type: laminar}", "boundaries.left_tank.slip=no_slip", *THICK),
        ("numerics.wall={type: repulsive}",),
        ("numerics.precision=double",),
    ],
)
def test_accelerations_do_not_depend_on_the_number_of_lanes(overrides: Sequence[str]) -> None:
    velocity = 'fluids.square.velocity=["sin(3 * y)", "cos(5 * x)"]'
    simulation = Simulation(load_scene("dam_break_2d", ["spacing=0.1", velocity, *overrides]), "cpu", 1)
    for _ in range(3):
        simulation.step()
    plain, blocked = (_accelerations(simulation, lanes) for lanes in (1, 8))
    scale = np.abs(plain).max()
    assert scale > 1.0
    np.testing.assert_allclose(blocked, plain, rtol=0.0, atol=ROUNDING * scale)


@pytest.mark.parametrize(("dimension", "count"), [(2, 8), (3, 16)])
def test_blocks_hold_the_components_of_matrices(dimension: int, count: int) -> None:
    arithmetic = Arithmetic(dimension, "single")
    lanes, width = make_lanes(arithmetic, count), dimension**2
    entries = np.arange(40.0 * width).reshape(40, dimension, dimension)
    row = np.random.default_rng(1).integers(0, 40, size=(1, count)).astype(np.int32)

    @wp.kernel(module=f"test_matrix_lanes_{dimension}", enable_backward=False)
    def load(
        neighbours: wp.array2d(dtype=wp.int32),
        array: wp.array(dtype=arithmetic.matrix),
        out: wp.array(dtype=arithmetic.real),
        total: wp.array(dtype=arithmetic.matrix),
    ):
        block = lanes.matrices(array, lanes.take(neighbours, 0, 0, count), 0)
        for k in range(wp.static(count * width)):
            out[k] = block[k]
        total[0] = lanes.fold_tensor(block)

    out = wp.zeros(count * width, dtype=arithmetic.real, device="cpu")
    total = wp.zeros(1, dtype=arithmetic.matrix, device="cpu")
    array = wp.array(entries, dtype=arithmetic.matrix, device="cpu")
    wp.launch(load, 1, inputs=[wp.array(row, dtype=wp.int32, device="cpu"), array, out, total], device="cpu")
    np.testing.assert_array_equal(out.numpy().reshape(width, count), entries[row[0]].reshape(count, width).T)
    np.testing.assert_array_equal(total.numpy()[0], entries[row[0]].sum(axis=0))


@pytest.mark.parametrize(
    ("scene", "overrides"),
    [
        ("taylor_green", ("spacing=0.05",)),
        ("taylor_green", ("spacing=0.05", "numerics.particle_order.density_follows=true")),
        ("taylor_green", ("spacing=0.05", "numerics.density_diffusion={type: delta_sph}")),
        ("rotating_patch", ("spacing=0.05",)),
        ("stenosis", ("spacing=8e-4",)),
    ],
)
def test_runs_do_not_depend_on_the_number_of_lanes(
    scene: str, overrides: Sequence[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def velocities() -> np.ndarray:
        simulation = Simulation(load_scene(scene, [*overrides, "numerics.precision=double"]), "cpu", 1)
        for _ in range(5):
            simulation.step()
        (fluid,) = simulation.frame(["velocity"]).of_kind("fluid")
        return fluid.fields["velocity"]

    blocked = velocities()
    monkeypatch.setattr("warpsph.particles.launch.ON_CPU", {2: 1, 3: 1})
    plain = velocities()
    assert not np.array_equal(blocked, plain)  # they differ by rounding: other code has run
    np.testing.assert_allclose(blocked, plain, rtol=0.0, atol=1e-10 * np.abs(plain).max())


def _accelerations(simulation: Simulation, lanes: int) -> np.ndarray:
    parts = simulation.system.parts
    a, rows, walls = parts.assembly, parts.search.rows[0], parts.walls.model.walls
    kernels = make_fluid_kernels(replace(a.options, lanes=lanes))
    out = wp.zeros(a.layout.total, dtype=a.options.arithmetic.vector, device="cpu")
    lists = (rows.index, rows.ends, a.scratch.position_pressure, a.state.velocity_volume)
    surface = (walls.surface.friction, walls.surface.normal, a.layout.fluids)
    wp.launch(
        kernels.accelerate,
        parts.fluid.count,
        inputs=[0, a.constants, *lists, *surface, out],
        device="cpu",
    )
    return np.array(out.numpy()[: parts.fluid.count])
