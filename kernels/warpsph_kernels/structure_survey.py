"""What a structure shows of itself: extremes that limit the step, and energies and stresses for output."""

from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import make_narrow, make_packing
from warpsph_kernels.materials import (
    LAWS,
    LawOptions,
    make_kinematics,
    make_material_struct,
)
from warpsph_kernels.structure import StructureOptions, make_thin_completion

BLOCK = 256
"""Particles a thread of `survey` reads."""
SPEED, STIFFENING, FLATTENING, WORST, FAULTS = range(5)
"""Columns of the extremes: largest |v|^2 [m^2/s^2], largest stiffness along a principal direction over that at rest,
largest -J, the index of the particle with it, and the number of particles that are not finite."""
EXTREMES = 5
PROBE_STRETCH = 1.0e-3
"""Relative stretch by which the stiffness of the present state is probed: in single precision its stress is known to
four digits, and the law is linear over it to three."""


@cache
def make_principal_frame(options: StructureOptions) -> Any:
    """Return the device function whose columns are the principal directions of F^T F, for a given H."""
    arithmetic = options.arithmetic
    real, dim, matrix = arithmetic.real, arithmetic.dimension, arithmetic.matrix

    def principal_frame(H: matrix):
        strain = H + wp.transpose(H) + wp.transpose(H) * H
        frame = matrix()
        if wp.static(dim == 2):
            angle = real(0.5) * wp.atan2(real(2.0) * strain[0, 1], strain[0, 0] - strain[1, 1])
            frame = matrix(wp.cos(angle), -wp.sin(angle), wp.sin(angle), wp.cos(angle))
        else:
            frame, _values = wp.eig3(strain)
        return frame

    return wp.func(principal_frame)


@cache
def make_survey_kernel(options: StructureOptions, law: str, plane_stress: bool) -> Any:
    """Return the kernel `survey` of the structures with one constitutive law."""
    arithmetic = options.arithmetic
    dim, real, vector, point = arithmetic.dimension, arithmetic.real, arithmetic.vector, arithmetic.point
    matrix, material = arithmetic.matrix, make_material_struct(arithmetic)
    stress_of = LAWS[law](LawOptions(arithmetic, plane_stress))
    record = arithmetic.record
    _, unpack = make_packing(arithmetic)
    principal_frame = make_principal_frame(options)
    complete = make_thin_completion(arithmetic)
    volume_change, _ = make_kinematics(arithmetic)

    @wp.func
    def stiffening(H: matrix, p: material):
        """Largest change of stress by a stretch along a principal direction, over that of the material at rest."""
        F = wp.identity(n=wp.static(dim), dtype=real) + H
        frame = principal_frame(H)
        P, _psi, _P_33 = stress_of(H, p)
        largest = real(0.0)
        for k in range(wp.static(dim)):
            N = vector()
            for c in range(wp.static(dim)):
                N[c] = frame[c, k]
            n = wp.normalize(F * N)
            more, _psi_more, _P_33_more = stress_of(H + wp.outer(real(wp.static(PROBE_STRETCH)) * n, N), p)
            largest = wp.max(largest, wp.dot(n, (more - P) * N))
        stiffness = p.lame + real(2.0) * p.shear_modulus
        return largest / (real(wp.static(PROBE_STRETCH)) * stiffness)

    @wp.kernel(module=options.module_of(law, plane_stress), enable_backward=False)
    def survey(
        offset: int,
        first: int,
        count: int,
        first_row: int,
        materials: wp.array(dtype=material),
        structure: wp.array(dtype=wp.int32),
        thin_normal: wp.array(dtype=record),
        gradient: wp.array(dtype=matrix),
        velocity: wp.array(dtype=point),
        acceleration: wp.array(dtype=point),
        extremes: wp.array2d(dtype=wp.float64),
    ):
        """One block of particles: its extremes, see the columns above.

        A particle whose neighbours see not even a plane has no J, and no stress that could stiffen.
        """
        block = offset + wp.tid()
        speed = wp.float64(0.0)
        stiffest = wp.float64(0.0)
        flattest = wp.float64(-1.0e30)
        worst = int(0)
        faults = wp.float64(0.0)
        for k in range(wp.static(BLOCK)):
            i = first + block * wp.static(BLOCK) + k
            if i < first + count:
                v = velocity[i]
                a = acceleration[i]
                H = gradient[i]
                if wp.static(options.thin):
                    H = thin_normal[i][dim] * complete(H, unpack(thin_normal[i]))
                J = wp.float64(1.0) + wp.float64(volume_change(H))
                if wp.isfinite(J) and flattest < -J:
                    flattest = -J
                    worst = i
                if wp.isfinite(wp.dot(v, v) + wp.dot(a, a) + J):
                    speed = wp.max(speed, wp.dot(v, v))
                    stiffest = wp.max(stiffest, wp.float64(stiffening(H, materials[structure[i]])))
                else:
                    faults += wp.float64(1.0)
        row = first_row + block
        extremes[row, wp.static(SPEED)] = speed
        extremes[row, wp.static(STIFFENING)] = stiffest
        extremes[row, wp.static(FLATTENING)] = flattest
        extremes[row, wp.static(WORST)] = wp.float64(worst)
        extremes[row, wp.static(FAULTS)] = faults

    return survey


