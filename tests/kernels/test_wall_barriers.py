"""The forces of wall surfaces against their formulas, by hand, and the work of the barrier."""

import numpy as np
import pytest
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.pair_terms import make_barrier, make_constants_struct
from warpsph_kernels.wall_barriers import make_repulsion

SPACING, SMOOTHING_LENGTH, DENSITY, SOUND_SPEED = 0.1, 0.15, 1000.0, 20.0
UNIT = 0.01 * DENSITY * SOUND_SPEED**2 / SPACING**2
"""0.01 rho0 c0^2 / V_w with V_w = dp^2 [N/m^4]."""


REACH, STRENGTH = 0.06, 3.0
"""D of the barrier [m] and its B [N/m^4]."""


def forces(make, offsets: np.ndarray, normal: tuple[float, float]) -> np.ndarray:
    arithmetic = Arithmetic(2, "double")
    vector, constants_type = arithmetic.vector, make_constants_struct(arithmetic)
    force_of = make(arithmetic)
    c = constants_type()
    c.inverse_spacing, c.inverse_h, c.smoothing_length = (
        1.0 / SPACING,
        1.0 / SMOOTHING_LENGTH,
        SMOOTHING_LENGTH,
    )
    c.rest_density, c.sound_speed, c.wall_volume = DENSITY, SOUND_SPEED, SPACING**2
    c.barrier, c.inverse_barrier_reach = STRENGTH, 1.0 / REACH

    @wp.kernel(module="unique", enable_backward=False)
    def evaluate(
        constants: constants_type, x: wp.array(dtype=vector), n: vector, value: wp.array(dtype=vector)
    ):
        i = wp.tid()
        value[i] = force_of(constants, x[i], n)

    value = wp.zeros(len(offsets), dtype=vector, device="cpu")
    places = wp.array(offsets, dtype=vector, device="cpu")
    wp.launch(evaluate, len(offsets), inputs=[c, places, vector(*normal), value], device="cpu")
    return value.numpy()


def repulsion(offsets: np.ndarray, normal: tuple[float, float] = (0.0, 1.0)) -> np.ndarray:
    return forces(make_repulsion, offsets, normal)


def barrier(offsets: np.ndarray, normal: tuple[float, float] = (0.0, 1.0)) -> np.ndarray:
    return forces(make_barrier, offsets, normal)


@pytest.mark.parametrize(
    ("r", "f"),
    [
        (0.03, 2.0 / 3.0),  # eta = 0.2667
        (0.09, 2.0 * 0.8 - 1.5 * 0.64),  # eta = 0.8
        (0.135, 0.5 * (2.0 - 1.2) ** 2),  # eta = 1.2
    ],
)
def test_repulsion_by_hand_in_each_branch(r, f):
    """chi f / r along the line of the pair, with chi = 1 - r / 0.15 and eta = r / 0.1125."""
    (force,) = repulsion(np.array([[0.6 * r, 0.8 * r]]))
    assert force == pytest.approx(np.array([0.6, 0.8]) * UNIT * (1.0 - r / 0.15) * f / r, rel=1e-12)


def test_repulsion_ends_at_one_and_a_half_spacings():
    assert not repulsion(np.array([[0.0, 0.15], [0.2, 0.0]])).any()


def test_particles_behind_the_surface_do_not_repel():
    assert not repulsion(np.array([[0.0, 0.05]]), normal=(0.0, 0.0)).any()


@pytest.mark.parametrize(("d", "push"), [(0.03, 0.5), (-0.02, 1.0)])
def test_barrier_pushes_straight_out_on_its_axis(d, push):
    """B min(1 - d / 0.06, 1) along the normal."""
    (force,) = barrier(np.array([[0.0, d]]))
    assert force == pytest.approx(np.array([0.0, STRENGTH * push]), rel=1e-12, abs=1e-15)


def test_barrier_ends_at_its_reach_and_a_spacing_off_its_axis():
    assert not barrier(np.array([[0.0, 0.06], [0.1, 0.0], [0.0, -0.05]])).any()


def test_barrier_of_a_flat_row_has_no_component_along_it():
    """The weights of particles a spacing apart sum up to one: (1 - q)^2 (1 + 2 q) + q^2 (3 - 2 q) = 1."""
    places = np.linspace(0.0, SPACING, 21)
    row = SPACING * np.arange(-2, 4)
    offsets = np.stack(np.broadcast_arrays(places[:, None] - row, 0.03), axis=-1)
    total = barrier(offsets.reshape(-1, 2)).reshape(len(places), len(row), 2).sum(axis=1)
    assert total == pytest.approx(np.tile((0.0, 0.5 * STRENGTH), (len(places), 1)), abs=1e-13)


def test_barrier_does_no_work_on_a_closed_way():
    """In from the side, out along the normal and back outside, around an oblique normal as at a corner.

    The trapezoidal rule with 4000 points errs by about their square, 1e-7 of the energies on the way.
    """
    angle = np.linspace(0.0, 2.0 * np.pi, 4001)
    way = np.array([0.055, 0.045]) + 0.05 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    force = barrier(way, normal=(0.5**0.5, 0.5**0.5))
    steps = np.diff(way, axis=0)
    work = np.einsum("ij,ij->i", 0.5 * (force[1:] + force[:-1]), steps)
    assert np.abs(work).sum() > 0.01 * STRENGTH * REACH
    assert abs(work.sum()) < 1e-5 * np.abs(work).sum()
