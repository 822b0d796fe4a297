"""Initial state of fluids and structures on their lattice."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.expressions import VectorField, evaluate
from warpsph.scene.schema import Fluid
from warpsph.scene.types import AXES


def initial_field(field: VectorField | None, position: np.ndarray, key: str) -> np.ndarray:
    """A vector (n, dimension) at positions (n, dimension) [m], from numbers or expressions in x, y, z; None is zero.

    Raises SceneError, naming the field's `key`, where an expression is not a finite number.
    """
    if field is None:
        return np.zeros_like(position)
    vector = np.empty_like(position)
    for component, value in enumerate(field):
        vector[:, component] = _values(value, position, f"{key}.{component}")
    return vector


def _values(value: float | str, position: np.ndarray, key: str) -> np.ndarray:
    """A number, or an expression at each position (n, dimension); SceneError where it is not finite."""
    if not isinstance(value, str):
        return np.full(len(position), value)
    values = evaluate(value, dict(zip(AXES, position.T, strict=False)))
    undefined = ~np.isfinite(values)
    if undefined.any():
        at = ", ".join(f"{x:g}" for x in position[undefined][0])
        message = f"it is not a finite number at {undefined.sum()} particles, first at ({at})"
        raise SceneError([Problem.at(key, message, "finite at every particle", value)])
    return values


def initial_pressure(
    fluid: Fluid, position: np.ndarray, gravity: Sequence[float], spacing: float, key: str
) -> np.ndarray:
    """Pressure (n,) [Pa] at positions (n, dimension) [m]: as given, or rho |g| depth and never below zero.

    Depth counts against gravity from the free surface: as given, or the top of the highest cell of the fluid.
    Raises SceneError, naming the fluid's `key`, where an expression is not a finite number.
    """
    if fluid.pressure.type != "hydrostatic":
        return _values(fluid.pressure.value, position, f"{key}.pressure.value")
    strength = float(np.linalg.norm(gravity))
    if strength == 0.0 or len(position) == 0:
        return np.zeros(len(position))
    up = -np.array(gravity) / strength
    elevation = position @ up
    surface = fluid.pressure.surface
    if surface == "auto":
        surface = elevation.max() + 0.5 * spacing * np.abs(up).sum()
    return fluid.density * strength * np.maximum(surface - elevation, 0.0)
