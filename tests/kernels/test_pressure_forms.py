"""Pressure forms against their formulas, for one pair."""

import numpy as np
import pytest
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.pair_terms import PRESSURE_FORMS, make_constants_struct

RHO, C0, H = 1000.0, 20.0, 0.1


def pair_pressure(form: str, u_ab: tuple[float, float], x_ab=(0.06, 0.08), p=(100.0, 300.0)) -> float:
    arithmetic = Arithmetic(2, "double")
    constants, vector = make_constants_struct(arithmetic), arithmetic.vector
    function = PRESSURE_FORMS[form](arithmetic)

    @wp.kernel(module="unique", enable_backward=False)
    def evaluate(
        c: constants, x: vector, u: vector, p_a: wp.float64, p_b: wp.float64, out: wp.array(dtype=wp.float64)
    ):
        out[0] = function(c, x, u, wp.dot(x, x), p_a, p_b)

    c = constants()
    c.rest_density, c.sound_speed, c.smoothing_length = RHO, C0, H
    out = wp.zeros(1, dtype=wp.float64, device="cpu")
    wp.launch(evaluate, 1, inputs=[c, vector(*x_ab), vector(*u_ab), *p, out], device="cpu")
    return float(out.numpy()[0])


def test_symmetric_is_the_sum():
    assert pair_pressure("symmetric", (1.0, 1.0)) == 400.0


@pytest.mark.parametrize(
    ("approach", "expected"),
    [
        (-2.0, 0.0),  # parting: no dissipation
        (0.5, RHO * 3.0 * 0.5 * 0.5),  # slow: rho0 3 u^2
        (10.0, RHO * C0 * 10.0),  # fast: the full solver, rho0 c0 u
    ],
)
def test_riemann_dissipates_only_what_comes_together(approach, expected):
    # x_ab = 0.1 (0.6, 0.8); what moves across the line of the pair has no part in it.
    along, across = np.array([0.6, 0.8]), np.array([-0.8, 0.6])
    u_ab = tuple(-approach * along + 5.0 * across)
    assert pair_pressure("riemann", u_ab) == pytest.approx(400.0 + expected, rel=1e-12)


def test_a_pair_at_one_place_has_a_finite_pressure():
    assert pair_pressure("riemann", (1.0, 0.0), x_ab=(0.0, 0.0)) == 400.0
