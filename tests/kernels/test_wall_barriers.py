"""The repulsion of wall surfaces against its formula, by hand."""

import numpy as np
import pytest
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.pair_terms import make_constants_struct
from warpsph_kernels.wall_barriers import make_repulsion

SPACING, SMOOTHING_LENGTH, DENSITY, SOUND_SPEED = 0.1, 0.15, 1000.0, 20.0
UNIT = 0.01 * DENSITY * SOUND_SPEED**2 / SPACING**2
"""0.01 rho0 c0^2 / V_w with V_w = dp^2 [N/m^4]."""


def repulsion(offsets: np.ndarray, normal: tuple[float, float] = (0.0, 1.0)) -> np.ndarray:
    arithmetic = Arithmetic(2, "double")
    vector, constants_type = arithmetic.vector, make_constants_struct(arithmetic)
    force_of = make_repulsion(arithmetic)
    c = constants_type()
    c.inverse_spacing, c.inverse_h, c.smoothing_length = (
        1.0 / SPACING,
        1.0 / SMOOTHING_LENGTH,
        SMOOTHING_LENGTH,
    )
    c.rest_density, c.sound_speed, c.wall_volume = DENSITY, SOUND_SPEED, SPACING**2

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
