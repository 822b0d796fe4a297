"""Viscous stress from the strain rate: constants from the scene, and its passes."""

from __future__ import annotations

from typing import Any

import numpy as np
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.rheology import make_stress_struct
from warpsph_kernels.stress import make_stress_kernels

from warpsph.particles.neighbours import NeighbourRows
from warpsph.particles.state import write_array
from warpsph.physics.assembly import Assembly, WallRange, WallSurface
from warpsph.physics.material import largest_kinematic_viscosity, material
from warpsph.scene.expressions import evaluate
from warpsph.scene.schema import Scene
from warpsph.scene.types import AXES


def stress_constants(scene: Scene, arithmetic: Arithmetic) -> Any:
    """Return the struct of numbers of the stress that the scene's viscosity makes."""
    s = make_stress_struct(arithmetic)()
    viscosity = scene.numerics.viscosity
    if viscosity.type == "sub_particle_scale":
        s.smagorinsky = (viscosity.smagorinsky * scene.spacing) ** 2
        s.isotropic = viscosity.isotropic * scene.spacing**2
    elif viscosity.type == "viscous_stress":
        law = viscosity.law
        s.largest = largest_kinematic_viscosity(scene) * material(scene).density
        if law.type == "herschel_bulkley":
            s.consistency, s.exponent = law.consistency, law.exponent
            s.yield_stress, s.time = law.yield_stress, law.regularisation
        elif law.type == "carreau":
            s.viscosity, s.consistency = law.infinite_viscosity, law.zero_viscosity - law.infinite_viscosity
            s.exponent, s.time = law.exponent, law.time
    return s


def carried_viscosity(scene: Scene, position: np.ndarray) -> np.ndarray:
    """Return the dynamic viscosity [Pa s] that each fluid particle carries (n,), or that of all (1,)."""
    fluid, viscosity = material(scene), scene.numerics.viscosity
    if viscosity.type == "viscous_stress" and viscosity.law.type == "newtonian" and viscosity.law.viscosity:
        variables = dict(zip(AXES, position.T, strict=False))
        return evaluate(viscosity.law.viscosity, variables)
    return np.array([fluid.density * fluid.kinematic_viscosity])


class StressModel:
    """The passes of the viscous stress.

    carried: dynamic viscosity [Pa s] that each fluid particle carries, or that of all in one entry; viscosity: what
    the law makes of it; stress [Pa].
    """

    def __init__(self, assembly: Assembly, rows: NeighbourRows, surface: WallSurface, scene: Scene) -> None:
        arithmetic, device = assembly.options.arithmetic, assembly.launcher.device
        self._assembly, self._rows, self._surface = assembly, rows, surface
        self._constants = stress_constants(scene, arithmetic)
        self._kernels = make_stress_kernels(assembly.options)
        fluids = assembly.layout.fluids
        carried = carried_viscosity(scene, assembly.state.position.numpy()[:fluids])
        self.carried = wp.zeros(len(carried), dtype=arithmetic.real, device=device)
        write_array(self.carried, carried)
        turbulent = assembly.options.stress == "sub_particle_scale"
        self.viscosity = wp.zeros(1 if turbulent else fluids, dtype=arithmetic.real, device=device)
        self.stress = wp.zeros(fluids, dtype=arithmetic.matrix, device=device)
        self.bind_lists()

    @property
    def own_arrays(self) -> dict[str, wp.array]:
        """Arrays of shape (fluids,) that follow the order of the fluid and belong into a checkpoint."""
        return {"carried_viscosity": self.carried} if len(self.carried) == len(self.stress) else {}

    @property
    def arrays(self) -> dict[str, wp.array]:
        """All arrays of the model, by name."""
        return {"carried_viscosity": self.carried, "viscosity": self.viscosity, "stress": self.stress}

    def bind_lists(self) -> None:
        """Build the passes; needed again when the rows of the neighbour lists have grown."""
        a, rows, kernels = self._assembly, self._rows, self._kernels
        records = (a.scratch.position_pressure, a.state.velocity_volume, self._surface.friction)
        lists = (rows.index, rows.ends)
        first = a.layout.fluids
        c, bind = a.constants, a.launcher.bind
        self._find = bind(
            "stress",
            kernels.find_stress,
            c,
            self._constants,
            *lists,
            *records,
            first,
            self.carried,
            self.viscosity,
            self.stress,
        )
        self._add = bind(
            "stress",
            kernels.add_divergence,
            c,
            *lists,
            *records,
            first,
            self.viscosity,
            self.stress,
            a.state.acceleration,
        )

    def find(self) -> None:
        """Find the stress of every particle from the present velocities."""
        self._find.run(self._rows.targets.count)

    def add(self) -> None:
        """Add the divergence of the stress to the accelerations."""
        self._add.run(self._rows.targets.count)

    def react(self, walls: WallRange, force: wp.array) -> None:
        """Add the force of the stress on each wall particle of a range [N], shape (its count,)."""
        a = self._assembly
        records = (a.scratch.position_pressure, a.state.velocity_volume, walls.surface.friction)
        self.find()
        a.launcher.bind(
            "wall force",
            self._kernels.react,
            a.constants,
            walls.first,
            walls.rows.index,
            walls.rows.ends,
            *records,
            self.viscosity,
            self.stress,
            force,
        ).run(walls.count)
