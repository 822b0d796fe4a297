"""Hard cases of what must make no difference: place, scale, frame, precision, threads, repetition."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Literal

import numpy as np

from warpsph.sampling import sample
from warpsph.scene.schema import Scene
from warpsph.validation.hard import scaled_scenes
from warpsph.validation.hard.case import Figure, Machine
from warpsph.validation.hard.coupled_scenes import held_back
from warpsph.validation.hard.fluids import falling_column
from warpsph.validation.hard.random_scenes import (
    DURATION,
    SOUND_SPEED,
    Case,
    Kind,
    State,
    carried,
    end_state,
    random_case,
    rounding,
    seen_back,
    shuffled,
    turned,
    with_skin,
)
from warpsph.validation.hard.structures import swinging_beam

FAR = 1.0e4
"""Metres from the origin."""
KINDS: tuple[Kind, ...] = ("fluid", "structure", "coupled")
SEEDS = (1, 2)
OFTEN, ONCE = 0.02, 3.0
"""Skins of the neighbour lists, in support radii: they are made in almost every step, or nothing outruns the first."""


def ten_kilometres_from_the_origin(machine: Machine) -> list[Figure]:
    """Small scenes at 10 km along every axis, against the same at the origin, in single and double precision."""

    def differences(case: Case) -> dict[str, float]:
        dimension = case.scene.dimension
        still, shift = np.eye(dimension), np.full(dimension, FAR)
        found = seen_back(end_state(turned(case, still, shift), machine), still, shift)
        return rounding(found, end_state(case, machine), case, distance=FAR)

    return _by_kind(differences)


def seen_from_a_moving_frame(machine: Machine) -> list[Figure]:
    """Small scenes seen by someone who moves with a third of the sound speed."""

    def differences(case: Case) -> dict[str, float]:
        # Whoever moves sees lists renewed more often; beside thin structures that shows, see below.
        case = with_skin(case, ONCE) if case.scene.name == "coupled" else case
        velocity = np.full(case.scene.dimension, SOUND_SPEED / 3.0 / np.sqrt(case.scene.dimension))
        found = end_state(carried(case, velocity), machine)
        seen = State(found.position - DURATION * velocity, found.velocity - velocity, found.density)
        return rounding(seen, end_state(case, machine), case)

    return _by_kind(differences)


def in_another_order(machine: Machine) -> list[Figure]:
    """Small scenes with their particles in another order."""

    def differences(case: Case) -> dict[str, float]:
        other, orders = shuffled(case, seed=7)
        return rounding(end_state(other, machine, orders=orders), end_state(case, machine), case)

    return _by_kind(differences)


def lists_made_at_other_times(machine: Machine) -> list[Figure]:
    """Small scenes whose neighbour lists are made in almost every step, against those where they are made once.

    Beside a thin structure it shows: on which side of it fluid is, is settled when lists are made, and here random
    motion takes particles round its ends.
    """

    def differences(case: Case) -> dict[str, float]:
        often, once = (end_state(with_skin(case, skin), machine) for skin in (OFTEN, ONCE))
        return rounding(often, once, case)

    thin = random_case("coupled", 3, "double", (4, 3, 5), seed=16)
    fluid, structure, _ = _by_kind(differences)
    return [fluid, structure, _of_kind("coupled", [differences(thin)])]


def single_against_double_precision(machine: Machine) -> list[Figure]:
    """Small scenes in single and in double precision."""
    figures = []
    for kind in KINDS:
        found = []
        for single, double in zip(_cases(kind, "single"), _cases(kind, "double"), strict=True):
            found.append(rounding(end_state(single, machine), end_state(double, machine), single))
        figures.append(_of_kind(kind, found))
    return figures


def scale_of_a_micrometre(machine: Machine) -> list[Figure]:
    """Small scenes with all lengths in micrometres, the same material at the same speeds, against metres."""
    return _at_scale(machine, 1.0e-6)


def scale_of_ten_kilometres(machine: Machine) -> list[Figure]:
    """The same with all lengths in units of 10 km."""
    return _at_scale(machine, 1.0e4)


def one_to_four_threads(machine: Machine) -> list[Figure]:
    """Runs with two, three and four threads against one: bits that differ, of all positions and velocities.

    Twelve thousand particles of water, so that passes are long enough to be cut into chunks.
    """
    return [
        Figure(
            f"values that differ, {name}", sum(_other_bits(once, run(threads)) for threads in (2, 3, 4)), 0.0
        )
        for name, run in _runs(machine)
        for once in [run(1)]
    ]


def repeated_runs(machine: Machine) -> list[Figure]:
    """The same run three times: bits that differ."""
    return [
        Figure(f"values that differ, {name}", sum(_other_bits(once, run(None)) for _ in range(2)), 0.0)
        for name, run in _runs(machine)
        for once in [run(None)]
    ]


def _cases(kind: Kind, precision: Literal["single", "double"]) -> Iterator[Case]:
    for cells in ((6, 5), (5, 4, 4)):
        for seed in SEEDS:
            yield random_case(kind, len(cells), precision, cells, seed)


def _by_kind(differences: Callable[[Case], dict[str, float]]) -> list[Figure]:
    """The largest difference of each kind of scene, in the plane and in space, in both precisions."""
    return [
        _of_kind(kind, [differences(case) for p in ("single", "double") for case in _cases(kind, p)])
        for kind in KINDS
    ]


def _of_kind(kind: str, found: list[dict[str, float]]) -> Figure:
    largest = max(value for one in found for value in one.values())
    return Figure(f"largest difference, {kind}", largest, 1.0, "of what rounding explains")


def _at_scale(machine: Machine, length: float) -> list[Figure]:
    figures = []
    for kind in KINDS:
        found = []
        for dimension in (2, 3):
            scene, units = (
                scaled_scenes.basin(kind, dimension, "single"),
                scaled_scenes.at_scale(length, dimension),
            )
            other = scaled_scenes.basin(kind, dimension, "single", units)
            scaled = scaled_scenes.end_fields(other, machine, units)
            found.append(
                {"all": scaled_scenes.rounding(scaled, scaled_scenes.end_fields(scene, machine), scene)}
            )
        figures.append(_of_kind(kind, found))
    return figures


def _runs(machine: Machine) -> Iterator[tuple[str, Callable[[int | None], list[np.ndarray]]]]:
    """The name of a scene and what runs it with a number of threads."""
    fine = falling_column().model_copy(update={"spacing": 0.0025})
    for name, scene, end in (
        ("fluid", fine, 0.002),
        ("structure", swinging_beam(), 0.05),
        ("coupled", held_back(1000.0, 1e6, cells=3), 0.05),
    ):
        yield name, partial(_end_of, machine, scene, end)


def _end_of(machine: Machine, scene: Scene, end: float, threads: int | None) -> list[np.ndarray]:
    system = machine.system(scene, sample(scene), threads)
    system.set_target(end)
    made = 0
    while system.time < end:
        made += system.step(made).count
    sets = system.frame_sets(("velocity",), ordered=True)
    return [one.fields[name] for one in sets for name in ("position", "velocity")]


def _other_bits(one: list[np.ndarray], other: list[np.ndarray]) -> int:
    return sum(int((a != b).sum()) for a, b in zip(one, other, strict=True))


CASES = (
    ten_kilometres_from_the_origin,
    scale_of_a_micrometre,
    scale_of_ten_kilometres,
    seen_from_a_moving_frame,
    in_another_order,
    lists_made_at_other_times,
    single_against_double_precision,
    one_to_four_threads,
    repeated_runs,
)
