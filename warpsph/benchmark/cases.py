"""What is measured: shipped scenes at chosen numbers of particles, whose fluid moves from the first step on.

A column that starts at rest keeps its neighbour lists for hundreds of steps. Here it starts as a vortex, tangential to
the walls and about as fast as the flow becomes later, so that lists are made as often as in the run's busy part.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from warpsph.scene.loader import load_scene
from warpsph.scene.schema import Scene

Interval = tuple[float, float]


@dataclass(frozen=True)
class BenchmarkCase:
    """A shipped scene with the number of moving particles that it is to have, and how its fluid starts."""

    name: str
    scene: str
    particles: int
    content: float
    """Volume of all fluids and structures [m^dim]."""
    velocity: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def load(self, extra: Sequence[str] = ()) -> Scene:
        """The scene at that size, with further overrides. Raises SceneError."""
        return load_scene(self.scene, [*self.overrides, *extra])

    @property
    def dimension(self) -> int:
        return 3 if self.name.endswith("3d") else 2

    @property
    def overrides(self) -> tuple[str, ...]:
        """What differs from the shipped scene, as `key=value`: with these `warpsph run` runs it."""
        spacing = (self.content / self.particles) ** (1.0 / self.dimension)
        starts = (f"fluids.{name}.velocity=[{', '.join(v)}]" for name, v in self.velocity.items())
        return (f"spacing={spacing:.5g}", *starts)


def vortex(speed: float, x: Interval, height: float) -> tuple[str, str]:
    """Velocity along x and upwards [m/s] of a vortex that fills a column over an interval of x [m]."""
    width = x[1] - x[0]
    across, upward = f"pi * (x - {x[0]:g}) / {width:g}", f"pi * UP / {height:g}"
    return (
        f'"{speed:g} * sin({across}) * cos({upward})"',
        f'"{-speed * height / width:g} * cos({across}) * sin({upward})"',
    )


def _fluid_3d(particles: int) -> BenchmarkCase:
    along, up = (part.replace("UP", "z") for part in vortex(3.3, (0.0, 1.2), 0.55))
    return BenchmarkCase("fluid_3d", "dam_break_3d", particles, 0.66, {"water": (along, "0", up)})


def _fluid_2d(particles: int) -> BenchmarkCase:
    columns = {"square": vortex(4.4, (0.0, 1.0), 1.0), "tall": vortex(4.4, (8.0, 9.0), 2.0)}
    return BenchmarkCase("fluid_2d", "dam_break_2d", particles, 3.0, _in_plane(columns))


def _coupled_2d(particles: int) -> BenchmarkCase:
    columns = {"water": vortex(2.4, (0.0, 0.146), 0.292)}
    return BenchmarkCase("coupled_2d", "dam_break_elastic_obstacle", particles, 0.0437, _in_plane(columns))


def _in_plane(columns: Mapping[str, tuple[str, str]]) -> dict[str, tuple[str, ...]]:
    return {name: tuple(part.replace("UP", "y") for part in parts) for name, parts in columns.items()}


def _structure_3d(particles: int) -> BenchmarkCase:
    return BenchmarkCase("structure_3d", "twisting_column", particles, 6.5)


QUICK = (_fluid_3d(10_000), _fluid_2d(5_000), _structure_3d(3_000), _coupled_2d(5_000))
"""A minute in all."""
FULL = (
    *(_fluid_3d(particles) for particles in (10_000, 100_000, 1_000_000)),
    *(_fluid_2d(particles) for particles in (5_000, 50_000)),
    _structure_3d(25_000),
    _coupled_2d(20_000),
)
LARGE = tuple(_fluid_3d(particles) for particles in (10_000_000, 30_000_000, 100_000_000))
"""What only a GPU measures, as far as its memory goes."""
