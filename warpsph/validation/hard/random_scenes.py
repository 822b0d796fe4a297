"""Random small scenes, and the transformations under which a run must give the same."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from warpsph.sampling import SampledSet, sample
from warpsph.scene.schema import Scene
from warpsph.validation.hard.case import Machine
from warpsph.validation.hard.shapes import box

Kind = Literal["fluid", "structure", "coupled"]

SPACING, DENSITY, SOUND_SPEED = 0.05, 1000.0, 20.0
"""Particle spacing [m], density [kg/m^d] of fluids and structures, and speed [m/s] of sound in both."""
SMOOTHING_LENGTH = 1.5 * SPACING
MAX_STEP = 0.25 * SMOOTHING_LENGTH / SOUND_SPEED
"""Time step [s]: below every limit that depends on the state, whose largest speed a moving frame changes."""
STEPS = 20
DURATION = STEPS * MAX_STEP / 1.051
"""Time of a run [s]. Fluids beside structures round their steps down to a grade of 5 %, and so that equal ones land on
the end: with these numbers there are just so many, whatever the grade."""
LAYERS = 4
"""Particles through plates of structure and through walls."""


@dataclass(frozen=True)
class Case:
    """A scene with the particles that it starts from, which need not be those that it would be filled with."""

    scene: Scene
    sets: tuple[SampledSet, ...]


@dataclass(frozen=True)
class State:
    """All moving particles at one time: position [m] and velocity [m/s] (n, dim), density of fluids (m,) [kg/m^dim]."""

    position: np.ndarray
    velocity: np.ndarray
    density: np.ndarray


def random_case(
    kind: Kind, dimension: int, precision: str, cells: tuple[int, ...], seed: int, scattered: bool = False
) -> Case:
    """Water over a wall, an elastic block, or water between a wall and an elastic plate, all of it in random motion.

    Args:
        cells: particles along each axis of the water, or of the block.
        seed: of places, velocities, pressures and gravity.
        scattered: whether the particles of structures are off their lattice, too.
    """
    scene = _scene(kind, dimension, precision, cells)
    rng = np.random.default_rng(seed)
    gravity = rng.uniform(-10.0, 10.0, dimension)
    spread = rng.uniform(-0.05, 0.05, (dimension, dimension)) * SOUND_SPEED / (max(cells) * SPACING)
    sets = tuple(_stirred(one, rng, spread, scattered) for one in sample(scene))
    return Case(with_gravity(scene, gravity), sets)


def _scene(kind: Kind, dimension: int, precision: str, cells: tuple[int, ...]) -> Scene:
    size = SPACING * np.asarray(cells, dtype=float)
    thick, low, across = LAYERS * SPACING, np.zeros(dimension), np.append(size[:-1], 0.0)
    up = np.append(np.zeros(dimension - 1), 1.0)
    water = {"water": {"shape": box(low, size), "density": DENSITY}}
    wall = {"wall": {"shape": box(-thick * up, across), "side": "solid"}}
    body = box(low, size) if kind == "structure" else box(size * up, size + thick * up)
    elastic = {"density": DENSITY, "youngs_modulus": DENSITY * SOUND_SPEED**2, "poisson_ratio": 0.0}
    return Scene(
        name=kind,
        dimension=dimension,
        spacing=SPACING,
        time={"end": 1.0, "frame_rate": 1.0, "max_step": MAX_STEP},
        numerics={"precision": precision, "sound_speed": SOUND_SPEED},
        fluids={} if kind == "structure" else water,
        boundaries={} if kind == "structure" else wall,
        structures={} if kind == "fluid" else {"body": {"shape": body, "material": elastic}},
    )


def _stirred(one: SampledSet, rng: np.random.Generator, spread: np.ndarray, scattered: bool) -> SampledSet:
    """A set with its particles off their places, in a linear flow with noise upon it; walls stay as they are."""
    if one.kind == "boundary":
        return one
    position = one.position
    if one.kind == "fluid" or scattered:
        position = position + rng.uniform(-0.15, 0.15, position.shape) * SPACING
    noise = rng.uniform(-0.02, 0.02, position.shape) * SOUND_SPEED
    velocity = (position - position.mean(axis=0)) @ spread.T + noise
    pressure = rng.uniform(0.0, 0.02, len(position)) * DENSITY * SOUND_SPEED**2 * (one.kind == "fluid")
    return replace(one, position=position, velocity=velocity, pressure=pressure)


def with_gravity(scene: Scene, gravity: np.ndarray) -> Scene:
    """The scene under another gravity [m/s2]."""
    return scene.model_copy(update={"gravity": tuple(gravity.tolist())})


def with_skin(case: Case, skin: float) -> Case:
    """The same with another skin of the neighbour lists, in support radii."""
    numerics = case.scene.numerics.model_copy(update={"skin": skin})
    return replace(case, scene=case.scene.model_copy(update={"numerics": numerics}))


def turned(case: Case, matrix: np.ndarray, shift: np.ndarray | float = 0.0) -> Case:
    """The same in axes that an orthogonal matrix (dim, dim) turns or mirrors, and at another place [m]."""
    sets = tuple(
        replace(one, position=one.position @ matrix.T + shift, velocity=one.velocity @ matrix.T)
        for one in case.sets
    )
    return Case(with_gravity(case.scene, matrix @ np.asarray(case.scene.gravity)), sets)


def carried(case: Case, velocity: np.ndarray) -> Case:
    """The same seen by someone who moves with -velocity [m/s]; walls, too, move."""
    motion = [{"type": "linear", "velocity": tuple(velocity.tolist())}]
    written = case.scene.model_dump(exclude_unset=True)
    for boundary in written["boundaries"].values():
        boundary["motion"] = motion
    sets = tuple(replace(one, velocity=one.velocity + velocity) for one in case.sets)
    return Case(Scene(**written), sets)


def shuffled(case: Case, seed: int) -> tuple[Case, list[np.ndarray]]:
    """The same with the particles of each set in another order, and for each set the old numbers in that order."""
    rng = np.random.default_rng(seed)
    orders = [rng.permutation(len(one.position)) for one in case.sets]
    return Case(case.scene, tuple(map(_picked, case.sets, orders))), orders


def _picked(one: SampledSet, order: np.ndarray) -> SampledSet:
    own = {name: getattr(one, name)[order] for name in ("position", "velocity", "pressure")}
    return replace(one, **own)


def end_state(
    case: Case, machine: Machine, *, threads: int = 1, orders: list[np.ndarray] | None = None
) -> State:
    """The state at the end of a run; particles of sets that are in other `orders` in their first one."""
    system = machine.system(case.scene, case.sets, threads)
    system.set_target(DURATION)
    made = 0
    while system.time < DURATION:
        made += system.step(made).count
    assert made >= STEPS
    fields = ["position", "velocity", *(["density"] if case.scene.fluids else [])]
    frames = {one.name: one for one in system.frame_sets(fields, ordered=True)}
    order_of = {one.name: order for one, order in zip(case.sets, orders or [], strict=False)}

    def column(field: str, *kinds: str) -> np.ndarray:
        rows = [np.empty((0, case.scene.dimension) if field != "density" else 0)]
        for one in frames.values():
            if one.kind in kinds:
                values = np.asarray(one.fields[field], dtype=np.float64)
                rows.append(values[np.argsort(order_of.get(one.name, np.arange(len(values))))])
        return np.concatenate(rows)

    moving = ("fluid", "structure")
    return State(column("position", *moving), column("velocity", *moving), column("density", "fluid"))


def rounding(found: State, expected: State, case: Case, distance: float = 0.0) -> dict[str, float]:
    """By how much two states of a case differ at most, by field, in units of what rounding explains.

    In one of them the scene was at a `distance` [m] from the origin. The separation of two particles is known to a part
    `eps` of the size L of the scene, hence the slope of the kernel to eps L / h. A step changes a velocity by up to the
    sound speed c times the Courant number (a quarter), so that it differs by less than eps c L / h a step, the density
    by as much times rho / c, and a position by what the velocity makes of that in the time of the run. Places are
    stored in double precision, those at a distance to so much less.
    """
    eps = {"single": float(np.finfo(np.float32).eps), "double": float(np.finfo(np.float64).eps)}
    places = np.concatenate([one.position for one in case.sets])
    extent = float(np.ptp(places, axis=0).max())
    resolution = eps[case.scene.numerics.precision] * extent + eps["double"] * distance
    speed = STEPS * resolution / SMOOTHING_LENGTH * SOUND_SPEED
    units = {"velocity": speed, "density": speed * DENSITY / SOUND_SPEED, "position": speed * DURATION}
    return {
        name: float(np.abs(getattr(found, name) - getattr(expected, name)).max(initial=0.0) / unit)
        for name, unit in units.items()
    }


def seen_back(state: State, matrix: np.ndarray, shift: np.ndarray | float = 0.0) -> State:
    """A state seen from the axes and the place that `turned` has left."""
    return State((state.position - shift) @ matrix, state.velocity @ matrix, state.density)
