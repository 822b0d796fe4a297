"""Faces of structures: where the fluid sees structures, and the way of its forces to them."""

from __future__ import annotations

from typing import Any

import numpy as np
import warp as wp
from warpsph_kernels.faces import make_face_kernels

from warpsph.particles.launch import Pass
from warpsph.particles.state import host_view, write_array
from warpsph.physics.assembly import Assembly, WallRange
from warpsph.physics.structure import StructureModel
from warpsph.sampling.faces import Faces
from warpsph.scene.structures import SeenVelocity

HALF_STEP, NOW = 0.5, 0.0
"""How many steps ahead of the structures faces are placed."""


class FaceModel:
    """The passes between structures and the fluid.

    Args:
        faces: of all structures together; their owners are particles of `structures`.
        mass: of each structure particle (n,) [kg].
        seen: velocity of structures that the fluid sees at the end of its step: their mean from the middle of this step
            to that of the next, that of the moment, or their mean over this step.
        side, way: vectors of each face, in the order of the faces, that this model keeps up to date: the side on which
            it is listed, and the way to its mirror point [m] (of a single entry where the wall method has none).
        force: of the fluid on each face [N], in the order of the faces.
    """

    def __init__(
        self,
        assembly: Assembly,
        walls: WallRange,
        structures: StructureModel,
        faces: Faces,
        mass: np.ndarray,
        seen: SeenVelocity,
        side: wp.array,
        way: wp.array,
        force: wp.array,
    ) -> None:
        self._assembly, self._walls, self._structures = assembly, walls, structures
        self._kernels = make_face_kernels(assembly.options, structures.options.moving_clamps)
        arithmetic, device = assembly.options.arithmetic, assembly.launcher.device

        def array(values: np.ndarray, dtype: Any, ndim: int = 1) -> wp.array:
            return wp.array(np.ascontiguousarray(values), dtype=dtype, ndim=ndim, device=device)

        self.face = array(np.arange(walls.count), wp.int32)
        self.side, self._way = side, way
        self._owner = array(faces.owner, wp.int32)
        self._side_at_rest = array(faces.side, arithmetic.vector)
        self._normal_at_rest = array(faces.normal, arithmetic.vector)
        self._way_at_rest = array(faces.way, arithmetic.vector)
        self._place_of = wp.zeros(max(walls.count, 1), dtype=wp.int32, device=device)
        self._faces_of = array(_faces_by_owner(faces.owner, structures.count), wp.int32, ndim=2)
        self._mass = array(mass, arithmetic.real)
        self._seen, self.meet_fluid = seen, True
        self.seen_velocity = wp.clone(structures.state.velocity)
        self._lead = wp.clone(structures.state.velocity)
        self._early = wp.clone(structures.state.displacement)
        self._late = wp.clone(structures.state.displacement)
        self._duration = wp.zeros(2, dtype=wp.float64, device=device)
        self._bind(force)

    @property
    def own_arrays(self) -> dict[str, wp.array]:
        """Arrays of shape (faces,) that follow the order of the faces and belong into a checkpoint."""
        return {"face": self.face, "face_side": self.side}

    @property
    def structure_arrays(self) -> dict[str, wp.array]:
        """Arrays of shape (structure particles,) that belong into a checkpoint."""
        return {
            "seen_velocity": self.seen_velocity,
            "lead_velocity": self._lead,
            "early_displacement": self._early,
            "fluid_force": self._structures.scratch.fluid_force,
        }

    def turn_sides(self) -> None:
        """Bring the sides, on which faces are listed next, to the present shape of the structures."""
        self._turn_sides.run(self._walls.count)

    def find_places(self) -> None:
        """Note where each face is after the last sort."""
        self._find_places.run(self._walls.count)

    def look_for_fluid(self) -> None:
        """Note whether the present lists hold any fluid near a face."""
        ends = host_view(self._walls.rows.ends)[: self._walls.count]
        self.meet_fluid = bool(ends.max(initial=0) > 0)

    def place(self, ahead: float) -> None:
        """Put the faces where their owners are, or will be half a step later."""
        self._place[ahead].run(self._walls.count)

    def push(self) -> None:
        """Hand the forces on the faces to the structures, for all of their coming steps."""
        self._push.run(self._structures.count)

    @property
    def looks_ahead(self) -> bool:
        """Whether what the fluid sees takes to know where structures will be."""
        return self._seen == "centred" and self.meet_fluid

    def keep_places(self) -> None:
        """Remember where the structures are before they go on."""
        if self._seen == "mean":
            wp.copy(self._early, self._structures.state.displacement)

    def show_motion(self, dt: float) -> None:
        """Let the fluid see how the structures move, or have moved in their step of `dt` [s] since `keep_places`."""
        if self._seen != "mean":
            wp.copy(self.seen_velocity, self._structures.state.velocity)
            wp.copy(self._early, self._structures.state.displacement)
        else:
            write_array(self._duration, np.array([dt, dt]))
            self._find_mean.run(self._structures.count)
        wp.copy(self._lead, self.seen_velocity)

    def show_motion_to(self, ahead: np.ndarray, lead: float, window: float) -> None:
        """Let the fluid see the mean motion around this moment.

        Args:
            ahead: displacements (n, dim) [m] after another `lead` [s].
            window: how long before that the structures were where the last call put them ahead [s].
        """
        write_array(self._late, ahead)
        write_array(self._duration, np.array([window, lead]))
        self._find_centred.run(self._structures.count)
        self._find_lead.run(self._structures.count)
        wp.copy(self._early, self._late)

    def first_faces(self, values: np.ndarray) -> np.ndarray:
        """Of values on the faces in their present order (faces, ...), those of each structure particle's first face."""
        return values[host_view(self._place_of)[host_view(self._faces_of)[:, 0]]]

    def sums(self, values: np.ndarray) -> np.ndarray:
        """Of values on the faces in their present order (faces, dim), the sums over each structure particle's faces."""
        second = host_view(self._faces_of)[:, 1]
        others = values[host_view(self._place_of)[second]]
        return self.first_faces(values) + np.where((second >= 0)[:, None], others, 0.0)

    def _bind(self, force: wp.array) -> None:
        a, s, walls, kernels = self._assembly, self._structures, self._walls, self._kernels
        bind, state, scratch = a.launcher.bind, a.state, a.scratch
        shape = (s.scratch.gradient, s.reference.clamp, s.clock, s.scratch.prescriptions)
        self._turn_sides = bind(
            "turn sides", kernels.turn_sides, self.face, self._owner, self._side_at_rest, *shape, self.side
        )
        self._find_places = bind("sort", kernels.find_places, self.face, self._place_of)
        point = a.options.arithmetic.point

        def bind_place(ahead: float) -> Pass:
            return bind(
                "place faces",
                kernels.place,
                a.clock,
                wp.float64(ahead),
                walls.first,
                a.constants.wall_volume,
                a.origin,
                point(*a.space.low),
                point(*a.space.period),
                self.face,
                self._owner,
                self._normal_at_rest,
                self._way_at_rest,
                s.reference.position,
                s.state.displacement,
                *shape,
                self._lead,
                self.seen_velocity,
                state.position,
                state.velocity_volume,
                scratch.position_pressure,
                scratch.position_density,
                walls.surface.normal,
                self._way,
            )

        self._place = {ahead: bind_place(ahead) for ahead in (NOW, HALF_STEP)}
        self._push = bind(
            "push structures",
            kernels.push,
            self._faces_of,
            self._place_of,
            force,
            self._mass,
            s.scratch.fluid_force,
            s.state.acceleration,
        )
        now, seen = s.state.displacement, self.seen_velocity

        def bind_mean(which: int, early: wp.array, late: wp.array, velocity: wp.array) -> Pass:
            return bind(
                "mean velocity", kernels.find_mean_velocity, self._duration, which, early, late, velocity
            )

        self._find_mean = bind_mean(0, self._early, now, seen)
        self._find_centred = bind_mean(0, self._early, self._late, seen)
        self._find_lead = bind_mean(1, now, self._late, self._lead)


def _faces_by_owner(owner: np.ndarray, count: int) -> np.ndarray:
    """Numbers of the first and the second face of each particle (count, 2), -1 where there is none."""
    faces = np.full((count, 2), -1)
    first, index = np.unique(owner, return_index=True)
    faces[first, 0] = index
    second = np.setdiff1d(np.arange(len(owner)), index)
    faces[owner[second], 1] = second
    return faces
