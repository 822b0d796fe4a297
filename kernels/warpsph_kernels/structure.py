"""Kernels of total-Lagrangian structures: deformation, stress, forces, and the pointwise updates between them.

Structure particles keep the order and the neighbours of the reference configuration. A row of the list holds the
neighbours b of a particle a, and beside each the bond (X_ab, w_ab): X_ab = X_a - X_b [m] and w_ab = V_b F [1/m^2],
where grad0_a W_ab = F X_ab, so w_ab < 0. With the correction L_a = (-sum_b w_ab X_ab (x) X_ab)^-1, which is
symmetric, the corrected gradient of a neighbour is w_ab L_a X_ab. L_a stands before the sum: it is applied once a
particle, not once a bond.

The energy whose derivative the forces are is

    sum_a V_a [ psi(F_a) + penalty/2 sum_b |w_ab| |x_ab - F_a X_ab|^2 ].

A clamped particle is rigid: it has no strain and no energy, H = Q = 0 (its L is zero). Bonds with rigid particles
stand behind the others in a row; the penalty acts in them from the deformable side only.

Particles that do not lie on a lattice have a gradient vector d_ab for each bond instead of w_ab L_a X_ab, made so that
a uniform stress exerts no force inside; then f_a = sum_b (P_a d_ab - V_b/V_a P_b d_ba) + the part of the penalty, where
the fit stays the weighted one.

Since F_a is the weighted least-squares fit of x_ab = F_a X_ab with the same weights, the fit does not change the second
part to first order, and both parts together give the force per reference volume

    sum_b w_ab [ (Q_a + Q_b) X_ab + 2 penalty u_ab ],    Q = P L - penalty H,    H = F - I.

Between two materials that are bonded to each other, 2 penalty is the sum of both.
"""

import hashlib
from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic, make_narrow, make_packing, make_widen
from warpsph_kernels.materials import LAWS, LawOptions, make_material_struct
from warpsph_kernels.pose import make_pose_struct

STEP, DAMPING, SUB_STEP = range(3)
"""Entries of the clock of structures, all float64: step [s], damping of every structure [1/s], and how many steps have
been made since time laws were last evaluated."""
CLOCK_SIZE = 3


@dataclass(frozen=True)
class StructureOptions:
    """Everything that selects structure code; numbers are in the material structs instead."""

    arithmetic: Arithmetic
    moving_clamps: bool
    """Whether some clamp moves by a prescribed law."""
    loads: int
    """Number of loads with a time law, gravity not counted."""
    damped: bool
    contact: bool
    immersed: bool
    """Whether fluid acts on structures."""
    moving_walls: bool
    """Whether some wall that is touched moves by a prescribed law."""
    thin: bool
    """Whether the neighbours of some particle lie in a plane or on a line."""
    scattered: bool = False
    """Whether particles do not lie on a lattice, so that every bond brings the gradients of its two ends."""
    bonded: bool = False
    """Whether structures of different materials are bonded to each other."""

    @property
    def module(self) -> str:
        """Name of the kernel module of these options, the same in every process so that its binary is reused."""
        digest = hashlib.sha256(repr(self).encode()).hexdigest()[:10]
        return f"warpsph_structure_{self.arithmetic.label}_{digest}"

    def module_of(self, law: str, plane_stress: bool) -> str:
        """Name of the module of the kernels of one constitutive law, which are compiled together."""
        return f"{self.module}_{law}_{int(plane_stress)}"


class StructureKernels(NamedTuple):
    """Kernels of structures, in the order of a step."""

    drift: Any
    accelerate: Any
    tick: Any


@cache
def make_turned_normal(arithmetic: Arithmetic) -> Any:
    """Return the device function `turned_normal(F, n)`: the unit normal of a deformed plane, cof(F) n / |cof(F) n|.

    Zero for n = 0.
    """
    dim, vector, matrix = arithmetic.dimension, arithmetic.vector, arithmetic.matrix

    def turned_normal(F: matrix, normal: vector):
        turned = vector()
        if wp.static(dim == 2):
            turned[0] = F[1, 1] * normal[0] - F[1, 0] * normal[1]
            turned[1] = F[0, 0] * normal[1] - F[0, 1] * normal[0]
        else:
            rows = wp.transpose(F)
            turned = (
                wp.cross(rows[1], rows[2]) * normal[0]
                + wp.cross(rows[2], rows[0]) * normal[1]
                + wp.cross(rows[0], rows[1]) * normal[2]
            )
        return wp.normalize(turned)

    return wp.func(turned_normal)


