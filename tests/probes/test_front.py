"""The front is the face of the fluid; what has torn off does not move it."""

import math

import numpy as np
import pytest
from particles import DENSITY, SPACING, SetFrame, fluid, frame_of, lattice, probe_of, scene_with

from warpsph.probes.bodies import connected_bodies


def front_of(position, axis="x", **spec):
    probe = probe_of(scene_with({"type": "front", "axis": axis, **spec}, position.shape[1]))
    assert probe.columns == ("probe.position[m]",)
    return probe.evaluate(frame_of(fluid(position)))[0]


@pytest.mark.parametrize(("axis", "face"), [("x", 1.0), ("y", 2.0), ("z", 0.5)])
def test_front_of_a_block_is_its_face(axis, face):
    assert front_of(lattice([0.0, 0.0, 0.0], [1.0, 2.0, 0.5]), axis) == pytest.approx(face)


def test_spray_ahead_of_the_block_does_not_count():
    block = lattice([0.0, 0.0], [1.0, 1.0])
    drop = np.array([[1.5, 0.0], [1.55, 0.05], [1e9, 0.0]])
    assert front_of(np.concatenate([block, drop])) == pytest.approx(1.0)


def test_a_stretched_tongue_of_single_particles_belongs_to_the_block():
    block = lattice([0.0, 0.0], [1.0, 1.0])
    tongue = np.array([[0.95 + 1.5 * SPACING * i, 0.05] for i in range(1, 7)])
    assert front_of(np.concatenate([block, tongue])) == pytest.approx(tongue[-1, 0] + 0.5 * SPACING)


def test_both_halves_of_a_parted_wave_count():
    halves = [lattice([x, 0.0], [x + 1.0, 0.5]) for x in (0.0, 3.0)]
    assert front_of(np.concatenate(halves)) == pytest.approx(4.0)


def test_one_fluid_of_several_can_be_chosen():
    box = {"type": "box", "min": [0.0, 0.0], "max": [1.0, 1.0]}
    oil_box = {"type": "box", "min": [2.0, 0.0], "max": [3.0, 1.0]}
    fluids = {
        "water": {"shape": box, "density": DENSITY},
        "oil": {"shape": oil_box, "density": DENSITY},
    }
    frame = frame_of(
        fluid(lattice([0.0, 0.0], [1.0, 1.0])),
        SetFrame("oil", "fluid", {"position": lattice([2.0, 0.0], [3.0, 1.0])}),
    )
    for chosen, face in (("water", 1.0), ("oil", 3.0), (None, 3.0)):
        scene = scene_with({"type": "front", "axis": "x", "fluid": chosen}, fluids=fluids)
        assert probe_of(scene).evaluate(frame)[0] == pytest.approx(face)


def test_no_fluid_has_no_front():
    assert math.isnan(front_of(np.empty((0, 2))))


@pytest.mark.parametrize("dimension", [2, 3])
def test_bodies_are_those_of_brute_force_where_the_rule_is_sharp(dimension):
    """Random clusters: closer than the distance is one body, farther than two diagonals is not."""
    random = np.random.default_rng(3)
    centres = random.uniform(-5.0, 5.0, (12, dimension))
    position = np.concatenate([c + random.uniform(-0.05, 0.05, (20, dimension)) for c in centres])
    body, sizes = connected_bodies(position, 0.2, (None,) * dimension)
    separation = np.linalg.norm(position[:, None] - position[None], axis=2)
    same = body[:, None] == body[None]
    assert np.all(same[separation < 0.2])
    linked = separation < 2 * 0.2 * math.sqrt(dimension)
    for _ in range(5):  # transitive closure of at most 12 clusters
        linked = (linked.astype(int) @ linked.astype(int)) > 0
    assert not np.any(same & ~linked)
    assert sizes.sum() == len(position)


def test_a_body_across_a_periodic_boundary_is_one():
    position = np.array([[0.01, 0.5], [0.99, 0.5], [0.5, 0.5]])
    body, _ = connected_bodies(position, 0.1, (1.0, None))
    assert body[0] == body[1] != body[2]
