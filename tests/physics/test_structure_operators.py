"""Gradient, stress and force of structures: what holds for any displacement, without a step in time."""

from functools import cache

import numpy as np
import pytest
from structure_builders import (
    NU,
    YOUNG,
    block,
    deform,
    elastic_energy,
    forces,
    gradients,
    inside_of,
    jittered,
    reference_of,
    system_of,
)

SIZES = {2: (0.9, 0.8), 3: (0.6, 0.7, 0.6)}
ROUNDING = {"single": 6e-8, "double": 1.1e-15}
"""Relative error of one operation; in double precision that of a displacement of a metre, over a spacing of 0.1 m."""


@cache
def system(dim: int, precision: str = "double", jitter: bool = False, **changes):
    scene = block(SIZES[dim], precision=precision, **changes)
    return system_of(scene, jittered(scene) if jitter else None)


def rotation(dim: int, degrees: float) -> np.ndarray:
    """About the z axis, in three dimensions about x afterwards."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    if dim == 2:
        return np.array([[c, -s], [s, c]])
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]]) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("precision", ["single", "double"])
@pytest.mark.parametrize("jitter", [False, True])
def test_an_affine_displacement_has_its_gradient_everywhere(dim, precision, jitter):
    """Some 20 neighbours, each with a few roundings of terms of the size of the gradient."""
    one = system(dim, precision, jitter)
    gradient = np.random.default_rng(0).uniform(-0.3, 0.3, (dim, dim))
    deform(one, reference_of(one) @ gradient.T + 0.1)
    assert np.abs(gradients(one) - gradient).max() < 20 * ROUNDING[precision]


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("precision", ["single", "double"])
@pytest.mark.parametrize("jitter", [False, True])
def test_a_uniform_stress_exerts_no_force_inside(dim, precision, jitter):
    """On scattered particles as on a lattice; inside are the particles that are inside of the lattice."""
    one = system(dim, precision, jitter)
    gradient = np.random.default_rng(0).uniform(-0.3, 0.3, (dim, dim))
    deform(one, reference_of(one) @ gradient.T)
    inner = inside_of(system(dim, precision))
    assert inner.any()
    face = 0.1 ** (dim - 1)  # area of a particle's side: the surface feels the stress times it
    assert np.abs(forces(one)[inner]).max() < 200 * ROUNDING[precision] * YOUNG * face
    assert np.abs(forces(one)[~inner]).max() > 0.1 * YOUNG * face


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("precision", ["single", "double"])
@pytest.mark.parametrize("jitter", [False, True])
@pytest.mark.parametrize("degrees", [37.0, 90.0])
def test_a_rigid_rotation_is_free_of_stress_and_force(dim, precision, jitter, degrees):
    """H is of size one and rounded; so the stress is zero to some roundings of Young's modulus."""
    one = system(dim, precision, jitter)
    deform(one, reference_of(one) @ (rotation(dim, degrees) - np.eye(dim)).T)
    stress = one.frame_sets(("cauchy_stress",), ordered=True)[0].fields["cauchy_stress"]
    assert np.abs(stress).max() < 20 * ROUNDING[precision] * YOUNG
    assert np.abs(forces(one)).max() < 200 * ROUNDING[precision] * YOUNG * 0.1 ** (dim - 1)
    # Each term of an energy is a square of roundings.
    assert elastic_energy(one) < 1e4 * ROUNDING[precision] ** 2 * YOUNG


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("precision", ["single", "double"])
@pytest.mark.parametrize("jitter", [False, True])
def test_internal_forces_have_neither_resultant_nor_torque(dim, precision, jitter):
    """Pairs are antisymmetric; and the energy does not change with a rotation, about the deformed places."""
    one = system(dim, precision, jitter)
    X = reference_of(one)
    u = np.random.default_rng(2).uniform(-0.02, 0.02, X.shape)
    deform(one, u)
    force = forces(one)
    size = np.abs(force).sum()
    assert np.abs(force.sum(axis=0)).max() < 4 * ROUNDING[precision] * size
    x = X + u
    i, j = np.triu_indices(dim, 1)
    torque = (x[:, i] * force[:, j] - x[:, j] * force[:, i]).sum(axis=0)
    assert np.abs(torque).max() < 20 * ROUNDING[precision] * size


LAWS = [
    ("st_venant_kirchhoff", 2, "strain"),
    ("st_venant_kirchhoff", 2, "stress"),
    ("neo_hookean", 2, "strain"),
    ("neo_hookean", 2, "stress"),
    ("split_neo_hookean", 2, "strain"),
    ("linear_elastic", 2, "strain"),
    ("st_venant_kirchhoff", 3, "strain"),
    ("neo_hookean", 3, "strain"),
]