@cache
def make_thin_completion(arithmetic: Arithmetic) -> Any:
    """Return the device function `complete(H, normal) -> H` of particles whose neighbours lie in a plane.

    Such neighbours say nothing of F along the normal n of their plane. F n is taken to be the unit normal of the
    deformed plane: no stretch and no shear across, whatever the rotation.
    """
    dim, real, vector = arithmetic.dimension, arithmetic.real, arithmetic.vector
    matrix = arithmetic.matrix
    turned_normal = make_turned_normal(arithmetic)

    def complete(H: matrix, normal: vector):
        F = wp.identity(n=wp.static(dim), dtype=real) + H
        return H + wp.outer(turned_normal(F, normal) - F * normal, normal)

    return wp.func(complete)


@cache
def make_stress_kernel(options: StructureOptions, law: str, plane_stress: bool) -> Any:
    """Return the kernel `strain_and_stress` of one constitutive law."""
    arithmetic = options.arithmetic
    dim, vector, record = arithmetic.dimension, arithmetic.vector, arithmetic.record
    point, matrix = arithmetic.point, arithmetic.matrix
    material = make_material_struct(arithmetic)
    _, unpack = make_packing(arithmetic)
    narrow = make_narrow(arithmetic)
    stress_of = LAWS[law](LawOptions(arithmetic, plane_stress))
    complete = make_thin_completion(arithmetic)

    @wp.kernel(module=options.module_of(law, plane_stress), enable_backward=False)
    def strain_and_stress(
        offset: int,
        first: int,
        materials: wp.array(dtype=material),
        structure: wp.array(dtype=wp.int32),
        neighbours: wp.array2d(dtype=wp.int32),
        bonds: wp.array2d(dtype=record),
        ends: wp.array2d(dtype=wp.int32),
        correction: wp.array(dtype=matrix),
        thin_normal: wp.array(dtype=record),
        own_gradient: wp.array2d(dtype=vector),
        displacement: wp.array(dtype=point),
        gradient: wp.array(dtype=matrix),
        traction: wp.array(dtype=matrix),
        stress: wp.array(dtype=matrix),
    ):
        """One particle: H_a = sum_b V_b (u_b - u_a) (x) L_a grad0 W_ab, then Q_a = P_a L_a - penalty H_a.

        `gradient` receives H [1], `traction` Q [Pa m^2]; differences of displacements are taken in double. Of scattered
        particles `stress` receives P_a, and Q has no part of it.
        """
        i = first + offset + wp.tid()
        u_a = displacement[i]
        moment = matrix()
        H = matrix()
        for n in range(ends[i, 1]):
            bond = bonds[i, n]
            u_ab = narrow(u_a, displacement[neighbours[i, n]])
            moment -= wp.outer(bond[dim] * u_ab, unpack(bond))
            if wp.static(options.scattered):
                H -= wp.outer(u_ab, own_gradient[i, n])
        L = correction[i]
        fitted = moment * L
        if wp.static(not options.scattered):
            H = fitted
        p = materials[structure[i]]
        P = matrix()
        if wp.static(options.thin):
            thin = thin_normal[i]
            P, _psi, _P_33 = stress_of(complete(H, unpack(thin)), p)
            P = thin[dim] * P
        else:
            P, _psi, _P_33 = stress_of(H, p)
        if wp.static(options.scattered):
            stress[i] = P
            traction[i] = -p.penalty * fitted
        else:
            traction[i] = P * L - p.penalty * fitted
        gradient[i] = H

    return strain_and_stress


