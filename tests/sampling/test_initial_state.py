"""Initial pressure and velocity of fluids."""

import numpy as np
import pytest

from warpsph.sampling.initial_state import initial_field, initial_pressure
from warpsph.scene.errors import SceneError
from warpsph.scene.schema import Fluid

BOX = {"type": "box", "min": [0.0, 0.0], "max": [1.0, 1.0]}
KEY = "fluids.water"
CELLS = (np.stack(np.meshgrid(*[np.arange(10)] * 2), axis=-1).reshape(-1, 2) + 0.5) / 10.0


def fluid(**more: object) -> Fluid:
    return Fluid.model_validate({"shape": BOX, "density": 800.0, **more})


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0, 200.0])
def test_hydrostatic_pressure_for_gravity_in_any_direction(angle: float) -> None:
    """grad p = rho g, and p = 0 at the highest corner of the highest cell."""
    gravity = 9.81 * np.array([np.sin(np.deg2rad(angle)), -np.cos(np.deg2rad(angle))])
    pressure = initial_pressure(fluid(), CELLS, gravity, 0.1, KEY)
    highest = max(-corner @ gravity for corner in np.array([[0, 0], [0, 1], [1, 0], [1, 1]]))
    assert pressure == pytest.approx(800.0 * (highest + CELLS @ gravity))
    assert pressure.min() >= 0.0


def test_pressure_below_a_given_surface_and_none_above_it() -> None:
    given = fluid(pressure={"type": "hydrostatic", "surface": 0.5})
    pressure = initial_pressure(given, CELLS, (0.0, -10.0), 0.1, KEY)
    assert pressure == pytest.approx(8000.0 * np.maximum(0.5 - CELLS[:, 1], 0.0))


def test_no_hydrostatic_pressure_without_gravity() -> None:
    assert not initial_pressure(fluid(), CELLS, (0.0, 0.0), 0.1, KEY).any()


def test_uniform_pressure() -> None:
    assert np.all(
        initial_pressure(fluid(pressure={"type": "uniform", "value": 7.0}), CELLS, (0.0, -1.0), 0.1, KEY)
        == 7.0
    )


def test_velocity_from_numbers_and_expressions() -> None:
    x, y = CELLS.T
    velocity = initial_field(fluid(velocity=["sin(pi*x)*y", -2.0]).velocity, CELLS, "fluids.water.velocity")
    assert velocity == pytest.approx(np.stack([np.sin(np.pi * x) * y, np.full(100, -2.0)], axis=1))


def test_fluid_is_at_rest_by_default() -> None:
    assert not initial_field(fluid().velocity, CELLS, "fluids.water.velocity").any()


def test_velocity_that_is_not_finite_is_refused_with_its_place() -> None:
    with pytest.raises(SceneError) as refused:
        initial_field(fluid(velocity=[0.0, "1/(x-0.05)"]).velocity, CELLS, "fluids.water.velocity")
    (problem,) = refused.value.problems
    assert problem.key == "fluids.water.velocity.1"
    assert problem.value == "1/(x-0.05)"
    assert "10 particles, first at (0.05, 0.05)" in problem.message


def test_pressure_from_an_expression() -> None:
    given = fluid(pressure={"type": "expression", "value": "100*x - y"})
    x, y = CELLS.T
    assert initial_pressure(given, CELLS, (0.0, 0.0), 0.1, KEY) == pytest.approx(100.0 * x - y)


def test_pressure_that_is_not_finite_is_refused() -> None:
    given = fluid(pressure={"type": "expression", "value": "log(y - 0.5)"})
    with pytest.raises(SceneError, match=r"fluids\.water\.pressure\.value"):
        initial_pressure(given, CELLS, (0.0, 0.0), 0.1, KEY)
