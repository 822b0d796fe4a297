"""Kernels of contact: structures against structures, themselves and rigid walls, on current positions.

Contact particles are the surface particles of structures, then those of walls, in an index space of their own. `near`
lists those of structures, then those of walls that a structure may come to soon: all others feel nothing. Each
feels how much of foreign bodies is near it, as a sum over foreign surface particles b,

    c_a = sum_b W^_ab,    W^ = dp^d W  (a smoothing kernel, dimensionless),

which is a function of the distance to a foreign surface and hardly knows of the single particles in it: a sum of the
range of three spacings is so smooth that one lattice slides over another. With the value c_0 that a particle has one
spacing before a flat surface, where their cells touch, the energy of contact and
the force that is its gradient are

    sum_a K/2 max(c_a - c_0, 0)^2,        f_ab = -(q_a + q_b) grad_a W^_ab,    q = K max(c - c_0, 0):

opposite for b, and along the line between both.

With friction every contact particle is held by a spring to the foreign surface before it. Its slip s_a grows with the
velocity against the weighted mean of that surface, v_a - sum_b w_ab v_b, w_ab = W^_ab / c_a, across the normal, less
what comes from the turning of the normal. Its force T_a = -k s_a is at most mu N_a, N_a = q_a |sum_b grad_a W^_ab|
(Coulomb's law with an elastic stick, as a radial return; Wriggers 2006). It acts on a, and its opposite in the parts
w_ab on the particles of that surface.
"""

import hashlib
from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic, make_narrow, make_widen
from warpsph_kernels.pose import make_pose_struct
from warpsph_kernels.smoothing import SMOOTHING_KERNELS
from warpsph_kernels.structure import STEP, SUB_STEP

WENDLAND_C2 = SMOOTHING_KERNELS["wendland_c2"]
WALL = wp.constant(-1)
"""Body of a contact particle that belongs to a wall."""


@dataclass(frozen=True)
class ContactOptions:
    """Everything that selects contact code."""

    arithmetic: Arithmetic
    friction: bool
    own_surface: bool
    """Whether a structure touches itself."""

    @property
    def module(self) -> str:
        """Name of the kernel module of these options."""
        digest = hashlib.sha256(repr(self).encode()).hexdigest()[:10]
        return f"warpsph_contact_{self.arithmetic.label}_{digest}"


@cache
def make_contact_struct(arithmetic: Arithmetic) -> Any:
    """Return the struct of numbers.

    inverse_h [1/m]; norm: W^ = norm f(q) [1]; slope_norm: grad W^ = slope_norm f'(q)/q x [1/m^2]; threshold c_0 [1];
    stiffness K [J]; friction mu [1]; stick: k [N/m]; reach of the lists and reference distance below which a structure
    does not touch itself [m]; bodies: number of contact particles of structures.
    """
    real = arithmetic.real

    class Contact:
        pass

    lengths = ("inverse_h", "norm", "slope_norm", "reach", "exclusion")
    names = (*lengths, "threshold", "stiffness", "friction", "stick")
    Contact.__annotations__ = dict.fromkeys(names, real) | {"bodies": wp.int32}
    return wp.struct(Contact)


class ContactKernels(NamedTuple):
    """Kernels of contact in the order of their use: two for lists, three for every step, two for output."""

    spread: Any
    list_pairs: Any
    place: Any
    sense: Any
    push: Any
    react: Any
    observe: Any


@cache
def make_pair_force(options: ContactOptions) -> Any:
    """Return the device function `pair_force(...) -> vector`: the force of b on a [N]."""
    arithmetic = options.arithmetic
    real, vector, point = arithmetic.real, arithmetic.vector, arithmetic.point
    contact = make_contact_struct(arithmetic)
    shape, slope = WENDLAND_C2.make(arithmetic)
    narrow = make_narrow(arithmetic)

    def pair_force(
        a: int,
        b: int,
        p: contact,
        position: wp.array(dtype=point),
        pressure: wp.array(dtype=real),
        drag: wp.array(dtype=vector),
    ):
        x_ab = narrow(position[a], position[b])
        q = wp.length(x_ab) * p.inverse_h
        force = -(pressure[a] + pressure[b]) * p.slope_norm * slope(q) * x_ab
        if wp.static(options.friction):
            force += shape(q) * (drag[a] - drag[b])
        return force

    return wp.func(pair_force)


