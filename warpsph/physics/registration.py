"""New formulas from Python, without a change of the package."""

from __future__ import annotations

from warpsph_kernels.materials import LAWS, LawFactory

from warpsph.laws.materials import MATERIAL_LAWS, MaterialLaw


def register_material(name: str, factory: LawFactory, plane_stress: bool = False) -> None:
    """Make a constitutive law known under a name that `material.law` of a scene may then use.

    Args:
        factory: takes `LawOptions`, returns the device function (H, p) -> (P [Pa], psi [Pa], P_33 [Pa]); see
            `warpsph_kernels.materials`. P has to be the derivative of psi, or energy is not conserved.
        plane_stress: whether the factory heeds `options.plane_stress`.

    Raises:
        ValueError: if there is such a law already.
    """
    if name in LAWS:
        raise ValueError(f"there is a law {name!r} already; allowed: another name than {', '.join(LAWS)}")
    LAWS[name] = factory
    MATERIAL_LAWS[name] = MaterialLaw(plane_stress)
