"""Numbers of the one fluid of a scene that several models need."""

from __future__ import annotations

from collections.abc import Sequence

from warpsph_kernels.arithmetic import PARAMETERS

from warpsph.scene.schema import Fluid, Scene


def smoothing_length(scene: Scene) -> float:
    """Return h [m]."""
    return scene.numerics.h_over_dp * scene.spacing


def material(scene: Scene) -> Fluid:
    """Return a fluid whose density and viscosity are those of all fluids of the scene, which are one phase."""
    return next(iter(scene.fluids.values()))


def padded(numbers: Sequence[float]) -> list[float]:
    """Return the parameters of a formula with zeros behind them, as many as its vector holds."""
    return [*numbers, *(0.0 for _ in range(PARAMETERS - len(numbers)))]


def largest_kinematic_viscosity(scene: Scene) -> float:
    """Return the largest physical viscosity [m^2/s] that the scene's fluid may have."""
    fluid, viscosity = material(scene), scene.numerics.viscosity
    if viscosity.type == "viscous_stress" and viscosity.law.largest is not None:
        return viscosity.law.largest / fluid.density
    return fluid.kinematic_viscosity
