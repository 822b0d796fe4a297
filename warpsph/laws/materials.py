"""Constitutive laws of structures as a scene sees them: their names, and the plane states that they know."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class MaterialLaw:
    """What a scene may ask of a law; `plane_stress`: whether it is there for plane stress in two dimensions."""

    plane_stress: bool


MATERIAL_LAWS: dict[str, MaterialLaw] = {
    "st_venant_kirchhoff": MaterialLaw(plane_stress=True),
    "neo_hookean": MaterialLaw(plane_stress=True),
    "split_neo_hookean": MaterialLaw(plane_stress=False),
    "linear_elastic": MaterialLaw(plane_stress=True),
}
"""By name; `warpsph.register_material` adds to it."""
