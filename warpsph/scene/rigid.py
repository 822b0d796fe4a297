"""Rigid bodies: what they can do, and how heavy they are."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from warpsph.scene.motion import Motion
from warpsph.scene.types import PositiveReal, Real, SceneModel, Vector

FreeAxis = Literal["x", "y", "z", "rx", "ry", "rz"]
"""A translation along a coordinate axis or a rotation about it; in two dimensions x, y and rz."""


class Rigid(SceneModel):
    """A body that does not deform. Clamps, damping and an initial displacement have no place in it.

    What its axes do not leave free is held, or moves as `motion` prescribes."""

    free: tuple[FreeAxis, ...] | None = None
    """Translations (x, y, z) and rotations (rx, ry, rz about axes fixed in space) that forces move; null: all.
    Default: null."""

    mass: PositiveReal | None = None
    """Mass [kg]; in two dimensions per metre of depth; null: that of the material. Default: null."""

    inertia: tuple[Real, ...] | None = None
    """Inertia about the centre of mass [kg m2]: in two dimensions one number, per metre of depth; in three the moments
    xx, yy, zz, or the components xx, yy, zz, xy, xz, yz of the tensor; null: that of the particles. Default: null."""

    center_of_mass: Vector | None = None
    """Where the centre of mass is at the start [m]; null: that of the particles. Default: null."""

    pivot: Vector | None = None
    """A point of the body that stays where it is [m], about which the body turns: for a body without free
    translations. Null: the centre of mass. Default: null."""

    motion: tuple[Motion, ...] = ()
    """Prescribed motions of the axes that are not free, applied in the order of the list; empty: they are held.
    Default: empty."""

    def free_axes(self, dimension: int) -> frozenset[str]:
        """Names of the axes that are free in a scene of that dimension."""
        return frozenset(axes_of(dimension) if self.free is None else self.free)


def axes_of(dimension: int) -> tuple[str, ...]:
    """Names of the axes that a rigid body has in that dimension."""
    return ("x", "y", "rz") if dimension == 2 else ("x", "y", "z", "rx", "ry", "rz")


def inertia_tensor(components: Sequence[float]) -> np.ndarray:
    """Tensor (3, 3) [kg m2] of the 1, 3 or 6 components that a scene gives.

    Of a body in the plane only the moment about z counts; the others are 1.
    """
    if len(components) == 1:
        return np.diag([1.0, 1.0, components[0]])
    xx, yy, zz, xy, xz, yz = (*components, 0.0, 0.0, 0.0)[:6]
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
