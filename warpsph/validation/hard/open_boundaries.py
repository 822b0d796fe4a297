"""Hard cases of open boundaries: flow that comes back, patches across the lattice, vortices that leave, long runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from warpsph.frame import Inflow
from warpsph.scene.schema import Scene
from warpsph.solver.simulation import Simulation
from warpsph.validation.hard.case import Figure, Machine
from warpsph.validation.hard.measures import rows
from warpsph.validation.hard.shapes import box

DENSITY, HEIGHT, DP = 1000.0, 1.0, 0.1
"""Density [kg/m3], height of the channels [m] and spacing [m]."""
LAYER = DENSITY * HEIGHT * DP
"""Mass of a layer of particles across a channel [kg/m]."""
AROUND = 1.6
"""How far walls go on behind patches, and how thick they are [m]."""


def channel(
    length: float,
    inlet: dict[str, Any],
    outlet: dict[str, Any],
    *,
    angle: float = 0.0,
    viscosity: float | None = None,
    spacing: float = DP,
    obstacle: dict[str, Any] | None = None,
    start: tuple[float, float] = (1.0, 0.0),
) -> Scene:
    """A plane channel along x from the origin, turned about it by `angle` [deg].

    Its fluid begins with a velocity `start` [m/s] along it; in a turned channel it is relaxed, and only the buffers
    stand on a turned lattice. With a viscosity [m2/s] the walls hold the flow, else they let it slip.
    """
    turn = np.deg2rad(angle)
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])

    def turned(*points: tuple[float, float]) -> list[tuple[float, ...]]:
        return [tuple(map(float, rotation @ point)) for point in points]

    def polygon(low: tuple[float, float], high: tuple[float, float]) -> dict[str, Any]:
        if angle == 0.0:
            return box(low, high)
        corners = turned(low, (high[0], low[1]), high, (low[0], high[1]))
        return {"type": "polygon", "points": tuple(corners)}

    def patch(x: float, into: float) -> dict[str, Any]:
        (center,), (normal,) = turned((x, 0.5 * HEIGHT)), turned((into, 0.0))
        return {"center": center, "normal": normal, "width": HEIGHT}

    plates = tuple(polygon((-AROUND, low), (length + AROUND, low + AROUND)) for low in (-AROUND, HEIGHT))
    boundaries: dict[str, Any] = {"plates": {"shape": {"type": "union", "shapes": plates}, "side": "solid"}}
    if obstacle is not None:
        boundaries["obstacle"] = {"shape": obstacle, "side": "solid"}
    for wall in boundaries.values():
        wall["slip"] = "free_slip" if viscosity is None else "no_slip"
        wall["placement"] = "relaxed" if angle else "lattice"
    water = polygon((0.0, 0.0), (length, HEIGHT))
    if obstacle is not None:
        water = {"type": "difference", "base": water, "subtract": (obstacle,)}
    (velocity,) = turned(start)
    friction = {"type": "artificial"} if viscosity is None else {"type": "laminar"}
    return Scene(
        name="channel",
        dimension=2,
        spacing=spacing,
        time={"end": 1000.0, "frame_rate": 1.0},
        numerics={
            "sound_speed": 20.0,
            "viscosity": friction,
            "particle_order": {"type": "transport_velocity"},
            "wall": {"type": "extrapolated", "suction": True},
        },
        fluids={
            "water": {
                "shape": water,
                "density": DENSITY,
                "velocity": velocity,
                "pressure": {"type": "uniform", "value": outlet.get("pressure", 0.0)},
                "placement": "relaxed" if angle else "lattice",
                **({} if viscosity is None else {"kinematic_viscosity": viscosity}),
            }
        },
        boundaries=boundaries,
        open_boundaries={
            "inlet": {"type": "velocity", "shape": patch(0.0, 1.0), **inlet},
            "outlet": {"type": "pressure", "shape": patch(length, -1.0), "pressure": 0.0, **outlet},
        },
    )


def inside(simulation: Simulation) -> int:
    """Count the particles between the patches."""
    return int((rows(simulation, "water", "patch") < 0).sum())


def passed(simulation: Simulation) -> dict[str, Inflow]:
    """What has passed the patches of a run, by name."""
    return dict(simulation.frame(()).inflows)


def flow_comes_back_through_an_outlet(machine: Machine) -> list[Figure]:
    """The flow in a channel, u = 0.5 + 0.7 cos(pi t), comes back through the outlet for a quarter of each period.

    The velocity is the same all over the channel; its error is in parts of the largest, 1.2 m/s. Fluid that is pushed
    takes the time of sound through the channel to follow, L / c = 0.1 s, in which the velocity changes by up to
    0.7 pi L / c / 2 = 0.11 m/s in the mean of the channel. Particles are counted after each of three periods.
    """
    pressure = 8000.0  # above what the deceleration of 2 m of fluid at 2.2 m/s2 takes away
    pulse = {"velocity": {"type": "uniform", "speed": 1.0}, "history": "0.5 + 0.7*cos(pi*t)"}
    simulation = machine.simulate(channel(2.0, pulse, {"pressure": pressure}, start=(1.2, 0.0)))
    first, gained, off = inside(simulation), 0, 0.0
    for time in np.arange(0.25, 6.01, 0.25):
        simulation.advance(float(time))
        domain = rows(simulation, "water", "patch") < 0
        velocity = rows(simulation, "water", "velocity")[domain]
        off = max(off, float(np.abs(velocity.mean(axis=0) - [0.5 + 0.7 * np.cos(np.pi * time), 0.0]).max()))
        if time % 2.0 == 0.0:
            gained = max(gained, abs(inside(simulation) - first))
    outlet = passed(simulation)["outlet"]
    # Buffers bring in particles of the spacing of rest at any pressure, and so the mass of fluid at rest.
    expected = -DENSITY * 0.5 * 6.0 * HEIGHT
    return [
        Figure("error of the mean velocity", off / 1.2, 0.09),
        Figure("particles gained, in layers", gained * DP / HEIGHT, 1.0),
        Figure("particles that came back, in layers", outlet.entered * DP / HEIGHT, 1.0, at_least=True),
        Figure("error of the flux at the outlet", abs(outlet.mass / expected - 1.0), 0.01),
    ]


def patches_at_30_degrees(machine: Machine) -> list[Figure]:
    """A channel at Re = 10 that lies at 30 degrees to the axes, to the lattice of its fluid, and so its patches.

    After three flow-throughs there is the parabola of Poiseuille along it; with 10 particles across, walls by
    extrapolation are off by about (dp / H)^2 = 1 % of the peak, which the relaxed particles' disorder doubles.
    """
    mean = {"velocity": {"type": "parabolic", "mean": 1.0}}
    turn = np.deg2rad(30.0)
    simulation = machine.simulate(channel(2.0, mean, {}, angle=30.0, viscosity=0.1))
    simulation.advance(4.0)
    before, first = inside(simulation), passed(simulation)
    errors = []
    for time in np.linspace(4.5, 6.0, 4):
        simulation.advance(float(time))
        position, velocity = rows(simulation, "water"), rows(simulation, "water", "velocity")
        along, across = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
        x, y = position @ along, position @ across
        between = (x > 0.0) & (x < 2.0)
        exact = 6.0 * np.outer(y * (HEIGHT - y), along)
        errors.append(np.square(velocity - exact)[between].sum(axis=1).mean())
    last = passed(simulation)
    net = sum(last[name].mass - first[name].mass for name in last)
    return [
        Figure("error of the parabola", float(np.sqrt(np.mean(errors))) / 1.5, 0.02),
        Figure("flux that does not leave", abs(net) / (DENSITY * HEIGHT * 2.0), 0.01),
        Figure("particles gained, in layers", abs(inside(simulation) - before) * DP / HEIGHT, 1.0),
    ]


def vortex_at_an_outlet(machine: Machine) -> list[Figure]:
    """Behind a step that takes half of a channel the flow of Re = 100 separates, and the outlet, a step's height behind
    it, cuts the eddy: fluid leaves in one half of the patch and enters in the other.

    In the gap the mean is 2 m/s. Behind the step, where the flow widens, nothing is faster than the parabola between
    plates with that mean, 3 m/s, to a tenth for ten particles across. What enters leaves.
    """
    mean = {"velocity": {"type": "parabolic", "mean": 1.0}, "ramp": 0.5}
    step = box((0.5, 0.0), (1.5, 0.5 * HEIGHT))
    scene = channel(2.0, mean, {}, viscosity=0.01, spacing=0.05, obstacle=step, start=(0.0, 0.0))
    simulation = machine.simulate(scene)
    simulation.advance(4.0)
    first, before, fastest = passed(simulation), inside(simulation), 0.0
    for time in np.linspace(4.0, 10.0, 13)[1:]:
        simulation.advance(float(time))
        behind = rows(simulation, "water")[:, 0] > 1.5
        velocity = rows(simulation, "water", "velocity")[behind]
        fastest = max(fastest, float(np.linalg.norm(velocity, axis=1).max()))
    last = passed(simulation)
    brought = DENSITY * HEIGHT * 6.0
    net = sum(last[name].mass - first[name].mass for name in last)
    layer = HEIGHT / scene.spacing
    returned = last["outlet"].entered - first["outlet"].entered
    return [
        Figure("fastest particle behind the step over the peak of the parabola", fastest / 3.0, 1.1),
        Figure("flux that does not leave", abs(net) / brought, 0.01),
        Figure("particles gained, in layers", abs(inside(simulation) - before) / layer, 1.0),
        Figure("particles that came back, in layers", returned / layer, 1.0, at_least=True),
    ]


def channel_for_a_hundred_flow_throughs(machine: Machine) -> list[Figure]:
    """A short channel at Re = 10, for a hundred times that its fluid takes to pass: its particles neither grow more nor
    fewer, and its flow does not change.

    Counted at the ends of ten parts of the run, the first of which the flow takes to settle.
    """
    mean = {"velocity": {"type": "parabolic", "mean": 1.0}}
    simulation = machine.simulate(channel(1.0, mean, {}, viscosity=0.1))
    numbers, errors = [], []
    for time in np.linspace(10.0, 100.0, 10):
        simulation.advance(float(time))
        position, velocity = rows(simulation, "water"), rows(simulation, "water", "velocity")
        domain = rows(simulation, "water", "patch") < 0
        exact = 6.0 * position[domain, 1] * (HEIGHT - position[domain, 1])
        numbers.append(inside(simulation))
        errors.append(float(np.sqrt(np.square(velocity[domain, 0] - exact).mean())) / 1.5)
    return [
        Figure("particles gained, in layers", float(np.ptp(numbers)) * DP / HEIGHT, 1.0),
        Figure("slope of the number, in layers over the run", _trend(numbers) * DP / HEIGHT, 0.5),
        Figure("error of the parabola", max(errors), 0.02),
    ]


def _trend(numbers: Sequence[int]) -> float:
    """Change of the straight line through the numbers from the first to the last."""
    return float(abs(np.polyfit(np.linspace(0.0, 1.0, len(numbers)), numbers, 1)[0]))


CASES = (
    flow_comes_back_through_an_outlet,
    patches_at_30_degrees,
    vortex_at_an_outlet,
    channel_for_a_hundred_flow_throughs,
)
