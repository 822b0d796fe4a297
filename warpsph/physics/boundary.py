"""Walls: prescribed motion, what the fluid sees of them, and the force on them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import warp as wp
from warpsph_kernels.arithmetic import Arithmetic
from warpsph_kernels.boundary import make_wall_kernels
from warpsph_kernels.pose import make_pose_struct
from warpsph_kernels.wall_motion import make_move
from warpsph_kernels.wall_surface import make_surface_kernels

from warpsph.particles.launch import Pass
from warpsph.particles.neighbours import NeighbourRows
from warpsph.particles.state import host_view, write_array
from warpsph.physics.assembly import Assembly, Lists, WallSurface
from warpsph.physics.mirrored_walls import MirroredWalls
from warpsph.sampling.kinematics import Pose, RigidMotion


class WallModel:
    """The passes of all walls.

    Args:
        motions: rigid motion by set index, for walls that move.
        sets: number of all sets, since a particle names its set by index.
        surface: arrays that this model fills for the fluid.
        fluid_reaction: adds to the force on each wall particle [N] what acts beside pair forces.
        mirror: mirror points of modified dynamic walls.
    """

    def __init__(
        self,
        assembly: Assembly,
        lists: Lists,
        motions: Mapping[int, RigidMotion],
        sets: int,
        surface: WallSurface,
        fluid_reaction: Callable[[wp.array], None],
        mirror: MirroredWalls | None = None,
    ) -> None:
        self._mirror = mirror
        self.count = assembly.layout.walls
        self.surface = surface
        self._fluid_reaction = fluid_reaction
        self._assembly = assembly
        self._lists = lists
        self._motions = dict(motions)
        # All made before the first launch: a kernel that joins its module later compiles the module anew.
        self._kernels = make_wall_kernels(assembly.options)
        self._move_kernel = make_move(assembly.options)
        self._surface_kernels = make_surface_kernels(assembly.options)
        arithmetic, device = assembly.options.arithmetic, assembly.launcher.device
        self._pose_type = make_pose_struct(arithmetic)
        self._poses = wp.zeros(sets, dtype=self._pose_type, device=device)
        self._resting = [self._device_pose(None) for _ in range(sets)]
        first = assembly.layout.fluids
        self.reference = wp.clone(assembly.state.position[first:])
        self.reference_normal = wp.zeros_like(surface.normal)
        self.force = wp.zeros(max(self.count, 1), dtype=arithmetic.vector, device=device)
        self.bind_lists()

    @property
    def own_arrays(self) -> dict[str, wp.array]:
        """Arrays of shape (walls,) that follow the order of the walls and belong into a checkpoint."""
        mirror = {"wall_mirror": self._mirror.ways} if self._mirror else {}
        return mirror | {
            "wall_reference": self.reference,
            "wall_normal": self.reference_normal,
            "wall_friction": self.surface.friction,
        }

    @property
    def moving(self) -> bool:
        """Whether some wall moves."""
        return bool(self._motions)

    @property
    def method(self) -> str:
        return self._assembly.options.wall

    def move(self, time: float) -> None:
        """Place every wall as prescribed for a time [s]."""
        if self.moving:
            self.place(time)

    def place(self, time: float) -> None:
        """Write position, velocity and acceleration of every wall particle."""
        poses = list(self._resting)
        for index, motion in self._motions.items():
            poses[index] = self._device_pose(motion(time))
        wp.copy(self._poses, wp.array(poses, dtype=self._pose_type, device=self._assembly.launcher.device))
        self._move.run(self.count)

    def impose(self) -> None:
        """Set the pressure and the friction velocity that the fluid sees at the walls."""
        self._impose.run(self.count)

    def update_density(self) -> None:
        """Advance the density of dynamic walls; other walls have none."""
        if self.method == "dynamic":
            self._update_density.run(self.count)

    def synchronise(self) -> None:
        """Bring the wall pressure to the time of the fluid, without advancing anything."""
        if self.method == "dynamic":
            self._show.run(self.count)
        else:
            self._impose.run(self.count)

    def find_surface(self, rows: NeighbourRows, listed_position: wp.array, spacing: float) -> None:
        """Find the normals of the surface of every wall from the walls around each wall particle."""
        a, real = self._assembly, self._assembly.options.arithmetic.real
        first = a.layout.fluids
        lists = (rows.index, rows.ends, listed_position, self.reference_normal)
        find_normals, keep_surface = self._surface_kernels
        bind = a.launcher.bind
        bind("wall surface", find_normals, a.constants, first, *lists).run(self.count)
        bind("wall surface", keep_surface, a.constants, real(spacing), first, *lists).run(self.count)

    def start(self) -> None:
        """Give dynamic walls the density at which they are in equilibrium with the fluid before them."""
        if self.method != "dynamic":
            return
        a = self._assembly
        rows = self._lists.wall
        assert rows is not None
        self._extrapolation(rows).run(self.count)
        pressure = host_view(a.scratch.position_pressure)[a.layout.fluids :, -1].astype(np.float64)
        deviation = a.density_deviation(np.maximum(pressure, 0.0))
        write_array(a.state.density_deviation[a.layout.fluids :], deviation)

    def react(self) -> wp.array:
        """Return the force of the fluid on each wall particle [N], shape (walls,); needs synchronised records."""
        self._react.run(self.count)
        self._fluid_reaction(self.force)
        return self.force

    def bind_lists(self) -> None:
        """Build the passes; needed again when the rows of the neighbour lists have grown."""
        a = self._assembly
        first, state, scratch = a.layout.fluids, a.state, a.scratch
        rows = self._lists.wall
        assert rows is not None
        kernels, bind = self._kernels, a.launcher.bind
        self._move = bind(
            "move walls",
            self._move_kernel,
            first,
            a.constants.wall_volume,
            a.origin,
            self._poses,
            state.set_index,
            self.reference,
            self.reference_normal,
            state.position,
            state.velocity_volume,
            scratch.position_pressure,
            scratch.position_density,
            state.acceleration,
            self.surface.normal,
        )
        self._react = bind(
            "wall force",
            kernels.react,
            a.constants,
            first,
            rows.index,
            rows.ends,
            scratch.position_pressure,
            state.velocity_volume,
            self.surface.friction,
            self.surface.normal,
            self.force,
        )
        if self.method == "dynamic":
            self._bind_dynamic(rows)
        elif self._mirror:
            self._impose = self._mirror.bind(self.surface, self._poses)
        else:
            self._impose = self._extrapolation(rows)

    def _extrapolation(self, rows: NeighbourRows) -> Pass:
        a = self._assembly
        return a.launcher.bind(
            "extrapolate to walls",
            self._kernels.extrapolate,
            a.constants,
            a.layout.fluids,
            rows.index,
            rows.ends,
            a.state.density_deviation,
            a.state.acceleration,
            a.state.velocity_volume,
            self.surface.friction,
            a.scratch.position_pressure,
        )

    def _bind_dynamic(self, rows: NeighbourRows) -> None:
        a = self._assembly
        state, scratch, real = a.state, a.scratch, a.options.arithmetic.real

        def set_pressure(half_steps: float) -> Any:
            return a.launcher.bind(
                "wall pressure",
                self._kernels.set_pressure,
                a.constants,
                a.clock,
                a.layout.fluids,
                real(half_steps),
                state.density_rate,
                state.velocity_volume,
                self.surface.friction,
                state.density_deviation,
                scratch.position_pressure,
            )

        self._impose, self._show = set_pressure(1.0), set_pressure(0.0)
        self._update_density = a.launcher.bind(
            "update wall density",
            self._kernels.update_density,
            a.constants,
            a.clock,
            a.layout.fluids,
            rows.index,
            rows.ends,
            scratch.position_density,
            state.velocity_volume,
            state.density_rate,
            state.density_deviation,
        )

    def _device_pose(self, pose: Pose | None) -> Any:
        at_rest = {"rotation": np.eye(self._assembly.options.arithmetic.dimension)}
        device_pose = self._pose_type()
        for name, value in (at_rest if pose is None else pose.derivatives()).items():
            setattr(device_pose, name, value)
        return device_pose


def make_wall_surface(arithmetic: Arithmetic, no_slip: np.ndarray, device: Any) -> WallSurface:
    """Return the surface arrays of walls; `no_slip` has 1 for each particle of a no-slip wall and 0 for others."""
    size = max(len(no_slip), 1)
    friction = wp.zeros(size, dtype=arithmetic.record, device=device)
    write_array(friction, np.column_stack([np.zeros((len(no_slip), arithmetic.dimension)), no_slip]))
    return WallSurface(friction, wp.zeros(size, dtype=arithmetic.vector, device=device))


def no_slip_flags(slips: Sequence[bool], counts: Sequence[int]) -> np.ndarray:
    """Return 1 for each particle of a no-slip wall and 0 for others, walls in order."""
    return np.repeat(np.asarray(slips, dtype=float), counts)
