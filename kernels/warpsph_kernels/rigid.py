"""Kernels of rigid bodies among structures: their particles follow the body, and their forces are summed for it.

The particles of a rigid body are like clamped ones: `drift` and `accelerate` of the structures leave them where they
are. Its motion is integrated on the host from the sums of their accelerations, see `warpsph.solver.rigid_motion`.
"""

import hashlib
from functools import cache
from typing import Any, NamedTuple

import warp as wp

from warpsph_kernels.arithmetic import make_widen
from warpsph_kernels.materials import make_material_struct
from warpsph_kernels.structure import STEP, SUB_STEP, StructureOptions

BLOCK = 256
"""Particles a thread of `sum_forces` reads."""


def pose_size(dimension: int) -> int:
    """Numbers of a pose x = R X + b: R, b, dR/dt, db/dt by rows, and the work per mass in the step."""
    return 2 * dimension * (dimension + 1) + 1


class RigidKernels(NamedTuple):
    """Kernels of rigid bodies, in the order of a step."""

    carry: Any
    sum_forces: Any
    settle: Any
    turn: Any


@cache
def make_rigid_kernels(options: StructureOptions) -> RigidKernels:
    """Return the kernels of rigid bodies beside structures of these options."""
    arithmetic = options.arithmetic
    dim, real, vector, point = arithmetic.dimension, arithmetic.real, arithmetic.vector, arithmetic.point
    matrix = arithmetic.matrix
    material, widen = make_material_struct(arithmetic), make_widen(arithmetic)
    digest = hashlib.sha256(repr(options).encode()).hexdigest()[:10]
    module = f"warpsph_rigid_{arithmetic.label}_{digest}"

    @wp.func
    def moved(A: wp.array(dtype=wp.float64), first: int, X: point):
        """A X + b with the matrix A and the vector b that stand in a row of the poses from `first` on."""
        out = point()
        for row in range(wp.static(dim)):
            out[row] = A[first + wp.static(dim * dim) + row]
            for column in range(wp.static(dim)):
                out[row] += A[first + wp.static(dim) * row + column] * X[column]
        return out

    @wp.kernel(module=module, enable_backward=False)
    def carry(
        offset: int,
        clock: wp.array(dtype=wp.float64),
        members: wp.array(dtype=wp.int32),
        body: wp.array(dtype=wp.int32),
        poses: wp.array2d(dtype=wp.float64),
        materials: wp.array(dtype=material),
        structure: wp.array(dtype=wp.int32),
        volume: wp.array(dtype=real),
        reference: wp.array(dtype=point),
        load: wp.array2d(dtype=vector),
        load_factor: wp.array2d(dtype=wp.float64),
        fluid_force: wp.array(dtype=vector),
        displacement: wp.array(dtype=point),
        velocity: wp.array(dtype=point),
        work: wp.array(dtype=wp.float64),
    ):
        """One particle: it moves with its body, u = R X + b - X [m].

        `work` [J] gains what loads and fluid do on the way.

        Its velocity is that of the way in the step, which is what friction needs; in a step of no length that of the
        pose.
        """
        n = offset + wp.tid()
        i = members[n]
        pose = poses[body[n]]
        X = reference[i]
        u = moved(pose, 0, X) - X
        way = u - displacement[i]
        step = clock[wp.static(STEP)]
        if step > wp.float64(0.0):
            velocity[i] = way / step
        else:
            velocity[i] = moved(pose, wp.static(dim * (dim + 1)), X)
        if wp.static(options.loads > 0):
            now = int(clock[wp.static(SUB_STEP)])
            mass = wp.float64(materials[structure[i]].density * volume[i])
            done = wp.float64(0.0)
            for k in range(wp.static(options.loads)):
                factor = wp.float64(0.5) * (load_factor[now, k] + load_factor[now + 1, k])
                done += factor * wp.dot(widen(load[k, i]), way)
            work[i] += mass * done
        if wp.static(options.immersed):
            work[i] += wp.dot(widen(fluid_force[i]), way)
        displacement[i] = u

    @wp.kernel(module=module, enable_backward=False)
    def sum_forces(
        offset: int,
        gravity: vector,
        ranges: wp.array2d(dtype=wp.int32),
        origins: wp.array(dtype=point),
        materials: wp.array(dtype=material),
        structure: wp.array(dtype=wp.int32),
        volume: wp.array(dtype=real),
        reference: wp.array(dtype=point),
        acceleration: wp.array(dtype=point),
        sums: wp.array2d(dtype=wp.float64),
    ):
        """One block of particles of one body: sums of m (a - g) [N] and of m r (x) (a - g) [N m].

        r is the arm from the origin of the body at rest. `ranges` (blocks, 3) holds the body of each block, its first
        particle and the one behind its last.
        """
        block = offset + wp.tid()
        origin = origins[ranges[block, 0]]
        force = point()
        moment = wp.outer(force, force)
        for i in range(ranges[block, 1], ranges[block, 2]):
            mass = wp.float64(materials[structure[i]].density * volume[i])
            f = mass * (acceleration[i] - widen(gravity))
            force += f
            moment += wp.outer(reference[i] - origin, f)
        for row in range(wp.static(dim)):
            sums[block, row] = force[row]
            for column in range(wp.static(dim)):
                sums[block, wp.static(dim) * (row + 1) + column] = moment[row, column]

    @wp.kernel(module=module, enable_backward=False)
    def settle(
        offset: int,
        members: wp.array(dtype=wp.int32),
        body: wp.array(dtype=wp.int32),
        poses: wp.array2d(dtype=wp.float64),
        materials: wp.array(dtype=material),
        structure: wp.array(dtype=wp.int32),
        volume: wp.array(dtype=real),
        reference: wp.array(dtype=point),
        velocity: wp.array(dtype=point),
        work: wp.array(dtype=wp.float64),
    ):
        """One particle: its velocity at the end of the step, v = dR/dt X + db/dt [m/s].

        `work` [J] gains its part of what moves the axes of its body has done in the step; it stands per mass [J/kg]
        behind the pose.
        """
        n = offset + wp.tid()
        i = members[n]
        pose = poses[body[n]]
        velocity[i] = moved(pose, wp.static(dim * (dim + 1)), reference[i])
        work[i] += (
            wp.float64(materials[structure[i]].density * volume[i]) * pose[wp.static(2 * dim * (dim + 1))]
        )

    @wp.kernel(module=module, enable_backward=False)
    def turn(
        offset: int,
        members: wp.array(dtype=wp.int32),
        body: wp.array(dtype=wp.int32),
        poses: wp.array2d(dtype=wp.float64),
        gradient: wp.array(dtype=matrix),
    ):
        """One particle: its displacement gradient H = R - I [1], which no bonds tell."""
        n = offset + wp.tid()
        pose = poses[body[n]]
        H = matrix()
        for row in range(wp.static(dim)):
            for column in range(wp.static(dim)):
                unit = wp.where(row == column, wp.float64(1.0), wp.float64(0.0))
                H[row, column] = real(pose[wp.static(dim) * row + column] - unit)
        gradient[members[n]] = H

    return RigidKernels(carry, sum_forces, settle, turn)
