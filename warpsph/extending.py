"""Formulas of a user's own: smoothing kernels, equations of state, viscosities and constitutive laws, added by name.

A formula is a Warp function on the device; what the host needs of it is tabulated from that function, so that it is
written once. `make` gets the types of a run (`warpsph_kernels.arithmetic.Arithmetic`: `real`, `vector`, `parameters`),
because the same formula runs in two and three dimensions and in either precision.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from functools import cache
from typing import Any

import numpy as np
import warp as wp
from warpsph_kernels.arithmetic import PARAMETERS, Arithmetic
from warpsph_kernels.materials import LAWS, LawFactory
from warpsph_kernels.pair_terms import VISCOSITIES
from warpsph_kernels.smoothing import SMOOTHING_KERNELS, SmoothingKernel
from warpsph_kernels.state import STATES, EquationOfState, difference_stiffening
from warpsph_kernels.tabulate import make_state_table

from warpsph.laws.materials import MATERIAL_LAWS, MaterialLaw
from warpsph.laws.smoothing import SMOOTHING_LAWS, SmoothingLaw
from warpsph.laws.states import STATE_LAWS, StateLaw
from warpsph.laws.viscosities import VISCOSITY_LAWS, ViscosityLaw
from warpsph.particles.tabulation import fill_table, tabulated

Factory = Callable[[Arithmetic], Any]
_HOST = Arithmetic(3, "double")
_NODES = 20001
_STRAINS = np.linspace(-0.25, 0.25, _NODES)
"""Beyond these the host takes the values at the ends."""
_TOLERANCE = 1e-3


def register_smoothing_kernel(name: str, support: float, make: Factory) -> None:
    """Add a smoothing kernel, which scenes then choose by `numerics.kernel`.

    Args:
        support: radius in units of h, beyond which both functions must be zero.
        make: returns for an arithmetic the functions f(q) and f'(q)/q of q = r/h, each of one `real`. The norm is
            found from f.

    Raises:
        ValueError: if the name is taken, or f' is not the derivative of f, or f does not end at the support.
    """
    _require_new(name, SMOOTHING_KERNELS)
    build = cache(lambda arithmetic: tuple(_function(part) for part in make(arithmetic)))
    q = np.linspace(0.0, support, _NODES)
    shape, slope = (tabulated(part, q) for part in build(_HOST))
    _require_slope(q, shape, slope)
    # Simpson's rule, exact for cubic pieces that end at a node.
    weights = np.where(np.arange(_NODES) % 2, 4.0, 2.0)
    weights[[0, -1]] = 1.0
    areas = {2: 2.0 * math.pi * q, 3: 4.0 * math.pi * q**2}
    alpha = {d: 1.0 / float((weights * area * shape).sum() * q[1] / 3.0) for d, area in areas.items()}
    SMOOTHING_KERNELS[name] = SmoothingKernel(name, support, alpha, build)
    SMOOTHING_LAWS[name] = SmoothingLaw(support, alpha, lambda x: np.interp(x, q, shape))


def register_state(
    name: str, make: Factory, parameters: Sequence[str] = (), make_stiffening: Factory | None = None
) -> None:
    """Add an equation of state, which scenes then choose by `numerics.state: {type: custom, law: name}`.

    It must have the form p = rho0 c0^2 R(e), e = rho/rho0 - 1, with R(0) = 0 and R'(0) = 1, so that c0 is the speed of
    sound at rest, and must not fall with e between -0.25 and 0.25. That is checked when a run begins, when the
    parameters are known.

    Args:
        make: returns for an arithmetic the function (rho - rho0, rho0, c0, parameters) -> p [Pa]; the first three
            are `real`, the last `arithmetic.parameters`.
        parameters: names of at most four numbers that a scene gives, in the order of the vector.
        make_stiffening: the same for dp/drho / c0^2; by default the difference quotient of the pressure.

    Raises:
        ValueError: if the name is taken or there are too many parameters.
    """
    _require_new(name, STATES)
    _require_few(parameters)
    build = cache(lambda arithmetic: _function(make(arithmetic)))
    stiffening = difference_stiffening(build)
    if make_stiffening is not None:
        given = make_stiffening
        stiffening = cache(lambda arithmetic: _function(given(arithmetic)))

    @cache
    def table(*numbers: float) -> tuple[np.ndarray, np.ndarray]:
        return _state_table(name, build(_HOST), numbers)

    STATES[name] = EquationOfState(build, stiffening)
    STATE_LAWS[name] = StateLaw(
        tuple(parameters),
        strain=lambda ratio, *numbers: np.interp(ratio, table(*numbers)[0], _STRAINS),
        work=lambda strain, *numbers: np.interp(strain, _STRAINS, table(*numbers)[1]),
    )


def register_viscosity(
    name: str,
    make: Factory,
    parameters: Sequence[str] = (),
    step_viscosity: Callable[..., float] | None = None,
) -> None:
    """Add a viscosity, which scenes then choose by `numerics.viscosity: {type: custom, law: name}`.

    Args:
        make: returns for an arithmetic the function (c, x_ab, v_ab, r2) -> vector, a force per V_a V_b without the
            factor F of the kernel gradient; `c` is `warpsph_kernels.pair_terms.make_constants_struct(arithmetic)`,
            whose `viscosity_parameters` hold the scene's numbers. It must change its sign with x_ab and v_ab.
        parameters: names of at most four numbers that a scene gives, in that order.
        step_viscosity: (nu, h, c0, *numbers) -> kinematic viscosity [m^2/s] that limits the step; by default the
            fluid's nu.

    Raises:
        ValueError: if the name is taken or there are too many parameters.
    """
    _require_new(name, VISCOSITIES)
    _require_few(parameters)
    VISCOSITIES[name] = cache(lambda arithmetic: _function(make(arithmetic)))
    VISCOSITY_LAWS[name] = ViscosityLaw(tuple(parameters), step_viscosity or (lambda nu, *_: nu))


def register_material(name: str, factory: LawFactory, plane_stress: bool = False) -> None:
    """Add a constitutive law of structures, which scenes then choose by `material.law`.

    Args:
        factory: takes `LawOptions`, returns the device function (H, p) -> (P [Pa], psi [Pa], P_33 [Pa]); see
            `warpsph_kernels.materials`. P has to be the derivative of psi, or energy is not conserved.
        plane_stress: whether the factory heeds `options.plane_stress`.

    Raises:
        ValueError: if the name is taken.
    """
    _require_new(name, LAWS)
    LAWS[name] = factory
    MATERIAL_LAWS[name] = MaterialLaw(plane_stress)


def _function(formula: Any) -> Any:
    return formula if isinstance(formula, wp.Function) else wp.func(formula)


def _require_new(name: str, registry: Collection[str]) -> None:
    if name in registry:
        raise ValueError(
            f"there is a {name!r} already; allowed: a name that is none of {', '.join(registry)}"
        )


def _require_few(parameters: Sequence[str]) -> None:
    if len(parameters) > PARAMETERS:
        raise ValueError(f"{len(parameters)} parameters; allowed: at most {PARAMETERS}")


def _require_slope(q: np.ndarray, shape: np.ndarray, slope: np.ndarray) -> None:
    derivative, scale = np.gradient(shape, q), np.abs(shape).max()
    if np.abs(slope * q - derivative)[1:-1].max() > _TOLERANCE * scale:
        raise ValueError("the second function is not f'(q)/q of the first one, f(q)")
    if abs(shape[-1]) > _TOLERANCE * scale:
        raise ValueError(f"f({q[-1]:g}) = {shape[-1]:g} at the support; allowed: zero")


def _state_table(name: str, state: Any, numbers: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """R(e), and the integral of R / (1 + e)^2 from 0 over R, at the strains of the table."""
    given = _HOST.parameters(*numbers, *(0.0 for _ in range(PARAMETERS - len(numbers))))
    ratio = fill_table(make_state_table(state, _HOST), _STRAINS, given)
    middle = _NODES // 2
    slope = (ratio[middle + 1] - ratio[middle - 1]) / (_STRAINS[middle + 1] - _STRAINS[middle - 1])
    if abs(ratio[middle]) > 1e-9 or abs(slope - 1.0) > _TOLERANCE or np.diff(ratio).min() < -1e-12:
        raise ValueError(
            f"state {name!r} with parameters {tuple(numbers)}: p / (rho0 c0^2) is {ratio[middle]:g} at rest with the "
            f"slope {slope:g}; allowed: 0 and 1, and nowhere falling with the density"
        )
    integrand = ratio / (1.0 + _STRAINS) ** 2
    pieces = 0.5 * (integrand[1:] + integrand[:-1]) * np.diff(_STRAINS)
    work = np.concatenate([[0.0], np.cumsum(pieces)])
    work -= work[middle]
    safe = np.where(np.abs(ratio) > 1e-9, ratio, 1.0)
    return ratio, np.where(np.abs(ratio) > 1e-9, work / safe, 0.5 * _STRAINS)