@pytest.mark.parametrize(("law", "dim", "plane"), LAWS)
@pytest.mark.parametrize("jitter", [False, True])
def test_forces_are_the_gradient_of_the_reported_energy(law, dim, plane, jitter):
    """f = -dE/du, strain and hourglass energy together; central differences with d = 1e-6 err by some 1e-9 of f."""
    scene = block(
        (0.4,) * dim,
        material={"law": law},
        structure={"plane": plane},
    )
    one = system_of(scene, jittered(scene) if jitter else None)
    u = np.random.default_rng(4).uniform(-0.015, 0.015, reference_of(one).shape)
    deform(one, u)
    force = forces(one)
    energies = one.ledger().energies
    assert energies["strain"] > 0.0
    assert energies["hourglass"] > 0.0
    d = 1e-6
    for particle, axis in [(0, 0), (3, 1), (len(u) // 2, 0), (len(u) // 2, 1), (len(u) - 1, dim - 1)]:
        shift = np.zeros_like(u)
        shift[particle, axis] = d
        sides = []
        for sign in (1.0, -1.0):
            deform(one, u + sign * shift)
            sides.append(elastic_energy(one))
        slope = (sides[0] - sides[1]) / (2.0 * d)
        assert force[particle, axis] == pytest.approx(-slope, abs=1e-7 * np.abs(force).max())


def test_a_uniaxial_stretch_stores_the_energy_of_the_material():
    """E = V (lambda + 2 mu)/2 E_11^2 with E_11 = (s^2 - 1)/2, without a share of the hourglass penalty."""
    one = system(2)
    deform(one, reference_of(one) * [0.1, 0.0])
    lame, mu = YOUNG * NU / ((1 + NU) * (1 - 2 * NU)), YOUNG / (2 * (1 + NU))
    expected = 0.9 * 0.8 * 0.5 * (lame + 2 * mu) * (0.5 * (1.1**2 - 1)) ** 2
    energies = one.ledger().energies
    assert energies["strain"] == pytest.approx(expected, rel=1e-12)
    assert energies["hourglass"] < 1e-20 * expected


def test_stresses_of_a_uniaxial_stretch():
    """Cauchy sigma = F S F^T / J with S = lambda tr(E) I + 2 mu E; also across the plane; and von Mises of them."""
    one = system(2)
    deform(one, reference_of(one) * [0.1, 0.0])
    lame, mu = YOUNG * NU / ((1 + NU) * (1 - 2 * NU)), YOUNG / (2 * (1 + NU))
    s, E = 1.1, 0.5 * (1.1**2 - 1)
    sigma = np.array([s * (lame + 2 * mu) * E, lame * E / s, lame * E / s])
    names = ("cauchy_stress", "von_mises", "green_lagrange_strain", "volume_ratio")
    fields = one.frame_sets(names, ordered=True)[0].fields
    assert fields["cauchy_stress"] == pytest.approx(np.tile(np.diag(sigma), (72, 1, 1)), abs=1e-9 * YOUNG)
    assert fields["von_mises"] == pytest.approx(sigma[0] - sigma[1], rel=1e-12)
    assert fields["green_lagrange_strain"][:, 0, 0] == pytest.approx(E, rel=1e-12)
    assert fields["volume_ratio"] == pytest.approx(s, rel=1e-12)


def test_the_hourglass_penalty_sees_what_the_gradient_does_not():
    """Inside a lattice a checkerboard has no gradient: all its energy is the penalty's, none without a penalty."""
    energies = {}
    for zeta in (0.0, 0.5):
        one = system(2, hourglass=zeta)
        X = reference_of(one)
        cells = np.rint(X / 0.1 - 0.5).astype(int)
        deform(one, 1e-3 * np.where(cells.sum(axis=1) % 2, 1.0, -1.0)[:, None] * [1.0, 0.0])
        inner = inside_of(one)
        assert np.abs(gradients(one)[inner]).max() < 1e-15
        energies[zeta] = one.ledger().energies
        strongest = np.abs(forces(one)[inner]).max()
        assert strongest > 1e-3 * zeta * YOUNG * 0.1 if zeta else strongest < 1e-9
    assert energies[0.0]["hourglass"] == 0.0
    assert energies[0.5]["hourglass"] > 0.0


def test_a_clamp_has_no_energy_and_pulls_by_the_gradient_of_the_rest():
    """Rigid particles move as the clamp says; f = -dE/du on the free ones, and the clamp's reaction balances them."""
    held = {"root": {"region": {"type": "box", "min": (0.0, 0.0), "max": (0.2, 0.4)}}}
    one = system_of(block((0.6, 0.4), structure={"clamps": held}))
    X = reference_of(one)
    free = X[:, 0] > 0.2
    u = np.where(free[:, None], np.random.default_rng(4).uniform(-0.015, 0.015, X.shape), 0.0)
    deform(one, u)
    force = forces(one)
    assert (gradients(one)[~free] == 0.0).all()
    assert np.abs(force.sum(axis=0)).max() < 1e-12 * np.abs(force).sum()
    for particle in np.flatnonzero(free)[[0, 1, 5, -1]]:
        shift = np.zeros_like(u)
        shift[particle, 1] = 1e-6
        sides = []
        for sign in (1.0, -1.0):
            deform(one, u + sign * shift)
            sides.append(elastic_energy(one))
        slope = (sides[0] - sides[1]) / 2e-6
        assert force[particle, 1] == pytest.approx(-slope, abs=1e-7 * np.abs(force).max())
