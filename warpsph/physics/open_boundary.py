"""Open boundaries: what their buffers impose on the fluid."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import warp as wp
from warpsph_kernels.exchange import make_exchange_kernels
from warpsph_kernels.open_boundary import (
    NON_REFLECTING,
    PRESSURE,
    VELOCITY,
    ZERO_GRADIENT,
    make_open_boundary_kernels,
)
from warpsph_kernels.patch import FULL, make_patch_struct

from warpsph.particles.neighbours import NeighbourSearch
from warpsph.particles.state import HostTable
from warpsph.physics.assembly import Assembly
from warpsph.physics.fluid import FluidModel
from warpsph.physics.material import smoothing_length
from warpsph.physics.patch_flux import PatchFluxModel
from warpsph.physics.residence import ResidenceModel
from warpsph.sampling.patch_laws import PatchLaw, patch_laws
from warpsph.sampling.patches import Patch, patches_of
from warpsph.sampling.walls import period_of
from warpsph.scene.open_boundaries import OpenBoundary
from warpsph.scene.schema import Scene

KINDS = {
    "velocity": VELOCITY,
    "pressure": PRESSURE,
    "zero_gradient": ZERO_GRADIENT,
    "non_reflecting": NON_REFLECTING,
}


class OpenBoundaryModel:
    """The passes of open boundaries within a step.

    tag: (places,) index of the patch in whose buffer a fluid particle is, else -1; imposed: (stations,) velocity
    [m/s] and pressure [Pa] on the patches; undisturbed: (stations,) running mean of the velocity at non-reflecting
    patches [m/s]; passing: the mass that passes them.
    """

    def __init__(self, scene: Scene, assembly: Assembly, search: NeighbourSearch, fluid: FluidModel) -> None:
        self._assembly, self._search, self._fluid = assembly, search, fluid
        self.patches: list[Patch] = patches_of(scene)
        self._laws: list[PatchLaw] = patch_laws(scene)
        self._prescribed_once = False
        self._period = period_of(scene)
        self.kernels = make_open_boundary_kernels(assembly.options)
        self.stations = sum(len(patch.stations) for patch in self.patches)
        self._spans = _spans(self.patches)
        self._allocate()
        asked = "age" in scene.output.fields
        self._residence = ResidenceModel(assembly, self.tag) if asked else None
        self.device_patches = self._make_patches(list(scene.open_boundaries.values()))
        self._place_stations(smoothing_length(scene))
        self.passing = PatchFluxModel(
            assembly, search, self.patches, self.device_patches, self._patch_of, scene.spacing
        )
        self._bind()
        if fluid.order:
            fluid.order.complete_coverage = self._cover

    @property
    def own_arrays(self) -> dict[str, wp.array]:
        """Arrays of shape (places,) that follow the order of the fluid and belong into a checkpoint."""
        ages = {"age": self._residence.age} if self._residence else {}
        return {"patch": self.tag} | ages

    @property
    def kept_arrays(self) -> dict[str, wp.array]:
        """Arrays that belong into a checkpoint and follow nothing."""
        return {
            "patch_imposed": self.imposed,
            "patch_undisturbed": self.undisturbed,
            "patch_flux": self.passing.flux,
            "patch_mass": self.passing.mass,
        }

    @property
    def passes(self) -> list[str]:
        return ["look inside", "impose", "flux"]

    def tag_start(self, position: np.ndarray, margin: float) -> None:
        """Tag the particles (n, dimension) [m] of the start that lie in buffers."""
        tags = np.full(self.tag.shape[0], -1, dtype=np.int32)
        for k, patch in reversed(list(enumerate(self.patches))):
            tags[: len(position)][patch.behind(position, margin, self._period)] = k
        wp.copy(self.tag, wp.array(tags, dtype=wp.int32, device=self.tag.device))

    def list_tagged(self) -> None:
        """Find the particles in buffers; needed again when the fluid has been sorted."""
        count = self._fluid.count
        self._flag.run(count)
        wp.utils.array_scan(self.flag[:count], self.ends[:count], inclusive=True)
        self._tagged_count = int(self.ends[count - 1 : count].numpy()[0]) if count else 0
        self._gather.run(count)

    def impose(self, end: float, middle: float) -> None:
        """Give the particles in buffers the velocity of the end of a step and the pressure of its middle [s]."""
        self.prescribe(end, middle)
        self._look.run(self.stations)
        self._average.run(len(self.patches))
        self._decide.run(self.stations)
        self._impose.run(self._tagged_count)
        self.passing.tally()

    def hold_motion(self) -> None:
        """Let particles in buffers move as is imposed on them, without forces."""
        self._hold_motion.run(self._tagged_count)

    def hold_density(self) -> None:
        """Keep the density of particles in buffers."""
        self._hold_density.run(self._tagged_count)

    def grow_older(self) -> None:
        """Let the particles in the domain grow older by a step, where the scene asks for their age."""
        if self._residence:
            self._residence.grow_older(self._fluid.count)

    def prescribe(self, end: float, middle: float) -> None:
        """Write what is prescribed at the stations, where that changes over time or has not been written."""
        stale = False
        for law, span in zip(self._laws, self._spans, strict=True):
            if law.changes or not self._prescribed_once:
                self._prescribed.values[span] = law(end if law.prescribes_velocity else middle)
                stale = True
        self._prescribed_once = True
        if stale:
            self._prescribed.send()

    def _cover(self) -> None:
        self._cover_buffers.run(self._tagged_count)

    def _allocate(self) -> None:
        a, device = self._assembly, self._assembly.launcher.device
        arithmetic, places = a.options.arithmetic, a.layout.first_image
        self.tag = wp.full(places, -1, dtype=wp.int32, device=device)
        self.flag = wp.zeros(places, dtype=wp.int32, device=device)
        self.ends = wp.zeros(places, dtype=wp.int32, device=device)
        self._tagged = wp.zeros(places, dtype=wp.int32, device=device)
        self._tagged_count = 0
        self._prescribed_array = wp.zeros(self.stations, dtype=arithmetic.record, device=device)
        self._prescribed = HostTable(self._prescribed_array)
        self._inside = wp.zeros(self.stations, dtype=arithmetic.record, device=device)
        self.imposed = wp.zeros(self.stations, dtype=arithmetic.record, device=device)
        self._slope = wp.zeros(self.stations, dtype=arithmetic.real, device=device)
        self._filling = wp.zeros(self.stations, dtype=arithmetic.real, device=device)
        self.undisturbed = wp.zeros(self.stations, dtype=arithmetic.vector, device=device)
        self._mean_pressure = wp.zeros(len(self.patches), dtype=arithmetic.real, device=device)

    def _make_patches(self, boundaries: Sequence[OpenBoundary]) -> wp.array:
        a = self._assembly
        extent = float(np.linalg.norm(a.space.high - a.space.low))
        crossing = extent / float(a.constants.sound_speed)
        structs = [
            _device_patch(a, patch, boundary, span.start, crossing)
            for patch, boundary, span in zip(self.patches, boundaries, self._spans, strict=True)
        ]
        return wp.array(structs, dtype=make_patch_struct(a.options), device=a.launcher.device)

    def _place_stations(self, depth: float) -> None:
        """Stations look inside at a `depth` [m]; those beside a disc where the nearest of it do."""
        a = self._assembly
        inside = [patch.points(patch.stations[patch.stand_ins], depth) for patch in self.patches]
        self._place = a.vectors(np.concatenate(inside) - a.space.origin)
        owners = np.concatenate([np.full(len(p.stations), k) for k, p in enumerate(self.patches)])
        self._patch_of = wp.array(owners, dtype=wp.int32, device=a.launcher.device)
        lower = [
            np.where(patch.lower >= 0, patch.lower + span.start, -1)
            for patch, span in zip(self.patches, self._spans, strict=True)
        ]
        self._lower = wp.array(np.concatenate(lower), dtype=wp.int32, device=a.launcher.device)
        pressures = np.concatenate([_hydrostatic(patch, a.constants) for patch in self.patches])
        self._hydrostatic = wp.array(pressures, dtype=a.options.arithmetic.real, device=a.launcher.device)
        weights = np.concatenate([patch.weights for patch in self.patches])
        self._weight = wp.array(weights, dtype=a.options.arithmetic.real, device=a.launcher.device)

    def _bind(self) -> None:
        a, bind, kernels = self._assembly, self._assembly.launcher.bind, self.kernels
        state, scratch, patches = a.state, a.scratch, self.device_patches
        self._look = bind(
            "look inside",
            kernels.find_inside,
            a.constants,
            self._search.grid,
            self._search.tables[0].start,
            patches,
            self._patch_of,
            self._place,
            self.tag,
            scratch.position_pressure,
            state.velocity_volume,
            self._inside,
            self._slope,
            self._filling,
        )
        self._average = bind(
            "look inside",
            kernels.average,
            patches,
            self._weight,
            self._hydrostatic,
            self._inside,
            self._mean_pressure,
        )
        self._decide = bind(
            "impose",
            kernels.decide,
            a.constants,
            a.clock,
            patches,
            self._patch_of,
            self._prescribed_array,
            self._inside,
            self._filling,
            self._lower,
            self._hydrostatic,
            self._mean_pressure,
            self.undisturbed,
            self.imposed,
        )
        self._impose = bind(
            "impose",
            kernels.impose,
            a.constants,
            patches,
            self._tagged,
            self.tag,
            self.imposed,
            self._slope,
            state.velocity_volume,
            state.density_deviation,
            scratch.position_pressure,
        )
        self._bind_holds()

    def _bind_holds(self) -> None:
        a, bind, kernels, order = (
            self._assembly,
            self._assembly.launcher.bind,
            self.kernels,
            self._fluid.order,
        )
        next_shift = order.next_shift if order else a.vectors(np.zeros((1, a.options.arithmetic.dimension)))
        state = a.state
        self._hold_motion = bind(
            "impose",
            kernels.hold_motion,
            self.device_patches,
            self._tagged,
            self.tag,
            int(bool(order)),
            state.velocity_volume,
            state.acceleration,
            next_shift,
        )
        self._hold_density = bind(
            "impose",
            kernels.hold_density,
            self._tagged,
            a.scratch.position_density,
            state.density_rate,
            state.density_deviation,
        )
        if order:
            places = (self._tagged, self.tag, a.scratch.position_pressure)
            self._cover_buffers = bind(
                "surface", kernels.cover, a.constants, self.device_patches, *places, order.coverage
            )
        of_exchange = make_exchange_kernels(a.options)
        self._flag = bind("exchange", of_exchange.flag_tagged, self.tag, self.flag)
        self._gather = bind("exchange", of_exchange.gather_flagged, self.flag, self.ends, self._tagged)


def spare_places(scene: Scene, fluids: int) -> int:
    """Places for fluid that is to come, beside the `fluids` of the start: none without open boundaries."""
    stations = sum(len(patch.stations) for patch in patches_of(scene))
    return max(4 * stations, fluids // 20) if stations else 0


def _spans(patches: Sequence[Patch]) -> list[slice]:
    """Stations of each patch among all."""
    ends = np.cumsum([len(patch.stations) for patch in patches])
    return [slice(int(end) - len(patch.stations), int(end)) for patch, end in zip(patches, ends, strict=True)]


def _hydrostatic(patch: Patch, constants: Any) -> np.ndarray:
    """Pressure (s,) [Pa] of a water level at the stations of a patch, negative above it; nought without one."""
    if not patch.has_level:
        return np.zeros(len(patch.stations))
    depth = patch.below_level(patch.points(patch.stations))
    return float(constants.rest_density) * float(np.linalg.norm(constants.gravity)) * depth


def _device_patch(
    assembly: Assembly, patch: Patch, boundary: OpenBoundary, first_station: int, crossing: float
) -> Any:
    arithmetic = assembly.options.arithmetic
    vector, dim = arithmetic.vector, arithmetic.dimension
    second = patch.axes[:, 2] if dim == 3 else np.zeros(2)
    flat = 3 - dim  # in 2D the second direction across has one station, and no extent that counts
    time = getattr(boundary, "averaging_time", "auto")
    pressure = boundary.pressure if boundary.type in ("zero_gradient", "non_reflecting") else 0.0
    struct = make_patch_struct(assembly.options)()
    struct.center = vector(*(patch.center - assembly.space.origin))
    struct.normal, struct.first = vector(*patch.axes[:, 0]), vector(*patch.axes[:, 1])
    struct.second = vector(*second)
    struct.half = wp.types.vector(2, arithmetic.real)(*patch.half, *[0.0] * flat)
    struct.length = patch.length
    struct.back = arithmetic.point(*(-patch.length * patch.axes[:, 0]))
    struct.cell = wp.types.vector(2, arithmetic.real)(*patch.cell, *[1.0] * flat)
    struct.counts = wp.types.vector(2, wp.int32)(*patch.counts, *[1] * flat)
    struct.first_station, struct.is_disc, struct.kind = (
        first_station,
        int(patch.is_disc),
        KINDS[boundary.type],
    )
    struct.pressure, struct.area = pressure, patch.area
    struct.relaxation = getattr(boundary, "relaxation", 0.0)
    struct.averaging_time = crossing if time == "auto" else time
    struct.up = vector(*patch.up)
    struct.level = patch.level if patch.has_level else FULL
    return struct
