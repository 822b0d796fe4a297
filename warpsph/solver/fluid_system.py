"""Fluids and their walls as a system that a simulation advances."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
import warp as wp

from warpsph.frame import Inflow, SetFrame
from warpsph.particles.launch import Launcher
from warpsph.particles.state import arrays_of, host_view, write_array
from warpsph.physics.assembly import WallRange
from warpsph.physics.flow_fields import FlowFields
from warpsph.physics.wall_fields import WallFields
from warpsph.sampling import SampledSet
from warpsph.sampling.buffers import inflow_warnings
from warpsph.scene.schema import Scene
from warpsph.solver.assemble import FLUID, WallParts, assemble
from warpsph.solver.describe import describe
from warpsph.solver.guards import check_state
from warpsph.solver.inflow import inflows
from warpsph.solver.ledger import Ledger, sum_up
from warpsph.solver.step import Stepper
from warpsph.solver.structure_assembly import StructureParts
from warpsph.solver.system import StepReport, in_order

ARRAYS = ("position", "velocity_volume", "density_deviation", "acceleration", "id", "set_index")
FIELDS = (
    *("position", "velocity", "acceleration", "density", "pressure", "volume", "mass", "force", "id"),
    *("vorticity", "free_surface", "viscous_force", "wall_shear_stress"),
)
OF_FLUIDS = ("density", "mass", "vorticity", "free_surface", "age", "patch")
OF_WALLS = ("force", "viscous_force", "wall_shear_stress")
USUAL_FIELDS = ("position", "velocity", "density", "pressure", "mass")
NOTABLE_MACH = 0.2
"""Speed over sound speed from which compressibility shows (density errors of four per cent)."""
NOTABLE_COMPRESSION = 0.05
GROWTH = 1.5
"""Ratio of the places for fluid particles when there are too few."""


class FluidSystem:
    """Fluids and walls of a scene. Raises SceneError if they cannot be assembled."""

    def __init__(
        self,
        scene: Scene,
        sampled: Sequence[SampledSet],
        launcher: Launcher,
        structures: StructureParts | None = None,
    ) -> None:
        """`structures` act on the fluid; what advances them is elsewhere."""
        self._scene = scene
        self._sampled = sampled
        self._shown = [s for s in sampled if s.kind != "structure"]
        self._launcher, self._structures = launcher, structures
        self._builds_before = 0
        self.growths = 0
        self._assemble()

    def _assemble(self, places: int | None = None) -> None:
        """Make the parts of the start, with a number of places for fluid particles if that is given."""
        self.parts = assemble(self._scene, self._sampled, self._launcher, self._structures, places)
        self._flow_fields = FlowFields(self.parts.assembly, self.parts.search.rows[FLUID])
        walls = self.parts.walls
        self._wall_fields = self.wall_fields(walls.model.walls) if walls else None
        self.stepper = Stepper(self._scene, self.parts)
        self.stepper.start()

    @property
    def time(self) -> float:
        return self.stepper.time

    @property
    def particle_count(self) -> int:
        return self._alive + self.parts.assembly.layout.walls

    @property
    def removed_count(self) -> int:
        """Particles that have left the kill box, and not through open boundaries."""
        opened = self.parts.open_boundaries
        return self.stepper.removed - (opened.exchange.removed if opened else 0)

    @property
    def list_builds(self) -> int:
        return self._builds_before + self.parts.search.builds

    @property
    def sound_speed(self) -> float:
        """The artificial sound speed [m/s]."""
        return float(self.parts.assembly.constants.sound_speed)

    @property
    def sets(self) -> tuple[tuple[str, str, int], ...]:
        index = self._living_sets()
        return tuple((s.name, s.kind, int(np.sum(index == k))) for k, s in enumerate(self._shown))

    @property
    def extremes(self) -> Mapping[str, float]:
        """Largest speed [m/s] and |rho/rho0 - 1|."""
        return {"speed": self.stepper.speed, "compression": self.stepper.compression}

    @property
    def fields(self) -> frozenset[str]:
        return frozenset({*FIELDS, *self._open_fields})

    @property
    def arrays(self) -> Mapping[str, wp.array]:
        state = self.parts.assembly.state
        return {name: getattr(state, name) for name in ARRAYS}

    @property
    def is_short_of_places(self) -> bool:
        """Whether the fluid that may enter at open boundaries within a step may find no place."""
        opened = self.parts.open_boundaries
        return opened is not None and opened.exchange.is_short_of_places

    def grow(self) -> None:
        """Go on from the same state with more places for fluid; all arrays and parts are new ones."""
        target = self.stepper.target
        saved = self.save()
        saved["growths"] = self.growths + 1
        self._rebuild(math.ceil(GROWTH * self.parts.assembly.layout.first_image))
        self._restore(saved)
        self.stepper.set_clock(TARGET=target)

    def _rebuild(self, places: int) -> None:
        builds = self.list_builds
        self._assemble(places)
        self._builds_before = builds - self.parts.search.builds

    def step(self, step_count: int) -> StepReport:
        if self.is_short_of_places:
            self.grow()
        report = self.stepper.step()
        self.check(step_count, report)
        return report

    def check(self, step_count: int, report: StepReport) -> None:
        """Raise SimulationDiverged if the state that a step began with is out of range."""
        check_state(self.stepper, self.parts, self._sampled, step_count, report)

    def set_target(self, time: float) -> None:
        self.stepper.set_clock(TARGET=time)

    def frame_sets(self, fields: Sequence[str] | None, ordered: bool) -> tuple[SetFrame, ...]:
        """Fields: position, velocity, pressure, volume; of fluids also density, mass, vorticity, free_surface; of walls
        also force, viscous_force, wall_shear_stress."""
        self.stepper.synchronise()
        columns = self._columns({"position", *(USUAL_FIELDS if fields is None else fields)})
        index = self._living_sets()
        return tuple(
            self._set_frame(k, sampled, columns, index, ordered) for k, sampled in enumerate(self._shown)
        )

    def wall_fields(self, walls: WallRange) -> WallFields:
        """The fields of a range of wall particles."""
        return WallFields(self.parts.assembly, walls, self.parts.fluid.react)

    def ledger(self) -> Ledger:
        """Totals over all fluids."""
        sets = self.frame_sets(("velocity", "mass"), ordered=False)
        fluids = tuple(particles for particles in sets if particles.kind == "fluid")
        return sum_up(self.time, fluids, np.asarray(self._scene.gravity))

    def warnings(self, largest: Mapping[str, float]) -> list[str]:
        warnings = inflow_warnings(self._scene)
        mach = largest["speed"] / self.sound_speed
        if mach > NOTABLE_MACH:
            warnings.append(
                f"the largest speed was {mach:.2f} of the sound speed; above {NOTABLE_MACH:g} compressibility "
                f"shows: raise numerics.sound_speed above {10.0 * largest['speed']:.3g} m/s"
            )
        if largest["compression"] > NOTABLE_COMPRESSION:
            warnings.append(
                f"the density was off by up to {largest['compression']:.1%}; raise numerics.sound_speed or "
                "lower time.cfl if that is not the impact of a splash"
            )
        if self.removed_count:
            warnings.append(f"{self.removed_count} particles left the kill box and were removed")
        return warnings

    def inflows(self) -> dict[str, Inflow]:
        """What has passed the open boundaries, by name."""
        return inflows(self.parts)

    def describe(self) -> dict[str, Any]:
        return describe(self._scene, self.parts, self.sets) | {"growths": self.growths}

    def save(self) -> dict[str, Any]:
        opened = self.parts.open_boundaries
        return {name: np.array(host_view(array)) for name, array in self._evolving_arrays()} | {
            "clock": np.array(host_view(self.parts.assembly.clock)),
            "time": self.time,
            "alive": self._alive,
            "removed": self.stepper.removed,
            "places": self.parts.assembly.layout.first_image,
            "growths": self.growths,
            **(opened.exchange.save() if opened else {}),
        }

    def load(self, saved: Mapping[str, Any]) -> None:
        places = int(saved["places"])
        if places != self.parts.assembly.layout.first_image:
            self._rebuild(places)
        self._restore(saved)

    def _restore(self, saved: Mapping[str, Any]) -> None:
        """Go on from a saved state, whose fluid may have had fewer places."""
        layout = self.parts.assembly.layout
        more = layout.first_image - int(saved["places"])
        for name, array in self._evolving_arrays():
            values = np.asarray(saved[name])
            write_array(array, values[: len(array)])
            if more and len(array) == layout.total:
                write_array(array[layout.fluids :], values[len(values) - layout.solids :])
        self.parts.search.tables[FLUID].count = int(saved["alive"])
        self.growths = int(saved["growths"])
        self.stepper.removed = int(saved["removed"])
        if self.parts.open_boundaries:
            self.parts.open_boundaries.exchange.load(saved)
        self.stepper.resume(np.asarray(saved["clock"]))

    def _living_sets(self) -> np.ndarray:
        """Set of every particle, -1 at places that no living particle has."""
        index = np.array(self._host("set_index"))
        index[self._alive : self.parts.assembly.layout.fluids] = -1
        return index

    @property
    def _alive(self) -> int:
        return self.parts.search.tables[FLUID].count

    def _host(self, name: str) -> np.ndarray:
        return host_view(getattr(self.parts.assembly.state, name))

    def _evolving_arrays(self) -> Iterator[tuple[str, wp.array]]:
        yield from arrays_of(self.parts.assembly.state)
        # Behind the last particle are entries that are none.
        yield "listed_position", self.parts.search.listed_position[: self.parts.assembly.layout.total]
        yield from self.parts.fluid.own_arrays.items()
        if self.parts.open_boundaries:
            yield from self.parts.open_boundaries.model.own_arrays.items()
            yield from self.parts.open_boundaries.model.kept_arrays.items()
        if self.parts.walls:
            yield from self.parts.walls.model.own_arrays.items()
            yield from self.parts.walls.motion.own_arrays.items()
        if self.parts.faces:
            yield from self.parts.faces.model.own_arrays.items()
            yield from self.parts.faces.faces.own_arrays.items()
            yield from self.parts.faces.faces.structure_arrays.items()

    def _columns(self, names: set[str]) -> dict[str, np.ndarray]:
        a = self.parts.assembly
        velocity_volume, pressure = self._host("velocity_volume"), host_view(a.scratch.position_pressure)
        makers: dict[str, Callable[[], np.ndarray]] = {
            "position": lambda: self._host("position"),
            "velocity": lambda: velocity_volume[:, :-1],
            "acceleration": lambda: self._host("acceleration"),
            "density": lambda: a.constants.rest_density + self._host("density_deviation").astype(np.float64),
            "pressure": lambda: pressure[:, -1],
            "volume": lambda: velocity_volume[:, -1],
            "mass": lambda: np.full(a.layout.total, a.constants.mass),
            "force": lambda: self._of_walls(lambda walls, _: host_view(walls.model.react())),
            "viscous_force": lambda: self._of_walls(lambda _, fields: fields.viscous_force()),
            "wall_shear_stress": lambda: self._of_walls(lambda _, fields: fields.shear_stress()),
            "vorticity": self._flow_fields.vorticity,
            "free_surface": self._flow_fields.free_surface,
        }
        makers |= self._open_fields
        unknown = sorted(names - {"id", *makers})
        if unknown:
            raise KeyError(f"no field {unknown[0]!r}; there are {', '.join(makers)}, id")
        return {name: makers[name]() for name in names - {"id"}} | {"id": self._host("id")}

    @property
    def _open_fields(self) -> dict[str, Callable[[], np.ndarray]]:
        """What makes the fields that fluid has between open boundaries, with zeros for walls."""
        opened, layout = self.parts.open_boundaries, self.parts.assembly.layout

        def padded(array: wp.array) -> np.ndarray:
            return np.pad(host_view(array), (0, layout.total - len(array)))

        arrays = opened.model.own_arrays if opened else {}
        return {name: partial(padded, array) for name, array in arrays.items()}

    def _of_walls(self, find: Callable[[WallParts, WallFields], np.ndarray]) -> np.ndarray:
        """Vectors that walls have, with zeros for all other particles."""
        layout = self.parts.assembly.layout
        vectors = np.zeros((layout.total, self._scene.dimension))
        if self.parts.walls and self._wall_fields:
            vectors[layout.fluids : layout.first_face] = find(self.parts.walls, self._wall_fields)
        return vectors

    def _set_frame(
        self, k: int, sampled: SampledSet, columns: Mapping[str, np.ndarray], index: np.ndarray, ordered: bool
    ) -> SetFrame:
        own = {name: values for name, values in columns.items() if self._has(sampled.kind, name)}
        return SetFrame(sampled.name, sampled.kind, in_order(own, ordered, np.flatnonzero(index == k)))

    @staticmethod
    def _has(kind: str, field: str) -> bool:
        return field not in (OF_WALLS if kind == "fluid" else OF_FLUIDS)
