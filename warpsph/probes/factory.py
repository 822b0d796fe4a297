"""From the probes of a scene to the objects that evaluate them."""

from collections.abc import Callable
from typing import Any

from warpsph.probes.displacement import DisplacementProbe
from warpsph.probes.energy import EnergyProbe
from warpsph.probes.flux import FluxProbe
from warpsph.probes.force import ForceProbe
from warpsph.probes.force_coefficients import ForceCoefficientsProbe
from warpsph.probes.front import FrontProbe
from warpsph.probes.line import LineProbe
from warpsph.probes.momentum import MomentumProbe
from warpsph.probes.point import PointProbe
from warpsph.probes.probe import Probe
from warpsph.probes.reach import ReachProbe
from warpsph.probes.reaction import ReactionProbe
from warpsph.probes.rigid_body import RigidBodyProbe
from warpsph.probes.rotation import RotationProbe
from warpsph.probes.structure_energy import StructureEnergyProbe
from warpsph.probes.voids import VoidsProbe
from warpsph.probes.volume import VolumeProbe
from warpsph.probes.volume_balance import VolumeBalanceProbe
from warpsph.probes.wall_pressure import WallPressureProbe
from warpsph.probes.water_level import WaterLevelProbe
from warpsph.scene.probes import Probe as ProbeSpec
from warpsph.scene.schema import Scene

PROBES: dict[str, Callable[[str, Any, Scene], Probe]] = {
    "front": FrontProbe,
    "reach": ReachProbe,
    "water_level": WaterLevelProbe,
    "wall_pressure": WallPressureProbe,
    "point": PointProbe,
    "line": LineProbe,
    "force": ForceProbe,
    "force_coefficients": ForceCoefficientsProbe,
    "energy": EnergyProbe,
    "volume": VolumeProbe,
    "voids": VoidsProbe,
    "displacement": DisplacementProbe,
    "rotation": RotationProbe,
    "reaction": ReactionProbe,
    "rigid_body": RigidBodyProbe,
    "structure_energy": StructureEnergyProbe,
    "momentum": MomentumProbe,
    "flux": FluxProbe,
    "volume_balance": VolumeBalanceProbe,
}


def make_probe(name: str, spec: ProbeSpec, scene: Scene) -> Probe:
    """The probe that a scene describes under a name."""
    return PROBES[spec.type](name, spec, scene)