@cache
def make_observation_kernel(options: StructureOptions, law: str, plane_stress: bool) -> Any:
    """Return the kernel `observe` of the structures with one constitutive law."""
    arithmetic = options.arithmetic
    dim, real, point = arithmetic.dimension, arithmetic.real, arithmetic.point
    record, matrix, material = arithmetic.record, arithmetic.matrix, make_material_struct(arithmetic)
    tensor = wp.types.matrix((3, 3), real)
    _, unpack = make_packing(arithmetic)
    narrow = make_narrow(arithmetic)
    stress_of = LAWS[law](LawOptions(arithmetic, plane_stress))
    complete = make_thin_completion(arithmetic)
    volume_change, _ = make_kinematics(arithmetic)

    @wp.kernel(module=options.module_of(law, plane_stress), enable_backward=False)
    def observe(
        offset: int,
        first: int,
        materials: wp.array(dtype=material),
        structure: wp.array(dtype=wp.int32),
        volume: wp.array(dtype=real),
        neighbours: wp.array2d(dtype=wp.int32),
        bonds: wp.array2d(dtype=record),
        ends: wp.array2d(dtype=wp.int32),
        correction: wp.array(dtype=matrix),
        thin_normal: wp.array(dtype=record),
        displacement: wp.array(dtype=point),
        gradient: wp.array(dtype=matrix),
        traction: wp.array(dtype=matrix),
        energies: wp.array2d(dtype=wp.float64),
        cauchy: wp.array(dtype=tensor),
    ):
        """One particle: its strain and hourglass energies [J] and its Cauchy stress P F^T / J [Pa].

        In two dimensions the last entry of the stress is that out of the plane, per area of the deformed plane.
        """
        i = first + offset + wp.tid()
        p = materials[structure[i]]
        H = gradient[i]
        u_a = displacement[i]
        fitted = H
        if wp.static(options.scattered):
            fitted = -traction[i] / wp.max(p.penalty, real(1.0e-30))
        misfit = wp.float64(0.0)
        if wp.trace(correction[i]) > real(0.0):  # a rigid particle has none
            for n in range(ends[i, 1]):
                bond = bonds[i, n]
                rest = narrow(u_a, displacement[neighbours[i, n]]) - fitted * unpack(bond)
                misfit -= wp.float64(bond[dim] * wp.dot(rest, rest))
        share = real(1.0)
        if wp.static(options.thin):
            H = complete(H, unpack(thin_normal[i]))
            share = thin_normal[i][dim]
        P, psi, P_33 = stress_of(H, p)
        V = wp.float64(volume[i])
        energies[i, 0] = V * wp.float64(share * psi)
        energies[i, 1] = wp.float64(0.5) * V * wp.float64(p.penalty) * misfit
        J = real(1.0) + volume_change(H)
        sigma = share / J * (P + P * wp.transpose(H))
        out = tensor()
        for row in range(wp.static(dim)):
            for column in range(wp.static(dim)):
                out[row, column] = sigma[row, column]
        if wp.static(dim == 2):
            out[2, 2] = share * P_33 / J
        cauchy[i] = out

    return observe
