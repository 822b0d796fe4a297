"""Small scenes of bodies that touch, for several tests."""

from __future__ import annotations

from typing import Any

import numpy as np
from structure_builders import DENSITY, NU, YOUNG, region

from warpsph.scene.schema import Scene
from warpsph.solver.simulation import Simulation

SPACING = 0.1
MATERIAL = {"density": DENSITY, "youngs_modulus": YOUNG, "poisson_ratio": NU}


def body(low: tuple[float, ...], high: tuple[float, ...], **more: Any) -> dict[str, Any]:
    """A box of the tests' material."""
    return {"shape": region(low, high), "material": MATERIAL} | more


def touching(structures: dict[str, Any], contact: dict[str, Any] | None = None, **changes: Any) -> Scene:
    """A scene of several structures with contact; in two dimensions unless `dimension` is 3."""
    dimension = changes.get("dimension", 2)
    numerics = {"precision": "double"} | changes.pop("numerics", {})
    base: dict[str, Any] = {
        "name": "touching",
        "dimension": dimension,
        "spacing": SPACING,
        "gravity": (0.0,) * dimension,
        "time": {"end": 1.0, "frame_rate": 10.0},
        "structures": structures,
        "contact": contact or {},
    }
    return Scene(**(base | {"numerics": numerics} | changes))


def two_blocks(
    gap: float = 0.02, speed: float = 1.0, shift: float = 0.0, dimension: int = 2, **changes: Any
) -> Scene:
    """Two blocks of 0.4 m that approach each other along x at twice the speed; the second lies `shift` higher."""
    low, high, rest = (0.0,) * (dimension - 1), (0.4,) * (dimension - 1), (0.0,) * (dimension - 1)
    raised = (0.4 + gap, shift, *low[1:]), (0.8 + gap, 0.4 + shift, *high[1:])
    return touching(
        {
            "left": body((0.0, *low), (0.4, *high), velocity=(speed, *rest)),
            "right": body(*raised, velocity=(-speed, *rest)),
        },
        dimension=dimension,
        **changes,
    )


def on_slope(
    angle: float, friction: float, damping: float = 0.0, speed: float = 0.0, **changes: Any
) -> Scene:
    """A block of 0.6 m x 0.3 m on a plane wall at an angle [degrees]; x points down the slope."""
    g, a = 9.81, np.radians(angle)
    floor = {"shape": region((-0.5, -SPACING), (3.0, 0.0)), "side": "solid"} | changes.pop("floor", {})
    return touching(
        {"block": body((0.0, 0.0), (0.6, 0.3), damping=damping, velocity=(speed, 0.0))},
        contact={"friction": friction},
        gravity=(g * np.sin(a), -g * np.cos(a)),
        boundaries={"floor": floor},
        **changes,
    )


def simulate(scene: Scene) -> Simulation:
    return Simulation(scene, device="cpu", threads=1)


def centre(simulation: Simulation, name: str, field: str = "position") -> np.ndarray:
    """Mean of a field over a structure."""
    return np.asarray(simulation.frame((field,)).set_named(name).fields[field]).mean(axis=0)


def total(simulation: Simulation) -> float:
    """Energy of all bodies less what was done on them, plus what they have lost [J]."""
    ledger = simulation.ledger()
    e = ledger.energies
    stored = e["strain"] + e["hourglass"] + e["contact"] + ledger.potential_energy
    return ledger.kinetic_energy + stored - e["work"] + e["dissipated"]
