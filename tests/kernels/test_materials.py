"""Constitutive laws against their own energy, Hooke's law and values worked out by hand."""

from functools import cache

import numpy as np
import pytest
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.materials import LAWS, LawOptions, make_material_struct

YOUNG, NU = 2.0e5, 0.3
LAME, MU = YOUNG * NU / ((1 + NU) * (1 - 2 * NU)), YOUNG / (2 * (1 + NU))
BULK = LAME + 2.0 / 3.0 * MU

STATES = [(2, False), (2, True), (3, False)]
"""Dimension, and whether the plane is free of stress across it."""
CASES = [
    (law, dim, plane_stress)
    for law in LAWS
    for dim, plane_stress in STATES
    if not (law == "split_neo_hookean" and plane_stress)
]
OBJECTIVE = [case for case in CASES if case[0] != "linear_elastic"]


@cache
def evaluations(dim: int, precision: str):
    """Kernels of all laws of a dimension and precision, by law and plane state; they share a module, built once."""
    return {
        (law, plane_stress): evaluation(law, dim, plane_stress, precision)
        for law, of_dim, plane_stress in CASES
        if of_dim == dim
    }


def evaluation(law: str, dim: int, plane_stress: bool, precision: str):
    arithmetic = Arithmetic(dim, precision)
    real, matrix, material = arithmetic.real, arithmetic.matrix, make_material_struct(arithmetic)
    stress_of = LAWS[law](LawOptions(arithmetic, plane_stress))

    def evaluate(
        gradient: wp.array(dtype=matrix),
        p: material,
        stress: wp.array(dtype=matrix),
        scalars: wp.array2d(dtype=real),
    ):
        i = wp.tid()
        P, psi, P_33 = stress_of(gradient[i], p)
        stress[i] = P
        scalars[i, 0] = psi
        scalars[i, 1] = P_33

    module = wp.get_module(f"test_materials_{arithmetic.label}")
    return wp.Kernel(evaluate, key=f"{law}_{plane_stress}", module=module, options={"enable_backward": False})


def respond(law, dim, plane_stress, gradients, precision="double"):
    """P (n, dim, dim) [Pa], psi (n,) [Pa] and P_33 (n,) [Pa] at displacement gradients (n, dim, dim)."""
    arithmetic = Arithmetic(dim, precision)
    kernel, matrix = evaluations(dim, precision)[law, plane_stress], arithmetic.matrix
    numbers = make_material_struct(arithmetic)()
    numbers.lame, numbers.shear_modulus, numbers.bulk_modulus = LAME, MU, BULK
    stress = wp.zeros(len(gradients), dtype=matrix, device="cpu")
    scalars = wp.zeros((len(gradients), 2), dtype=arithmetic.real, device="cpu")
    given = wp.array(np.asarray(gradients), dtype=matrix, device="cpu")
    wp.launch(kernel, len(gradients), inputs=[given, numbers, stress, scalars], device="cpu")
    return stress.numpy(), *scalars.numpy().T


def random_gradients(dim: int, size: float, count: int = 20) -> np.ndarray:
    """Gradients with entries up to a size; up to 0.3 no element is inverted."""
    return np.random.default_rng(1).uniform(-size, size, (count, dim, dim))


def turned(dim: int) -> np.ndarray:
    """A rotation about no axis of the coordinates."""
    c, s = np.cos(0.7), np.sin(0.7)
    if dim == 2:
        return np.array([[c, -s], [s, c]])
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, s, -c], [0, c, s]])


def hooke(gradients: np.ndarray, plane_stress: bool) -> np.ndarray:
    """lambda tr(e) I + 2 mu e; in plane stress E/(1 - nu^2) [(1 - nu) e + nu tr(e) I]."""
    e = 0.5 * (gradients + np.swapaxes(gradients, 1, 2))
    volumetric = np.trace(e, axis1=1, axis2=2)[:, None, None] * np.eye(gradients.shape[1])
    if plane_stress:
        return YOUNG / (1.0 - NU**2) * ((1.0 - NU) * e + NU * volumetric)
    return LAME * volumetric + 2.0 * MU * e


@pytest.mark.parametrize(("law", "dim", "plane_stress"), CASES)
def test_stress_is_the_derivative_of_the_energy(law, dim, plane_stress):
    """P = dpsi/dF. Central differences with d = 1e-5 err by d^2 = 1e-10 and by rounding over d, 1e-11, of E."""
    gradients, d = random_gradients(dim, 0.3), 1e-5
    stress, _, _ = respond(law, dim, plane_stress, gradients)
    for i in range(dim):
        for j in range(dim):
            change = np.zeros((dim, dim))
            change[i, j] = d
            above, below = (respond(law, dim, plane_stress, gradients + s * change)[1] for s in (1, -1))
            assert stress[:, i, j] == pytest.approx((above - below) / (2 * d), abs=1e-8 * YOUNG)


@pytest.mark.parametrize(("law", "dim", "plane_stress"), CASES)
def test_small_strains_follow_hooke(law, dim, plane_stress):
    """What is left is of second order in the strain: halving it divides the difference by four."""
    differences = []
    for size in (1e-3, 5e-4):
        gradients = random_gradients(dim, 1.0) * size
        stress, energy, _ = respond(law, dim, plane_stress, gradients)
        expected = hooke(gradients, plane_stress)
        differences.append(np.abs(stress - expected).max())
        e = 0.5 * (gradients + np.swapaxes(gradients, 1, 2))
        assert energy == pytest.approx(0.5 * np.einsum("nij,nij->n", expected, e), rel=20 * size)
    assert differences[0] < 20 * YOUNG * 1e-3**2
    assert differences[1] <= 0.26 * differences[0] + 1e-15 * YOUNG


