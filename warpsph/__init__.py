"""warpsph: particle fluids and structures on NVIDIA Warp, from a YAML scene to a USD point cache."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from warpsph.extending import register_material as register_material
    from warpsph.extending import register_smoothing_kernel as register_smoothing_kernel
    from warpsph.extending import register_state as register_state
    from warpsph.extending import register_viscosity as register_viscosity
    from warpsph.scene.loader import load_scene as load_scene
    from warpsph.scene.schema import Scene as Scene
    from warpsph.solver.run import run_scene as run_scene
    from warpsph.solver.simulation import Simulation as Simulation

__version__ = "0.1.0"
__all__ = [
    "Scene",
    "Simulation",
    "load_scene",
    "register_material",
    "register_smoothing_kernel",
    "register_state",
    "register_viscosity",
    "run_scene",
]

_HOMES = {
    "Scene": "warpsph.scene.schema",
    "Simulation": "warpsph.solver.simulation",
    "load_scene": "warpsph.scene.loader",
    "register_material": "warpsph.extending",
    "register_smoothing_kernel": "warpsph.extending",
    "register_state": "warpsph.extending",
    "register_viscosity": "warpsph.extending",
    "run_scene": "warpsph.solver.run",
}


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used: Warp and USD take a second that `warpsph --help` can spare."""
    if name not in _HOMES:
        raise AttributeError(f"module 'warpsph' has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
