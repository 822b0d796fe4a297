"""Formulas that a program adds: refused where they contradict themselves, and equal to the built-in ones."""

import numpy as np
import pytest
import warp as wp
from builders import channel, still_tank
from registries import restored_registries
from warpsph_kernels.pair_terms import make_constants_struct

from warpsph import Simulation, register_smoothing_kernel, register_state, register_viscosity
from warpsph.laws.states import STATE_LAWS


def make_own_c2(a):
    real = a.real

    def shape(q: real):
        s = wp.max(real(1.0) - real(0.5) * q, real(0.0))
        return s * s * s * s * (real(2.0) * q + real(1.0))

    def slope(q: real):
        s = wp.max(real(1.0) - real(0.5) * q, real(0.0))
        return real(-5.0) * s * s * s

    return shape, slope


def make_cubic_state(a):
    """Tait's equation with an exponent of 3: e + e^2 + e^3 / 3."""
    real, parameters = a.real, a.parameters

    def cubic(deviation: real, rest_density: real, sound_speed: real, numbers: parameters):
        e = deviation / rest_density
        return rest_density * sound_speed * sound_speed * e * (real(1.0) + e * (real(1.0) + e / real(3.0)))

    return cubic


def make_stiff_state(a):
    real, parameters = a.real, a.parameters

    def stiff(deviation: real, rest_density: real, sound_speed: real, numbers: parameters):
        return numbers[0] * sound_speed * sound_speed * deviation

    return stiff


def make_own_laminar(a):
    real, vector, constants = a.real, a.vector, make_constants_struct(a)

    def own_laminar(c: constants, x_ab: vector, v_ab: vector, r2: real):
        return real(2.0) * c.viscosity_parameters[0] * v_ab

    return own_laminar


@pytest.fixture(scope="module", autouse=True)
def _own_formulas():
    with restored_registries():
        register_smoothing_kernel("own_c2", 2.0, make_own_c2)
        register_state("cubic", make_cubic_state)
        register_state("stiff", make_stiff_state, parameters=["factor"])
        register_viscosity("own_laminar", make_own_laminar, parameters=["mu"])
        yield


def positions(scene, steps: int = 30) -> np.ndarray:
    sim = Simulation(scene, device="cpu")
    for _ in range(steps):
        sim.step()
    return sim.frame().sets[0].fields["position"]


@pytest.mark.parametrize("dimension", [2, 3])
def test_an_own_kernel_is_as_good_as_a_built_in_one(dimension):
    own = still_tank(dimension, numerics={"kernel": "own_c2", "precision": "double"})
    built_in = still_tank(dimension, numerics={"precision": "double"})
    # The norm by quadrature agrees to 1e-12 with the closed form.
    assert positions(own) == pytest.approx(positions(built_in), abs=1e-10)


def test_an_own_state_is_as_good_as_a_built_in_one():
    custom = {"type": "custom", "law": "cubic"}
    own = still_tank(numerics={"state": custom, "precision": "double"})
    built_in = still_tank(numerics={"state": {"type": "tait", "gamma": 3.0}, "precision": "double"})
    # The table's inverse sets the initial densities to 1e-9, the difference quotient the step to 1e-8.
    assert positions(own) == pytest.approx(positions(built_in), abs=1e-8)


@pytest.mark.parametrize("strain", [-0.02, -1e-4, 1e-4, 0.02])
def test_inverse_and_energy_of_an_own_state(strain):
    own, tait = STATE_LAWS["cubic"], STATE_LAWS["tait"]
    pressure = 1000.0 * 900.0 * np.array([strain * (1.0 + strain * (1.0 + strain / 3.0))])
    # Linear interpolation between strains 2.5e-5 apart: h^2 / 8 R'' = 2e-10, beside a strain of 1e-4.
    assert own.deviation(pressure, 1000.0, 9.0e5, ()) == pytest.approx(1000.0 * strain, rel=1e-4)
    density = np.array([1000.0 * (1.0 + strain)])
    expected = tait.energy(density, pressure, 1000.0, (3.0,))
    assert own.energy(density, pressure, 1000.0, ()) == pytest.approx(expected, rel=1e-4)


def test_an_own_viscosity_is_as_good_as_a_built_in_one():
    custom = {"type": "custom", "law": "own_laminar", "parameters": {"mu": 1.0e-3}}
    ends = []
    for viscosity in (custom, {"type": "laminar"}):
        sim = Simulation(channel(10, drive=2e-4, numerics={"viscosity": viscosity}), device="cpu")
        sim.advance(0.02)
        ends.append(sim.frame(["velocity"]).sets[0].fields["velocity"])
    assert np.array_equal(*ends)


def test_a_slope_that_is_no_derivative_is_refused():
    def wrong(a):
        shape, slope = make_own_c2(a)
        return slope, shape

    with pytest.raises(ValueError, match="f'"):
        register_smoothing_kernel("wrong", 2.0, wrong)


def test_a_taken_name_is_refused():
    with pytest.raises(ValueError, match="already"):
        register_state("tait", make_cubic_state)


def test_a_state_of_another_sound_speed_is_refused():
    state = {"type": "custom", "law": "stiff", "parameters": {"factor": 2.0}}
    with pytest.raises(ValueError, match="slope 2"):
        Simulation(still_tank(numerics={"state": state}), device="cpu")


def test_a_scene_hears_which_laws_and_parameters_there_are():
    with pytest.raises(ValueError, match="cubic, stiff"):
        still_tank(numerics={"state": {"type": "custom", "law": "cubik"}})
    with pytest.raises(ValueError, match="factor"):
        still_tank(numerics={"state": {"type": "custom", "law": "stiff"}})
    with pytest.raises(ValueError, match="no such kernel"):
        still_tank(numerics={"kernel": "own_c3"})