@cache
def make_structure_kernels(options: StructureOptions) -> StructureKernels:
    """Return the kernels that move structures, whatever their laws."""
    arithmetic = options.arithmetic
    dim, real, vector = arithmetic.dimension, arithmetic.real, arithmetic.vector
    record, point, matrix = arithmetic.record, arithmetic.point, arithmetic.matrix
    material = make_material_struct(arithmetic)
    pose_type = make_pose_struct(arithmetic)
    _, unpack = make_packing(arithmetic)
    narrow, widen = make_narrow(arithmetic), make_widen(arithmetic)
    tracks_work = options.loads > 0 or options.moving_clamps or options.immersed

    @wp.func
    def masked(mask: vector, a: point, b: point):
        """The components of a where the mask is 1, of b where it is 0."""
        out = point()
        for k in range(wp.static(dim)):
            out[k] = wp.where(mask[k] > real(0.5), a[k], b[k])
        return out

    @wp.func
    def pair_force(
        bond: record,
        Q_a: matrix,
        u_a: point,
        b: int,
        penalty: real,
        traction: wp.array(dtype=matrix),
        displacement: wp.array(dtype=point),
    ):
        """Force of the neighbour b per reference volume; it changes its sign when a and b are exchanged."""
        u_ab = narrow(u_a, displacement[b])
        return bond[dim] * ((Q_a + traction[b]) * unpack(bond) + penalty * u_ab)

    @wp.func
    def clamp_power(pose: pose_type, X: point, mask: vector, a: point):
        """Power per mass of a clamp [W/kg]: what it adds to the acceleration a of the other forces, times v."""
        added = pose.rotation_acceleration * X + pose.shift_acceleration - a
        return wp.dot(added, masked(mask, point(), pose.rotation_rate * X + pose.shift_rate))

    @wp.kernel(module=options.module, enable_backward=False)
    def drift(
        offset: int,
        clock: wp.array(dtype=wp.float64),
        materials: wp.array(dtype=material),
        structure: wp.array(dtype=wp.int32),
        volume: wp.array(dtype=real),
        free: wp.array(dtype=vector),
        clamp: wp.array(dtype=wp.int32),
        prescriptions: wp.array2d(dtype=pose_type),
        reference: wp.array(dtype=point),
        load: wp.array2d(dtype=vector),
        load_factor: wp.array2d(dtype=wp.float64),
        fluid_force: wp.array(dtype=vector),
        acceleration: wp.array(dtype=point),
        displacement: wp.array(dtype=point),
        velocity: wp.array(dtype=point),
        work: wp.array(dtype=wp.float64),
    ):
        """One particle: velocity over half a step, displacement over the whole step; clamped components as prescribed.

        `work` [J] gains what loads and fluid do to the particle in the step, and half of what moving clamps do: the
        other half follows when the forces at the end of the step are known, so that the sum is a trapezoidal rule.
        """
        i = offset + wp.tid()
        step = clock[wp.static(STEP)]
        now = int(clock[wp.static(SUB_STEP)])
        v = velocity[i]
        a = acceleration[i]
        half = v + wp.float64(0.5) * step * a
        if wp.static(options.damped):
            rate = wp.float64(materials[structure[i]].damping) + clock[wp.static(DAMPING)]
            half -= wp.float64(0.5) * step * rate * v
        half = masked(free[i], half, point())
        u = displacement[i] + step * half
        if wp.static(tracks_work):
            mass = wp.float64(materials[structure[i]].density * volume[i])
            done = wp.float64(0.0)
            for k in range(wp.static(options.loads)):
                factor = load_factor[now, k] + load_factor[now + 1, k]
                done += wp.float64(0.5) * factor * mass * step * wp.dot(widen(load[k, i]), half)
            if wp.static(options.moving_clamps):
                if clamp[i] >= 0:
                    after = prescriptions[now + 1, clamp[i]]
                    X = reference[i]
                    mask = free[i]
                    power = clamp_power(prescriptions[now, clamp[i]], X, mask, a)
                    done += wp.float64(0.5) * step * mass * power
                    u = masked(mask, u, after.rotation * X + after.shift - X)
                    half = masked(mask, half, after.rotation_rate * X + after.shift_rate)
            if wp.static(options.immersed):
                done += wp.dot(widen(fluid_force[i]), u - displacement[i])
            work[i] += done
        displacement[i] = u
        velocity[i] = half

    @wp.kernel(module=options.module, enable_backward=False)
    def accelerate(
        offset: int,
        clock: wp.array(dtype=wp.float64),
        gravity: vector,
        materials: wp.array(dtype=material),
        structure: wp.array(dtype=wp.int32),
        neighbours: wp.array2d(dtype=wp.int32),
        bonds: wp.array2d(dtype=record),
        ends: wp.array2d(dtype=wp.int32),
        penalty: wp.array(dtype=real),
        traction: wp.array(dtype=matrix),
        stress: wp.array(dtype=matrix),
        own_gradient: wp.array2d(dtype=vector),
        other_gradient: wp.array2d(dtype=vector),
        displacement: wp.array(dtype=point),
        volume: wp.array(dtype=real),
        free: wp.array(dtype=vector),
        clamp: wp.array(dtype=wp.int32),
        prescriptions: wp.array2d(dtype=pose_type),
        reference: wp.array(dtype=point),
        load: wp.array2d(dtype=vector),
        load_factor: wp.array2d(dtype=wp.float64),
        contact_force: wp.array(dtype=vector),
        fluid_force: wp.array(dtype=vector),
        acceleration: wp.array(dtype=point),
        velocity: wp.array(dtype=point),
        work: wp.array(dtype=wp.float64),
        dissipated: wp.array(dtype=wp.float64),
    ):
        """One particle: rho0 dv_a/dt = sum_b w_ab [(Q_a + Q_b) X_ab + 2 penalty u_ab] + rho0 g + loads + fluid.

        Beside a rigid particle there is one penalty, not two.

        Then the velocity over the second half of the step. `acceleration` is that without clamps, so that the
        reaction of a clamp is what is missing to the prescribed one. `dissipated` [J] gains the work of damping.
        """
        i = offset + wp.tid()
        p = materials[structure[i]]
        u_a = displacement[i]
        Q_a = traction[i]
        total = vector()
        end = ends[i, 0]
        if wp.static(options.bonded):
            for n in range(ends[i, 1]):
                b = neighbours[i, n]
                both = penalty[i] + penalty[b]
                total += pair_force(bonds[i, n], Q_a, u_a, b, both, traction, displacement)
        else:
            for n in range(end):
                total += pair_force(
                    bonds[i, n], Q_a, u_a, neighbours[i, n], real(2.0) * p.penalty, traction, displacement
                )
            for n in range(end, ends[i, 1]):
                total += pair_force(
                    bonds[i, n], Q_a, u_a, neighbours[i, n], p.penalty, traction, displacement
                )
        if wp.static(options.scattered):
            P_a = stress[i]
            for n in range(ends[i, 1]):
                total += P_a * own_gradient[i, n] + stress[neighbours[i, n]] * other_gradient[i, n]
        if wp.static(options.contact):
            total += contact_force[i] / volume[i]
        if wp.static(options.immersed):
            total += fluid_force[i] / volume[i]
        a = widen(total / p.density + gravity)
        for k in range(wp.static(options.loads)):
            a += load_factor[int(clock[wp.static(SUB_STEP)]) + 1, k] * widen(load[k, i])
        acceleration[i] = a
        step = clock[wp.static(STEP)]
        half = velocity[i]
        v = half + wp.float64(0.5) * step * a
        if wp.static(options.damped):
            rate = wp.float64(p.damping) + clock[wp.static(DAMPING)]
            v = v / (wp.float64(1.0) + wp.float64(0.5) * step * rate)
            mass = wp.float64(p.density * volume[i])
            middle = masked(free[i], half, point())
            dissipated[i] += step * rate * mass * wp.dot(middle, middle)
        if wp.static(options.moving_clamps):
            if clamp[i] >= 0:
                pose = prescriptions[int(clock[wp.static(SUB_STEP)]) + 1, clamp[i]]
                power = clamp_power(pose, reference[i], free[i], a)
                work[i] += wp.float64(0.5) * step * wp.float64(p.density * volume[i]) * power
        velocity[i] = masked(free[i], v, half)

    @wp.kernel(module=options.module, enable_backward=False)
    def tick(offset: int, clock: wp.array(dtype=wp.float64)):
        """One thread: the step is over, time laws go on to their next values."""
        clock[wp.static(SUB_STEP)] += wp.float64(1.0)

    return StructureKernels(drift, accelerate, tick)
