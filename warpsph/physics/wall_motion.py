"""Walls that rest or move by a prescribed law: where their particles are, and which of them lie at the surface."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import warp as wp
from warpsph_kernels.pose import make_pose_struct
from warpsph_kernels.wall_motion import make_move
from warpsph_kernels.wall_surface import make_surface_kernels

from warpsph.particles.launch import Pass
from warpsph.particles.neighbours import NeighbourRows
from warpsph.physics.assembly import Assembly, WallRange
from warpsph.sampling.kinematics import Pose, RigidMotion


class PrescribedMotion:
    """Places the particles of walls.

    Args:
        motions: rigid motion by set index, for walls that move.
        sets: number of all sets, since a particle names its set by index.
    """

    def __init__(
        self, assembly: Assembly, walls: WallRange, motions: Mapping[int, RigidMotion], sets: int
    ) -> None:
        self._assembly, self._walls = assembly, walls
        self._motions = dict(motions)
        # All made before the first launch: a kernel that joins its module later compiles the module anew.
        move = make_move(assembly.options)
        self._surface_kernels = make_surface_kernels(assembly.options)
        self.poses = resting_poses(assembly, sets)
        self._resting = [_device_pose(assembly, None) for _ in range(sets)]
        self.reference = wp.clone(assembly.state.position[walls.first : walls.first + walls.count])
        self.reference_normal = wp.zeros_like(walls.surface.normal)
        state, scratch = assembly.state, assembly.scratch

        def bind(placed: np.ndarray) -> Pass:
            return assembly.launcher.bind(
                "move walls",
                move,
                walls.first,
                assembly.constants.wall_volume,
                assembly.origin,
                self.poses,
                wp.array(placed, dtype=wp.int32, device=assembly.launcher.device),
                state.set_index,
                self.reference,
                self.reference_normal,
                state.position,
                state.velocity_volume,
                scratch.position_pressure,
                scratch.position_density,
                state.acceleration,
                walls.surface.normal,
            )

        self._place_all = bind(np.ones(sets))
        self._place_moving = bind(np.isin(np.arange(sets), list(self._motions)))

    @property
    def own_arrays(self) -> dict[str, wp.array]:
        """Arrays of shape (walls,) that follow the order of the walls and belong into a checkpoint."""
        normals = {"wall_normal": self.reference_normal, "wall_surface_normal": self._walls.surface.normal}
        return {"wall_reference": self.reference} | normals

    @property
    def moving(self) -> bool:
        """Whether some wall moves."""
        return bool(self._motions)

    def move(self, time: float) -> None:
        """Place the walls that move as prescribed for a time [s]."""
        if self.moving:
            self._set_poses(time)
            self._place_moving.run(self._walls.count)

    def place(self, time: float) -> None:
        """Write position, velocity and acceleration of every wall particle for a time [s]."""
        self._set_poses(time)
        self._place_all.run(self._walls.count)

    def _set_poses(self, time: float) -> None:
        poses = list(self._resting)
        for index, motion in self._motions.items():
            poses[index] = _device_pose(self._assembly, motion(time))
        wp.copy(self.poses, wp.array(poses, dtype=self.poses.dtype, device=self.poses.device))

    def find_surface(self, rows: NeighbourRows, listed_position: wp.array, spacing: float) -> None:
        """Find the normals of the surface of every wall from the walls around each wall particle."""
        a, real = self._assembly, self._assembly.options.arithmetic.real
        lists = (rows.index, rows.ends, listed_position, self.reference_normal)
        find_normals, keep_surface = self._surface_kernels
        first, count, bind = self._walls.first, self._walls.count, a.launcher.bind
        bind("wall surface", find_normals, a.constants, first, *lists).run(count)
        bind("wall surface", keep_surface, a.constants, real(spacing), first, *lists).run(count)


def resting_poses(assembly: Assembly, sets: int) -> wp.array:
    """Poses of sets that do not move."""
    pose_type = make_pose_struct(assembly.options.arithmetic)
    poses = [_device_pose(assembly, None) for _ in range(sets)]
    return wp.array(poses, dtype=pose_type, device=assembly.launcher.device)


def _device_pose(assembly: Assembly, pose: Pose | None) -> Any:
    arithmetic = assembly.options.arithmetic
    device_pose = make_pose_struct(arithmetic)()
    at_rest = {"rotation": np.eye(arithmetic.dimension)}
    for name, value in (at_rest if pose is None else pose.derivatives()).items():
        setattr(device_pose, name, value)
    return device_pose
