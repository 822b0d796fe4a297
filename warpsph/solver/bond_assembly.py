"""Which structures of a scene are bonded to each other, and the bonds of their particles."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.smoothing import SMOOTHING_KERNELS

from warpsph.particles.bonds import Bonds, make_bonds, periodic_tree
from warpsph.particles.consistency import Gradients, consistent_gradients, is_scattered
from warpsph.particles.tabulation import tabulated
from warpsph.sampling.walls import period_of
from warpsph.scene.errors import Problem
from warpsph.scene.schema import Scene


def bond_radius(scene: Scene) -> float:
    """Reach of the bonds of structures [m]."""
    numerics = scene.numerics
    return numerics.support_over_h * numerics.structure.h_over_dp * scene.spacing


def composites_of(scene: Scene) -> Mapping[str, int]:
    """The number of the body that each structure belongs to: the same for those that are bonded to each other."""
    groups = [frozenset(group) for group in scene.bonds]
    alone = [frozenset([name]) for name in scene.structures if not any(name in group for group in groups)]
    return {name: number for number, group in enumerate([*groups, *alone]) for name in group}


def unbonded_problems(scene: Scene, position: Mapping[str, np.ndarray]) -> Iterator[Problem]:
    """Groups that do not hold together: positions (n, dim) [m] at rest by the name of the structure."""
    periods = np.array(_periods(scene))
    for index, group in enumerate(scene.bonds):
        trees = [periodic_tree(position[name], periods) for name in group]
        touch = np.array(
            [[a.count_neighbors(b, bond_radius(scene)) > 0 for b in trees] for a in trees], dtype=int
        )
        parts, part = connected_components(coo_array(touch), directed=False)
        if parts > 1:
            apart = ", ".join(name for name, own in zip(group, part, strict=True) if own != part[0])
            message = f"{apart} has no particle within {bond_radius(scene):.3g} m of one of {group[0]}"
            if len(group) > 2:
                message += " or of what is bonded to it"
            yield Problem.at(f"bonds.{index}", message, "structures that touch", list(group))


def bonds_of(
    scene: Scene, position: np.ndarray, composite: np.ndarray, volume: np.ndarray, rigid: np.ndarray
) -> Bonds:
    """The bonds of all structures, whose particles (n,) have the numbers of their bodies in `composite`."""
    dim, smoothing = scene.dimension, SMOOTHING_KERNELS[scene.numerics.kernel]
    h = scene.numerics.structure.h_over_dp * scene.spacing
    _, slope = smoothing.make(Arithmetic(dim, "double"))

    def weights(length: np.ndarray) -> np.ndarray:
        return smoothing.norm(dim, h) / h**2 * tabulated(slope, length / h)

    return make_bonds(position, composite, volume, rigid, bond_radius(scene), _periods(scene), weights)


def bond_gradients(
    scene: Scene,
    position: np.ndarray,
    composite: np.ndarray,
    structures: Sequence[slice],
    volume: np.ndarray,
    rigid: np.ndarray,
    bonds: Bonds,
) -> Gradients | None:
    """Gradients of the bonds where the particles of some structure do not lie on a lattice, else None."""
    radius, spacing = bond_radius(scene), scene.spacing
    if not any(is_scattered(bonds, own, radius, spacing) for own in structures):
        return None
    return consistent_gradients(position, composite, volume, rigid, bonds, spacing, _periods(scene))


def _periods(scene: Scene) -> list[float]:
    """Length of each periodic axis [m], zero along the others."""
    periods = [0.0] * scene.dimension
    for axis, (low, high) in period_of(scene).items():
        periods[axis] = high - low
    return periods
