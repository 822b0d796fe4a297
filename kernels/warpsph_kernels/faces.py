"""Kernels between structures and the fluid: where the fluid sees structures, and the forces that they receive.

A face is a wall particle that moves with a particle of a structure, its owner. A particle within the reach of fluid on
both sides of a thin body has two faces, one a side, each listed only with the fluid on its own side. Faces follow the
order of the neighbour search; `face` holds the number of each in the order of the start.
"""

from functools import cache
from typing import Any, NamedTuple

import warp as wp

from warpsph_kernels.arithmetic import make_narrow, make_packing, make_widen
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pose import make_pose_struct
from warpsph_kernels.structure import STEP, SUB_STEP, make_turned_normal


class FaceKernels(NamedTuple):
    """Kernels of faces, in the order of a step."""

    turn_sides: Any
    find_places: Any
    place: Any
    push: Any
    find_mean_velocity: Any


@cache
def make_face_kernels(options: FluidOptions, moving_clamps: bool) -> FaceKernels:
    """Return the kernels of faces specialised for the options of the fluid."""
    arithmetic = options.arithmetic
    dim, real, vector = arithmetic.dimension, arithmetic.real, arithmetic.vector
    record, point, matrix = arithmetic.record, arithmetic.point, arithmetic.matrix
    module = options.module_of(f"faces_{int(moving_clamps)}")
    pose_type = make_pose_struct(arithmetic)
    pack, _ = make_packing(arithmetic)
    narrow, widen = make_narrow(arithmetic), make_widen(arithmetic)
    turned_normal = make_turned_normal(arithmetic)
    has_ways = options.wall == "modified_dynamic"

    @wp.func
    def deformation(
        s: int,
        gradient: wp.array(dtype=matrix),
        clamp: wp.array(dtype=wp.int32),
        structure_clock: wp.array(dtype=wp.float64),
        prescriptions: wp.array2d(dtype=pose_type),
    ):
        """F of a particle, of a rigid one the rotation of its clamp."""
        F = wp.identity(n=wp.static(dim), dtype=real) + gradient[s]
        if wp.static(moving_clamps):
            if clamp[s] >= 0:
                pose = prescriptions[int(structure_clock[wp.static(SUB_STEP)]), clamp[s]]
                for j in range(wp.static(dim)):
                    for k in range(wp.static(dim)):
                        F[j, k] = real(pose.rotation[j, k])
        return F

    @wp.kernel(module=module, enable_backward=False)
    def turn_sides(
        offset: int,
        face: wp.array(dtype=wp.int32),
        owner: wp.array(dtype=wp.int32),
        side_at_rest: wp.array(dtype=vector),
        gradient: wp.array(dtype=matrix),
        clamp: wp.array(dtype=wp.int32),
        structure_clock: wp.array(dtype=wp.float64),
        prescriptions: wp.array2d(dtype=pose_type),
        side: wp.array(dtype=vector),
    ):
        """One face: the side on which it is listed, turned with its owner; zero where it is listed all round."""
        i = offset + wp.tid()
        k = face[i]
        F = deformation(owner[k], gradient, clamp, structure_clock, prescriptions)
        side[i] = turned_normal(F, side_at_rest[k])

    @wp.kernel(module=module, enable_backward=False)
    def find_places(offset: int, face: wp.array(dtype=wp.int32), place_of: wp.array(dtype=wp.int32)):
        """One place: which face it holds, noted by the number of the face; every number occurs once."""
        i = offset + wp.tid()
        place_of[face[i]] = i

    @wp.kernel(module=module, enable_backward=False)
    def place(
        offset: int,
        clock: wp.array(dtype=wp.float64),
        ahead: wp.float64,
        first_face: int,
        wall_volume: real,
        origin: point,
        low: point,
        period: point,
        face: wp.array(dtype=wp.int32),
        owner: wp.array(dtype=wp.int32),
        normal_at_rest: wp.array(dtype=vector),
        way_at_rest: wp.array(dtype=vector),
        reference: wp.array(dtype=point),
        displacement: wp.array(dtype=point),
        gradient: wp.array(dtype=matrix),
        clamp: wp.array(dtype=wp.int32),
        structure_clock: wp.array(dtype=wp.float64),
        prescriptions: wp.array2d(dtype=pose_type),
        lead: wp.array(dtype=point),
        seen_velocity: wp.array(dtype=point),
        position: wp.array(dtype=point),
        velocity_volume: wp.array(dtype=record),
        position_pressure: wp.array(dtype=record),
        position_density: wp.array(dtype=record),
        normal: wp.array(dtype=vector),
        way: wp.array(dtype=vector),
    ):
        """One face: put it where its owner will be `ahead` steps from now, at the velocity `lead`, with that which the
        fluid sees.

        The acceleration that the fluid sees stays zero. With that of the owner the pressure of an extrapolated wall
        would push back what is accelerated, a step late: unstable for light and for stiff structures.
        """
        i = offset + wp.tid()
        b = first_face + i
        k = face[i]
        s = owner[k]
        x = reference[s] + displacement[s] + ahead * clock[wp.static(STEP)] * lead[s]
        for axis in range(wp.static(dim)):
            if wp.static(options.periodic[axis]):
                x[axis] = x[axis] - period[axis] * wp.floor((x[axis] - low[axis]) / period[axis])
        x_run = narrow(x, origin)
        zero = point()
        position[b] = x
        velocity_volume[b] = pack(narrow(seen_velocity[s], zero), wall_volume)
        position_pressure[b] = pack(x_run, position_pressure[b][dim])
        position_density[b] = pack(x_run, position_density[b][dim])
        if wp.static(options.has_barrier):
            F = deformation(s, gradient, clamp, structure_clock, prescriptions)
            normal[i] = turned_normal(F, normal_at_rest[k])
            if wp.static(has_ways):
                way[i] = wp.length(way_at_rest[k]) * turned_normal(F, way_at_rest[k])

    @wp.kernel(module=module, enable_backward=False)
    def push(
        offset: int,
        faces_of: wp.array2d(dtype=wp.int32),
        place_of: wp.array(dtype=wp.int32),
        face_force: wp.array(dtype=vector),
        mass: wp.array(dtype=real),
        fluid_force: wp.array(dtype=vector),
        acceleration: wp.array(dtype=point),
    ):
        """One structure particle: the sum of the forces on its faces [N], and the acceleration with it.

        The acceleration changes by what the force has changed, so that the whole of the coming step, its first half
        kick included, is made with the new force: what the fluid has lost in this step, the structure receives.
        """
        s = offset + wp.tid()
        total = vector()
        for n in range(2):
            k = faces_of[s, n]
            if k >= 0:
                total += face_force[place_of[k]]
        acceleration[s] += widen(total - fluid_force[s]) / wp.float64(mass[s])
        fluid_force[s] = total

    @wp.kernel(module=module, enable_backward=False)
    def find_mean_velocity(
        offset: int,
        duration: wp.array(dtype=wp.float64),
        which: int,
        early: wp.array(dtype=point),
        late: wp.array(dtype=point),
        velocity: wp.array(dtype=point),
    ):
        """One structure particle: the mean of its velocity from two displacements, `duration[which]` [s] apart."""
        s = offset + wp.tid()
        velocity[s] = (late[s] - early[s]) / duration[which]

    return FaceKernels(turn_sides, find_places, place, push, find_mean_velocity)