@cache
def make_stick(options: ContactOptions) -> Any:
    """Return the device function `stick(slip, moved, turned, normal, press, p) -> (slip, heat)`: a radial return.

    `moved` [m] is what the particle has moved against the foreign surface in the step, `turned` [m] the part of it that
    comes from both turning together, as the centres of their particles are apart; `press` its N_a [N]. The heat [J] is
    the work of the mean of the forces before and after, to second order what velocity Verlet takes from the bodies,
    less what the spring stores. It includes the work of the couple that two opposite forces form.
    """
    real, vector = options.arithmetic.real, options.arithmetic.vector
    contact = make_contact_struct(options.arithmetic)

    def stick(slip: vector, moved: vector, turned: vector, normal: vector, press: real, p: contact):
        held = slip + moved - turned
        held -= wp.dot(held, normal) * normal
        length = wp.length(held)
        limit = p.friction * press / p.stick
        if length > limit:
            held *= limit / length
        return held, real(0.5) * p.stick * wp.dot(slip + held, slip + moved - held)

    return wp.func(stick)


@cache
def make_contact_kernels(options: ContactOptions) -> ContactKernels:
    """Return the kernels of contact."""
    arithmetic = options.arithmetic
    dim, real, vector, point = arithmetic.dimension, arithmetic.real, arithmetic.vector, arithmetic.point
    contact, pose_type = make_contact_struct(arithmetic), make_pose_struct(arithmetic)
    shape, slope = WENDLAND_C2.make(arithmetic)
    pair_force, stick = make_pair_force(options), make_stick(options)
    narrow, widen = make_narrow(arithmetic), make_widen(arithmetic)

    @wp.kernel(module=options.module, enable_backward=False)
    def spread(
        offset: int,
        origin: point,
        near: wp.array(dtype=wp.int32),
        position: wp.array(dtype=point),
        places: wp.array(dtype=wp.vec3),
    ):
        """One near contact particle: its place for the hash grid, from the origin [m]."""
        k = offset + wp.tid()
        x = position[near[k]] - origin
        place = wp.vec3()
        for axis in range(wp.static(dim)):
            place[axis] = wp.float32(x[axis])
        places[k] = place

    @wp.func
    def may_touch(
        a: int,
        b: int,
        p: contact,
        body: wp.array(dtype=wp.int32),
        rest: wp.array(dtype=point),
    ):
        """Whether a pair takes part: not two wall particles, not two neighbours of one structure."""
        if a == b:
            return False
        if body[a] != body[b]:
            return True
        if wp.static(not options.own_surface) or body[a] == WALL:
            return False
        return wp.length(narrow(rest[a], rest[b])) > p.exclusion

    @wp.kernel(module=options.module, enable_backward=False)
    def list_pairs(
        offset: int,
        grid: wp.uint64,
        p: contact,
        near: wp.array(dtype=wp.int32),
        places: wp.array(dtype=wp.vec3),
        position: wp.array(dtype=point),
        rest: wp.array(dtype=point),
        body: wp.array(dtype=wp.int32),
        rows: wp.array2d(dtype=wp.int32),
        counts: wp.array(dtype=wp.int32),
    ):
        """One near contact particle: all that it may touch, by rising index; the count may exceed the row.

        In this order sums do not depend on when a list was made: what is too far adds zero.
        """
        k = offset + wp.tid()
        a = near[k]
        capacity = rows.shape[1]
        found = int(0)
        for n in wp.hash_grid_query(grid, places[k], wp.float32(p.reach)):
            b = near[n]
            if may_touch(a, b, p, body, rest) and wp.length(narrow(position[a], position[b])) < p.reach:
                if found < capacity:
                    slot = found
                    while slot > 0 and rows[a, wp.max(slot - 1, 0)] > b:
                        rows[a, slot] = rows[a, slot - 1]
                        slot -= 1
                    rows[a, slot] = b
                found += 1
        counts[a] = found

    @wp.kernel(module=options.module, enable_backward=False)
    def place(
        offset: int,
        p: contact,
        clock: wp.array(dtype=wp.float64),
        near: wp.array(dtype=wp.int32),
        owner: wp.array(dtype=wp.int32),
        rest: wp.array(dtype=point),
        prescriptions: wp.array2d(dtype=pose_type),
        displacement: wp.array(dtype=point),
        structure_velocity: wp.array(dtype=point),
        position: wp.array(dtype=point),
        velocity: wp.array(dtype=point),
    ):
        """One near contact particle: where it is now.

        `owner` of a particle of a structure is that particle, of a wall the column of its motion, -1 where it rests.
        """
        k = near[offset + wp.tid()]
        X = rest[k]
        if k < p.bodies:
            position[k] = X + displacement[owner[k]]
            velocity[k] = structure_velocity[owner[k]]
        elif owner[k] >= 0:
            pose = prescriptions[int(clock[wp.static(SUB_STEP)]) + 1, owner[k]]
            position[k] = pose.rotation * X + pose.shift
            velocity[k] = pose.rotation_rate * X + pose.shift_rate

    @wp.kernel(module=options.module, enable_backward=False)
    def sense(
        offset: int,
        p: contact,
        clock: wp.array(dtype=wp.float64),
        near: wp.array(dtype=wp.int32),
        position: wp.array(dtype=point),
        velocity: wp.array(dtype=point),
        rows: wp.array2d(dtype=wp.int32),
        counts: wp.array(dtype=wp.int32),
        nearness: wp.array(dtype=real),
        pressure: wp.array(dtype=real),
        drag: wp.array(dtype=vector),
        slip: wp.array(dtype=vector),
        normal: wp.array(dtype=vector),
        heat: wp.array(dtype=real),
    ):
        """One near contact particle: c_a [1], q_a [J]; with friction T_a norm / c_a [N], slip [m], normal, heat [J]."""
        a = near[offset + wp.tid()]
        x_a = position[a]
        c = real(0.0)
        gradient = vector()
        relative = vector()
        apart = vector()
        for k in range(counts[a]):
            b = rows[a, k]
            x_ab = narrow(x_a, position[b])
            q = wp.length(x_ab) * p.inverse_h
            w = shape(q)
            c += w
            if wp.static(options.friction):
                gradient -= slope(q) * x_ab
                relative += w * narrow(velocity[a], velocity[b])
                apart += w * x_ab
        excess = wp.max(p.norm * c - p.threshold, real(0.0))
        nearness[a] = p.norm * c
        pressure[a] = p.stiffness * excess
        if wp.static(options.friction):
            force = vector()
            moved = vector()
            turned = vector()
            n = wp.normalize(gradient)
            if c > real(0.0):
                moved = real(clock[wp.static(STEP)]) / c * relative
                turned = wp.dot(apart, n) / c * (n - normal[a])
            if wp.length(normal[a]) == real(0.0):
                turned = vector()
            press = pressure[a] * p.slope_norm * wp.length(gradient)
            s, lost = stick(slip[a], moved, turned, n, press, p)
            normal[a] = vector()
            if excess > real(0.0):
                force = -p.stick / c * s
                normal[a] = n
            heat[a] = lost
            slip[a] = s
            drag[a] = force

    @wp.func
    def part_of(a: int, b: int, p: contact, position: wp.array(dtype=point), nearness: wp.array(dtype=real)):
        """The part w_ba that particle a has in the surface before particle b [1]."""
        weight = p.norm * shape(wp.length(narrow(position[a], position[b])) * p.inverse_h)
        return wp.where(nearness[b] > real(0.0), weight / nearness[b], real(0.0))

    @wp.kernel(module=options.module, enable_backward=False)
    def push(
        offset: int,
        p: contact,
        clock: wp.array(dtype=wp.float64),
        owner: wp.array(dtype=wp.int32),
        body: wp.array(dtype=wp.int32),
        position: wp.array(dtype=point),
        velocity: wp.array(dtype=point),
        rows: wp.array2d(dtype=wp.int32),
        counts: wp.array(dtype=wp.int32),
        nearness: wp.array(dtype=real),
        pressure: wp.array(dtype=real),
        drag: wp.array(dtype=vector),
        heat: wp.array(dtype=real),
        force: wp.array(dtype=vector),
        work: wp.array(dtype=wp.float64),
        dissipated: wp.array(dtype=wp.float64),
    ):
        """One contact particle of a structure: the force on it [N].

        `work` [J] gains what moving walls do to it, `dissipated` [J] its heat and its part of that of walls.
        """
        a = offset + wp.tid()
        total = vector()
        done = wp.float64(0.0)
        lost = real(0.0)
        if wp.static(options.friction):
            lost = heat[a]
        for n in range(counts[a]):
            b = rows[a, n]
            f_ab = pair_force(a, b, p, position, pressure, drag)
            total += f_ab
            if body[b] == WALL:
                done += wp.dot(widen(f_ab), velocity[b])
                if wp.static(options.friction):
                    lost += part_of(a, b, p, position, nearness) * heat[b]
        i = owner[a]
        force[i] = total
        work[i] += clock[wp.static(STEP)] * done
        if wp.static(options.friction):
            dissipated[i] += wp.float64(lost)

    @wp.kernel(module=options.module, enable_backward=False)
    def react(
        offset: int,
        p: contact,
        position: wp.array(dtype=point),
        rows: wp.array2d(dtype=wp.int32),
        counts: wp.array(dtype=wp.int32),
        pressure: wp.array(dtype=real),
        drag: wp.array(dtype=vector),
        force: wp.array(dtype=vector),
    ):
        """One contact particle of a wall: the force on it [N]."""
        k = offset + wp.tid()
        a = p.bodies + k
        total = vector()
        for n in range(counts[a]):
            total += pair_force(a, rows[a, n], p, position, pressure, drag)
        force[k] = total

    @wp.func
    def energy_of(a: int, p: contact, nearness: wp.array(dtype=real), slip: wp.array(dtype=vector)):
        """Energy of the penalty and of the spring of friction of one contact particle [J]."""
        excess = wp.max(nearness[a] - p.threshold, real(0.0))
        twice = p.stiffness * excess * excess
        if wp.static(options.friction):
            twice += p.stick * wp.dot(slip[a], slip[a])
        return wp.float64(real(0.5) * twice)

    @wp.kernel(module=options.module, enable_backward=False)
    def observe(
        offset: int,
        p: contact,
        body: wp.array(dtype=wp.int32),
        position: wp.array(dtype=point),
        rows: wp.array2d(dtype=wp.int32),
        counts: wp.array(dtype=wp.int32),
        nearness: wp.array(dtype=real),
        slip: wp.array(dtype=vector),
        energy: wp.array(dtype=wp.float64),
    ):
        """One contact particle of a structure: its energy and its part of that of walls [J]."""
        a = offset + wp.tid()
        total = energy_of(a, p, nearness, slip)
        for n in range(counts[a]):
            b = rows[a, n]
            if body[b] == WALL:
                share = part_of(a, b, p, position, nearness)
                total += wp.float64(share) * energy_of(b, p, nearness, slip)
        energy[a] = total

    return ContactKernels(spread, list_pairs, place, sense, push, react, observe)
