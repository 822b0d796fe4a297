"""Hard cases of fluids."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from warpsph.sampling import sample
from warpsph.scene import load_scene
from warpsph.scene.schema import Scene
from warpsph.solver.simulation import Simulation
from warpsph.solver.system import System
from warpsph.validation.hard.case import Figure, Machine
from warpsph.validation.hard.measures import largest_extremes, leaked, mechanical_energy, rows, water_of
from warpsph.validation.hard.shapes import GRAVITY, box, tank

DENSITY = 1000.0


def falling_column(dimension: int = 2, **numerics: Any) -> Scene:
    """A column of water, 0.4 m high, that falls in a closed tank and hits a step with a sharp corner."""
    across, dp = (0.2,) * (dimension - 2), 0.02 if dimension == 2 else 0.025
    zero = (0.0,) * len(across)
    walls = {
        "tank": {"shape": box((0.0, *zero, 0.0), (0.8, *across, 0.8)), "side": "outside"},
        "step": {"shape": box((0.6, *zero, 0.0), (0.7, *across, 0.1)), "side": "solid"},
    }
    return Scene(
        name="falling_column",
        dimension=dimension,
        spacing=dp,
        gravity=(*zero, 0.0, -GRAVITY),
        time={"end": 1.2, "frame_rate": 20.0},
        numerics=numerics,
        fluids={"water": {"shape": box((0.0, *zero, 0.0), (0.2, *across, 0.4)), "density": DENSITY}},
        boundaries=walls,
    )


def set_free(scene: Scene) -> float:
    """Energy [J] that the falling column sets free as it spreads over the floor beside the step."""
    area, depth = 0.2 * 0.4, 0.2 if scene.dimension == 3 else 1.0
    return DENSITY * area * depth * GRAVITY * 0.5 * (0.4 - area / 0.7)


def splash_over_a_corner(machine: Machine) -> list[Figure]:
    """A falling column meets the corner of a step and flies to pieces in empty space, up to the lid and back.

    Energy is that of motion and height, over what the column sets free as it spreads over the floor.
    """
    return _splash(machine, falling_column())


def splash_over_a_corner_in_space(machine: Machine) -> list[Figure]:
    """The same in three dimensions, eight particles across."""
    return _splash(machine, falling_column(3))


def _splash(machine: Machine, scene: Scene) -> list[Figure]:
    simulation = machine.simulate(scene)
    first, outside, gained = mechanical_energy(simulation), 0, 0.0
    for time in np.linspace(0.05, 1.2, 24):
        simulation.advance(float(time))
        outside = max(outside, leaked(simulation))
        gained = max(gained, (mechanical_energy(simulation) - first) / set_free(scene))
    return [Figure("particles outside", outside, 0.0), Figure("energy gained", gained, 0.01)]


TALL, NARROW, ACROSS = 10.0, 0.1, 4
"""Height and width [m] of the tall column, and particles across it."""


def column_a_hundred_times_as_tall_as_wide(machine: Machine) -> list[Figure]:
    """Four particles across, 400 above each other: pressure at the foot after a way of many particles.

    The particles settle, and the column rings with the period 4 H/c, of 2000 steps; the mean over one of them counts.
    In weakly compressible water the pressure at the foot is small, g H = c^2 / 200: a speed of a four thousandth of the
    sound speed makes a sound of 5 % of it, and that is what is left of the settling. The kinetic energy is in parts of
    what the column could set free by falling over, m g H / 2.
    """
    scene = Scene(
        name="tall_column",
        dimension=2,
        spacing=NARROW / ACROSS,
        gravity=(0.0, -GRAVITY),
        time={"end": 1.0, "frame_rate": 1.0},
        fluids={"water": {"shape": box((0.0, 0.0), (NARROW, TALL)), "density": DENSITY}},
        boundaries={"tank": tank(NARROW, TALL + NARROW, lid=False)},
    )
    simulation = machine.simulate(scene)
    period = 4.0 * TALL / simulation.sound_speed
    gradients, energies, outside = [], [], 0
    for time in period * np.linspace(0.75, 1.75, 9)[1:]:
        simulation.advance(float(time))
        height, pressure = rows(simulation, "water")[:, 1], rows(simulation, "water", "pressure")
        gradients.append(-np.polyfit(height, pressure, 1)[0] / (DENSITY * GRAVITY))
        energies.append(simulation.ledger().kinetic_energy)
        outside += leaked(simulation)
    fall = DENSITY * NARROW * TALL * GRAVITY * TALL / 2.0
    return [
        Figure("error of the pressure's slope", abs(float(np.mean(gradients)) - 1.0), 0.05),
        Figure("kinetic energy", max(energies) / fall, 1e-4),
        Figure("particles outside", outside, 0.0),
    ]


def fluid_under_tension(machine: Machine) -> list[Figure]:
    """Fluid that fills a periodic square under a negative pressure of a twentieth of rho c^2, a little out of order.

    The scheme's own defaults, without anything that keeps particles in order: it tears into clumps and holes.
    """
    return _tension(machine, {"type": "none"})


def fluid_under_tension_with_transport_velocity(machine: Machine) -> list[Figure]:
    """The same with `particle_order: {type: transport_velocity}`, which is for fluid without a surface."""
    return _tension(machine, {"type": "transport_velocity"})


def fluid_under_tension_with_shifting(machine: Machine) -> list[Figure]:
    """The same with `particle_order: {type: shifting, coefficient: 10}`: shifting is for free surfaces, and its default
    of 4 is too slow for so much tension."""
    return _tension(machine, {"type": "shifting", "coefficient": 10.0})


def _tension(machine: Machine, order: dict[str, Any]) -> list[Figure]:
    """Where pairs attract each other more the closer they are, noise grows (Swegle, Hicks & Attaway 1995)."""
    dp, side, speed = 0.05, 1.0, 10.0
    pull = -0.05 * DENSITY * speed**2
    scene = Scene(
        name="tension",
        dimension=2,
        spacing=dp,
        domain={"periodic": {"x": (0.0, side), "y": (0.0, side)}},
        time={"end": 2.0, "frame_rate": 1.0},
        numerics={"sound_speed": speed, "particle_order": order},
        fluids={
            "water": {
                "shape": box((0.0, 0.0), (side, side)),
                "density": DENSITY,
                "pressure": {"type": "uniform", "value": pull},
            }
        },
    )
    system = disordered(machine, scene, 0.02)
    positions = [_positions(system)]
    positions.extend(_positions(system) for _ in _advance(system, np.linspace(0.2, 2.0, 10)))
    nearest = min(float(_nearest(place, side).min()) for place in positions) / dp
    return [Figure("closest pair", nearest, 0.5, "dp", at_least=True)]


def _nearest(place: np.ndarray, period: float) -> np.ndarray:
    wrapped = np.mod(place, period)
    return cKDTree(wrapped, boxsize=period).query(wrapped, k=2)[0][:, 1]


def disordered(machine: Machine, scene: Scene, part: float) -> System:
    """A scene whose fluids start with every coordinate off its lattice by up to a part of the spacing."""
    rng = np.random.default_rng(5)
    sets = tuple(
        replace(one, position=one.position + rng.uniform(-part, part, one.position.shape) * scene.spacing)
        if one.kind == "fluid"
        else one
        for one in sample(scene)
    )
    return machine.system(scene, sets)


def _advance(system: System, times: np.ndarray) -> Iterator[None]:
    """Advance from time to time [s] and yield at each."""
    made = 0
    for time in times:
        system.set_target(float(time))
        while system.time < time:
            made += system.step(made).count
        yield


def _positions(system: System) -> np.ndarray:
    (water,) = (one for one in system.frame_sets((), ordered=True) if one.kind == "fluid")
    return np.asarray(water.fields["position"])


def still_water(depth: float = 0.2, dp: float = 0.02, **numerics: Any) -> Scene:
    """Water as wide as it is deep [m], at rest in an open tank."""
    water = {"shape": box((0.0, 0.0), (depth, depth)), "density": DENSITY}
    return Scene(
        name="still_water",
        dimension=2,
        spacing=dp,
        gravity=(0.0, -GRAVITY),
        time={"end": 1.0, "frame_rate": 10.0},
        numerics=numerics,
        fluids={"water": {**water, "pressure": {"type": "hydrostatic"}}},
        boundaries={"tank": tank(depth, 1.5 * depth, lid=False)},
    )


def disorder_at_the_start(machine: Machine) -> list[Figure]:
    """Still water whose particles start off their lattice by up to three tenths of a spacing along each axis.

    Without anything that keeps particles in order."""
    return _settled(machine, still_water(0.4))


def disorder_at_the_start_with_shifting(machine: Machine) -> list[Figure]:
    """The same with `particle_order: {type: shifting}`."""
    return _settled(machine, still_water(0.4, particle_order={"type": "shifting"}))


def _settled(machine: Machine, scene: Scene) -> list[Figure]:
    """How still disordered water becomes.

    It has to come to rest, with the water where it was. The kinetic energy is that at the end, after fifteen times
    sqrt(H/g), in parts of the potential one; the level is twice the mean height, in parts of the depth.
    """
    system = disordered(machine, scene, 0.3)
    for _ in _advance(system, np.array([3.0])):
        pass
    ledger, place = system.ledger(), _positions(system)
    level = 2.0 * place[:, 1].mean() / 0.4
    return [
        Figure("kinetic energy left", ledger.kinetic_energy / ledger.potential_energy, 1e-4),
        Figure("change of the level", abs(level - 1.0), 0.02),
        Figure("particles below the floor", int((place[:, 1] < 0.0).sum()), 0.0),
    ]


def still_water_for_twenty_times_as_long(machine: Machine) -> list[Figure]:
    """The shipped tank of still water at a coarse spacing for 100 s: it neither moves, warms, rises nor leaks."""
    scene = load_scene("hydrostatic_tank_2d", ["spacing=0.04"])
    end = 20.0 * scene.time.end
    simulation = machine.simulate(scene)
    energies, levels, outside = [], [], 0
    for time in np.linspace(0.05 * end, end, 20):
        simulation.advance(float(time))
        ledger = simulation.ledger()
        energies.append(ledger.kinetic_energy / ledger.potential_energy)
        levels.append(water_of(simulation)[:, 1].mean())
        outside = max(outside, leaked(simulation) + simulation.removed_count)
    return [
        Figure("kinetic energy, last fifth", max(energies[-4:]), 1e-4),
        Figure("drift of the level", abs(levels[-1] / levels[0] - 1.0), 0.005),
        Figure("particles outside", outside, 0.0),
    ]


def rotating_square_patch(machine: Machine) -> list[Figure]:
    """The shipped scene at a coarse spacing: held together by negative pressure while its corners are flung out."""
    scene = load_scene("rotating_patch", ["spacing=0.025"])
    simulation = machine.simulate(scene)
    first = simulation.ledger()
    simulation.advance(1.0)
    last, place = simulation.ledger(), rows(simulation, "water")
    spin = last.angular_momentum[0] / first.angular_momentum[0]
    corner = np.linalg.norm(place, axis=1).max() + 0.5 * np.sqrt(2.0) * scene.spacing
    return [
        Figure("error of the corner's distance", abs(float(corner) - 1.0), 0.03),
        Figure("loss of angular momentum", abs(spin - 1.0), 0.01),
        Figure("energy gained", last.kinetic_energy / first.kinetic_energy - 1.0, 0.01),
    ]


def sound_speed_too_low(machine: Machine) -> list[Figure]:
    """A falling column with a sound speed below twice its largest speed: the run has to say so."""
    simulation: Simulation = machine.simulate(falling_column(sound_speed=4.0))
    largest = largest_extremes(simulation, [0.5])
    told = [text for text in simulation.system.warnings(largest) if "raise numerics.sound_speed" in text]
    return [Figure("warnings", len(told), 1.0, at_least=True)]


CASES = (
    splash_over_a_corner,
    splash_over_a_corner_in_space,
    column_a_hundred_times_as_tall_as_wide,
    fluid_under_tension,
    fluid_under_tension_with_shifting,
    fluid_under_tension_with_transport_velocity,
    rotating_square_patch,
    disorder_at_the_start,
    disorder_at_the_start_with_shifting,
    still_water_for_twenty_times_as_long,
    sound_speed_too_low,
)
