"""Planes of symmetry: mirror images of the fluid near them, which the pair loops read as fluid.

An image is a particle with an index of its own behind the fluid's. Its `source` is the particle that it mirrors and its
`mirrors` say how: one digit of base 3 an axis, 0 for not at all, 1 for the plane at the low end, 2 for the high one.
"""

from functools import cache
from typing import Any, NamedTuple

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic, make_packing


class SymmetryKernels(NamedTuple):
    """Kernels of symmetry planes; the first three run when lists are made, the others within the step."""

    reflect: Any
    count_images: Any
    make_images: Any
    mirror_pressure: Any
    mirror_density: Any


@cache
def make_planes_struct(arithmetic: Arithmetic) -> Any:
    """Return the struct of the planes: coordinates in run coordinates [m], -inf or inf where there is none, and the
    distance within which a particle has an image [m]."""
    real, vector = arithmetic.real, arithmetic.vector

    class SymmetryPlanes:
        pass

    SymmetryPlanes.__annotations__ = {"low": vector, "high": vector, "reach": real}
    return wp.struct(SymmetryPlanes)


@cache
def make_symmetry_kernels(arithmetic: Arithmetic) -> SymmetryKernels:
    """Return the kernels of symmetry planes."""
    dim, real, vector = arithmetic.dimension, arithmetic.real, arithmetic.vector
    record, point = arithmetic.record, arithmetic.point
    planes_type = make_planes_struct(arithmetic)
    pack, unpack = make_packing(arithmetic)
    module = f"warpsph_symmetry_{arithmetic.label}"
    codes = 3**dim

    @wp.func
    def digit(code: int, axis: int):
        rest = code
        for _ in range(axis):
            rest = rest // 3
        return rest % 3

    @wp.func
    def has_image(x: vector, code: int, planes: planes_type):
        near = bool(True)
        for k in range(wp.static(dim)):
            side = digit(code, k)
            if side == 1 and x[k] - planes.low[k] > planes.reach:
                near = False
            if side == 2 and planes.high[k] - x[k] > planes.reach:
                near = False
        return near

    @wp.func
    def mirrored(x: vector, code: int, planes: planes_type):
        image = x
        for k in range(wp.static(dim)):
            side = digit(code, k)
            if side == 1:
                image[k] = real(2.0) * planes.low[k] - x[k]
            if side == 2:
                image[k] = real(2.0) * planes.high[k] - x[k]
        return image

    @wp.func
    def turned(v: vector, code: int):
        image = v
        for k in range(wp.static(dim)):
            if digit(code, k) > 0:
                image[k] = -v[k]
        return image

    @wp.kernel(module=module, enable_backward=False)
    def reflect(
        offset: int,
        low: point,
        high: point,
        position: wp.array(dtype=point),
        velocity_volume: wp.array(dtype=record),
        acceleration: wp.array(dtype=vector),
    ):
        """One fluid particle: if it has passed a plane, change it for its image, which has come the other way."""
        i = offset + wp.tid()
        x = position[i]
        vV = velocity_volume[i]
        a = acceleration[i]
        for k in range(wp.static(dim)):
            inside = wp.clamp(x[k], low[k], high[k])
            if inside != x[k]:
                x[k] = wp.float64(2.0) * inside - x[k]
                vV[k] = -vV[k]
                a[k] = -a[k]
        position[i] = x
        velocity_volume[i] = vV
        acceleration[i] = a

    @wp.kernel(module=module, enable_backward=False)
    def count_images(
        offset: int,
        planes: planes_type,
        listed_position: wp.array(dtype=vector),
        images: wp.array(dtype=wp.int32),
    ):
        """One fluid particle: how many images it has."""
        i = offset + wp.tid()
        count = int(0)
        for code in range(1, wp.static(codes)):
            if has_image(listed_position[i], code, planes):
                count += 1
        images[i] = count

    @wp.kernel(module=module, enable_backward=False)
    def make_images(
        offset: int,
        planes: planes_type,
        first_image: int,
        images: wp.array(dtype=wp.int32),
        ends: wp.array(dtype=wp.int32),
        listed_position: wp.array(dtype=vector),
        source: wp.array(dtype=wp.int32),
        mirrors: wp.array(dtype=wp.int32),
    ):
        """One fluid particle: write its images, behind those of the particles before it."""
        i = offset + wp.tid()
        place = ends[i] - images[i]
        for code in range(1, wp.static(codes)):
            if has_image(listed_position[i], code, planes):
                source[place] = i
                mirrors[place] = code
                listed_position[first_image + place] = mirrored(listed_position[i], code, planes)
                place += 1

    @wp.kernel(module=module, enable_backward=False)
    def mirror_pressure(
        offset: int,
        planes: planes_type,
        first_image: int,
        source: wp.array(dtype=wp.int32),
        mirrors: wp.array(dtype=wp.int32),
        position_pressure: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        density_deviation: wp.array(dtype=real),
    ):
        """One image: position, pressure, velocity, volume and density of its source, mirrored."""
        i = offset + wp.tid()
        a, code = source[i], mirrors[i]
        g = first_image + i
        xp, vV = position_pressure[a], velocity_volume[a]
        position_pressure[g] = pack(mirrored(unpack(xp), code, planes), xp[wp.static(dim)])
        velocity_volume[g] = pack(turned(unpack(vV), code), vV[wp.static(dim)])
        density_deviation[g] = density_deviation[a]

    @wp.kernel(module=module, enable_backward=False)
    def mirror_density(
        offset: int,
        planes: planes_type,
        first_image: int,
        source: wp.array(dtype=wp.int32),
        mirrors: wp.array(dtype=wp.int32),
        position_density: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
    ):
        """One image: position, density, velocity and volume of its source, mirrored."""
        i = offset + wp.tid()
        a, code = source[i], mirrors[i]
        g = first_image + i
        xd, vV = position_density[a], velocity_volume[a]
        position_density[g] = pack(mirrored(unpack(xd), code, planes), xd[wp.static(dim)])
        velocity_volume[g] = pack(turned(unpack(vV), code), vV[wp.static(dim)])

    return SymmetryKernels(reflect, count_images, make_images, mirror_pressure, mirror_density)