@pytest.mark.parametrize(("law", "dim", "plane_stress"), CASES)
def test_rest_is_free_of_stress_and_energy(law, dim, plane_stress):
    for precision in ("single", "double"):
        response = respond(law, dim, plane_stress, np.zeros((1, dim, dim)), precision)
        assert all((part == 0.0).all() for part in response)


@pytest.mark.parametrize(("law", "dim", "plane_stress"), OBJECTIVE)
def test_a_rotation_costs_nothing(law, dim, plane_stress):
    stress, energy, across = respond(law, dim, plane_stress, [turned(dim) - np.eye(dim)])
    assert np.abs(stress).max() < 1e-14 * YOUNG
    assert abs(energy[0]) < 1e-14 * YOUNG
    assert abs(across[0]) < 1e-14 * YOUNG


@pytest.mark.parametrize(("law", "dim", "plane_stress"), OBJECTIVE)
def test_stress_turns_with_the_body(law, dim, plane_stress):
    """P(R F) = R P(F) and psi(R F) = psi(F)."""
    R, gradients = turned(dim), random_gradients(dim, 0.3)
    stress, energy, across = respond(law, dim, plane_stress, gradients)
    moved = np.einsum("ij,njk->nik", R, gradients + np.eye(dim)) - np.eye(dim)
    stress_moved, energy_moved, across_moved = respond(law, dim, plane_stress, moved)
    assert stress_moved == pytest.approx(np.einsum("ij,njk->nik", R, stress), abs=1e-13 * YOUNG)
    assert energy_moved == pytest.approx(energy, abs=1e-13 * YOUNG)
    assert across_moved == pytest.approx(across, abs=1e-13 * YOUNG)


def uniaxial_by_hand(law: str, s: float) -> tuple[float, float]:
    """P_11 and psi of the stretch F = diag(s, 1, 1), each law written out for it."""
    if law == "st_venant_kirchhoff":  # E_11 = (s^2 - 1)/2
        E = 0.5 * (s**2 - 1.0)
        return s * (LAME + 2.0 * MU) * E, 0.5 * (LAME + 2.0 * MU) * E**2
    if law == "linear_elastic":
        return (LAME + 2.0 * MU) * (s - 1.0), 0.5 * (LAME + 2.0 * MU) * (s - 1.0) ** 2
    if law == "neo_hookean":  # J = s
        log = np.log(s)
        return MU * (s - 1.0 / s) + LAME * log / s, 0.5 * MU * (s**2 - 1 - 2 * log) + 0.5 * LAME * log**2
    shape = s ** (-2.0 / 3.0)
    energy = 0.5 * MU * (shape * (s**2 + 2.0) - 3.0) + 0.5 * BULK * (s - 1.0) ** 2
    return MU * shape * (2.0 / 3.0) * (s - 1.0 / s) + BULK * (s - 1.0), energy


@pytest.mark.parametrize(("law", "dim"), [(law, dim) for law in LAWS for dim in (2, 3)])
@pytest.mark.parametrize("stretch", [0.5, 1.2, 3.0])
def test_uniaxial_stretch_has_the_value_worked_out_by_hand(law, dim, stretch):
    gradient = np.zeros((1, dim, dim))
    gradient[0, 0, 0] = stretch - 1.0
    stress, energy, across = respond(law, dim, False, gradient)
    by_hand, energy_by_hand = uniaxial_by_hand(law, stretch)
    assert stress[0, 0, 0] == pytest.approx(by_hand, rel=1e-12)
    assert energy[0] == pytest.approx(energy_by_hand, rel=1e-12)
    # In plane strain the stress across the plane is that of three dimensions.
    solid, _, _ = respond(law, 3, False, [np.diag([stretch - 1.0, 0.0, 0.0])])
    assert across[0] == pytest.approx(solid[0, 2, 2] if dim == 2 else 0.0, rel=1e-12)


@pytest.mark.parametrize("stretch", [0.3, 0.9, 1.0, 1.5, 3.0])
@pytest.mark.parametrize(("precision", "rounding"), [("single", 3e-6), ("double", 1e-12)])
def test_plane_stress_neo_hookean_finds_the_thickness(stretch, precision, rounding):
    """At F = s I in the plane: mu (t^2 - 1) + lambda ln(s^2 t) = 0, solved here by bisection."""
    low, high = 1e-6, 1e6
    for _ in range(200):
        t = np.sqrt(low * high)
        low, high = (low, t) if MU * (t**2 - 1) + LAME * np.log(stretch**2 * t) > 0 else (t, high)
    expected = (MU * (stretch**2 - 1) + LAME * np.log(stretch**2 * t)) / stretch
    stress, _, across = respond("neo_hookean", 2, True, [(stretch - 1.0) * np.eye(2)], precision)
    assert stress[0] == pytest.approx(expected * np.eye(2), abs=rounding * max(abs(expected), YOUNG))
    assert across[0] == 0.0


@pytest.mark.parametrize(("law", "dim", "plane_stress"), CASES)
@pytest.mark.parametrize("size", [1e-6, 0.2])
def test_single_precision_keeps_the_digits_of_a_strain(law, dim, plane_stress, size):
    """A dozen roundings of 6e-8 each; F itself would have kept only 6e-8/size of a strain."""
    gradients = np.float32(random_gradients(dim, size)).astype(np.float64)
    single, energy_single, _ = respond(law, dim, plane_stress, gradients, "single")
    double, energy_double, _ = respond(law, dim, plane_stress, gradients)
    assert np.abs(single - double).max() < 2e-6 * np.abs(double).max()
    assert np.abs(energy_single - energy_double).max() < 2e-6 * np.abs(energy_double).max()
