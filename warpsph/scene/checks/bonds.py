"""Checks of the bonds between structures."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from warpsph.scene.checks.common import DeclaredNames, unknown_name
from warpsph.scene.errors import Problem

if TYPE_CHECKING:
    from warpsph.scene.schema import Scene


def bond_problems(scene: Scene, names: DeclaredNames) -> Iterator[Problem]:
    """What is wrong with the groups of bonded structures, less whether they touch."""
    seen: dict[str, str] = {}
    for index, group in enumerate(scene.bonds):
        for place, name in enumerate(group):
            key = f"bonds.{index}.{place}"
            if name not in names.structures:
                yield unknown_name(key, "structure", name, names.structures)
            elif name in seen:
                allowed = "each structure once: one group holds all that hold together"
                yield Problem.at(key, f"it stands in {seen[name]} already", allowed, name)
            seen.setdefault(name, key)
            structure = scene.structures.get(name)
            if structure is not None and structure.rigid is not None:
                message = "a rigid body cannot be bonded yet"
                yield Problem.at(key, message, "flexible structures", name)
        yield from _plane_problems(scene, group, f"bonds.{index}")


def _plane_problems(scene: Scene, group: tuple[str, ...], key: str) -> Iterator[Problem]:
    """In one, material moves out of the plane, in the other it does not: bonded, they would be torn apart."""
    states = {scene.structures[name].plane for name in group if name in scene.structures}
    if len(states) > 1:
        message = "they are in different states across the plane"
        yield Problem.at(key, message, "the same structures.*.plane for all of them", list(group))
