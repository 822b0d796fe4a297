"""Rigid bodies among structures: the arrays of a run and the passes over them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import warp as wp
from warpsph_kernels.rigid import BLOCK, make_rigid_kernels, pose_size

from warpsph.particles.launch import Launcher
from warpsph.particles.state import host_view, write_array
from warpsph.physics.structure import StructureModel
from warpsph.sampling.kinematics import Pose

UNITS = {
    "rigid_members": "1",
    "rigid_body": "1",
    "rigid_poses": "SI",
    "rigid_ranges": "1",
    "rigid_origins": "m",
    "rigid_sums": "N, N m",
}

POSE = ("rotation", "shift", "rotation_rate", "shift_rate")
"""What a row of the poses holds, in this order."""


class RigidModel:
    """The passes of rigid bodies beside those of the structures.

    Args:
        ranges: first particle of each body and the one behind its last.
        origins: of each body (dim,), about which moments are taken at rest [m].
    """

    def __init__(
        self,
        launcher: Launcher,
        structures: StructureModel,
        ranges: Sequence[tuple[int, int]],
        origins: Sequence[np.ndarray],
    ) -> None:
        self._dim = structures.options.arithmetic.dimension
        members = np.concatenate([np.arange(*limits) for limits in ranges])
        body = np.repeat(np.arange(len(ranges)), [last - first for first, last in ranges])
        blocks = np.array(list(_blocks(ranges)), dtype=np.int32)
        point = structures.options.arithmetic.point
        device = launcher.device
        self.arrays = {
            "rigid_members": wp.array(members, dtype=wp.int32, device=device),
            "rigid_body": wp.array(body, dtype=wp.int32, device=device),
            "rigid_poses": wp.zeros((len(ranges), pose_size(self._dim)), dtype=wp.float64, device=device),
            "rigid_ranges": wp.array(blocks, dtype=wp.int32, ndim=2, device=device),
            "rigid_origins": wp.array(np.array(origins), dtype=point, device=device),
            "rigid_sums": wp.zeros(
                (len(blocks), self._dim * (1 + self._dim)), dtype=wp.float64, device=device
            ),
        }
        self._body_of_block = blocks[:, 0]
        self._poses = np.zeros((len(ranges), pose_size(self._dim)))
        self._bind(launcher, structures)

    def carry(self, poses: Sequence[Pose]) -> None:
        """Bring all particles to the poses of their bodies, with the velocities of the way; add the work of forces."""
        self._write(poses)
        self._carry.run(len(self.arrays["rigid_members"]))

    def settle(self, poses: Sequence[Pose], specific_work: np.ndarray) -> None:
        """Bring the velocities to those of the poses, and add a work for each body [J/kg]."""
        self._poses[:, -1] = specific_work
        self._write(poses)
        self._settle.run(len(self.arrays["rigid_members"]))

    def turn(self, poses: Sequence[Pose]) -> None:
        """Bring the displacement gradients to the poses: the strain of the structures leaves them at zero."""
        self._write(poses)
        self._turn.run(len(self.arrays["rigid_members"]))

    def sums(self) -> tuple[np.ndarray, np.ndarray]:
        """Force without gravity (bodies, dim) [N] and its moment tensor r (x) f (bodies, dim, dim) [N m], r at rest."""
        self._sum.run(len(self._body_of_block))
        blocks = host_view(self.arrays["rigid_sums"])
        total = np.zeros((len(self._poses), blocks.shape[1]))
        np.add.at(total, self._body_of_block, blocks)
        return total[:, : self._dim], total[:, self._dim :].reshape(-1, self._dim, self._dim)

    def _write(self, poses: Sequence[Pose]) -> None:
        for row, pose in zip(self._poses, poses, strict=True):
            known = pose.derivatives()
            row[:-1] = np.concatenate([known[name].ravel() for name in POSE])
        write_array(self.arrays["rigid_poses"], self._poses)

    def _bind(self, launcher: Launcher, structures: StructureModel) -> None:
        kernels, bind = make_rigid_kernels(structures.options), launcher.bind
        r, s, t = structures.reference, structures.state, structures.scratch
        members, body, poses, ranges, origins, sums = self.arrays.values()
        matter = (r.materials, r.structure, r.volume, r.position)
        gravity = structures.options.arithmetic.vector(*structures.gravity)
        loads = (r.load, t.load_factor, t.fluid_force)
        moved = (s.displacement, s.velocity, s.work)
        followers = (members, body, poses)
        self._carry = bind(
            "rigid motion", kernels.carry, structures.clock, *followers, *matter, *loads, *moved
        )
        self._sum = bind(
            "rigid forces", kernels.sum_forces, gravity, ranges, origins, *matter, s.acceleration, sums
        )
        self._settle = bind("rigid motion", kernels.settle, *followers, *matter, s.velocity, s.work)
        self._turn = bind("rigid motion", kernels.turn, *followers, t.gradient)


def _blocks(ranges: Sequence[tuple[int, int]]) -> list[tuple[int, int, int]]:
    """Body, first particle and the one behind the last of every block that one thread sums."""
    return [
        (body, start, min(start + BLOCK, last))
        for body, (first, last) in enumerate(ranges)
        for start in range(first, last, BLOCK)
    ]
