"""Small structures that several tests run."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from warpsph.particles.launch import Launcher
from warpsph.particles.state import host_view, write_array
from warpsph.sampling import sample
from warpsph.scene.schema import Scene
from warpsph.solver.structure_system import StructureSystem

YOUNG, NU, DENSITY = 1.0e6, 0.3, 1000.0


def block(
    size: tuple[float, ...] = (1.0, 0.5),
    spacing: float = 0.1,
    material: dict[str, Any] | None = None,
    hourglass: float = 0.5,
    precision: str = "double",
    structure: dict[str, Any] | None = None,
    numerics: dict[str, Any] | None = None,
    **changes: Any,
) -> Scene:
    """A box with one corner at the origin, free unless `structure` holds it."""
    shape = {"type": "box", "min": (0.0,) * len(size), "max": size}
    stuff = {"density": DENSITY, "youngs_modulus": YOUNG, "poisson_ratio": NU} | (material or {})
    own = {"hourglass": hourglass} | (numerics or {})
    base = {
        "name": "block",
        "dimension": len(size),
        "spacing": spacing,
        "gravity": (0.0,) * len(size),
        "time": {"end": 1.0, "frame_rate": 10.0} | changes.pop("time", {}),
        "numerics": {"precision": precision, "structure": own},
        "structures": {"block": {"shape": shape, "material": stuff} | (structure or {})},
    }
    return Scene(**(base | changes))


def region(low: tuple[float, ...], high: tuple[float, ...]) -> dict[str, Any]:
    return {"type": "box", "min": low, "max": high}


def system_of(scene: Scene, position: np.ndarray | None = None, threads: int = 1) -> StructureSystem:
    """The structures of a scene, the only one of them with other particle positions (n, dim) [m] if given."""
    sets = sample(scene)
    if position is not None:
        (one,) = sets
        sets = (replace(one, position=position),)
    return StructureSystem(scene, sets, Launcher("cpu", threads))


def jittered(scene: Scene, part: float = 0.2) -> np.ndarray:
    """The lattice of a scene's only structure with each coordinate off by up to a part of the spacing."""
    (one,) = sample(scene)
    shift = np.random.default_rng(3).uniform(-part, part, one.position.shape)
    return one.position + scene.spacing * shift


def reference_of(system: StructureSystem) -> np.ndarray:
    """Positions at rest (n, dim) [m]."""
    return np.array(host_view(system.parts.model.reference.position))


def deform(system: StructureSystem, displacement: np.ndarray) -> None:
    """Impose a displacement (n, dim) [m] on particles at rest and find their stresses and forces."""
    state = system.parts.model.state
    write_array(state.displacement, displacement)
    write_array(state.velocity, np.zeros_like(displacement))
    system.stepper.find_forces()


def gradients(system: StructureSystem) -> np.ndarray:
    """H (n, dim, dim) of the present state."""
    return host_view(system.parts.model.scratch.gradient).astype(np.float64)


def forces(system: StructureSystem) -> np.ndarray:
    """Force on each particle (n, dim) [N], clamps left out."""
    return system.parts.mass[:, None] * host_view(system.parts.model.state.acceleration)


def elastic_energy(system: StructureSystem) -> float:
    """Strain and hourglass energy of the present state [J]."""
    energies = system.ledger().energies
    return energies["strain"] + energies["hourglass"]


def inside_of(system: StructureSystem) -> np.ndarray:
    """Whether a particle and all its neighbours have as many neighbours as the lattice allows, shape (n,)."""
    reference = system.parts.model.reference
    counts, rows = reference.ends.numpy()[:, 1], reference.neighbours.numpy()
    full = counts == counts.max()
    return full & np.array([full[row[:n]].all() for row, n in zip(rows, counts, strict=True)])
