"""One lattice for all sets that have to fit together."""

import numpy as np
import pytest
from sampling.tank_scenes import box, make_scene, sphere, turned

from warpsph.sampling.scene_lattices import lattices_of

WATER = box([0.13, 0.2], [1.0, 0.5])


def test_a_tank_gives_its_corner_to_all() -> None:
    boundaries = {
        "block": {"shape": box([1.5, 0.3], [1.7, 0.5]), "side": "solid"},
        "tank": {"shape": box([0.03, 0.01], [2.0, 1.0]), "side": "outside"},
    }
    lattices = lattices_of(make_scene(0.1, {"water": WATER}, boundaries, dimension=2))
    for name in ("water", "block", "tank"):
        assert lattices[name].origin == pytest.approx([0.03, 0.01])


def test_without_a_tank_the_fluid_gives_it() -> None:
    block = {"shape": box([1.5, 0.3], [1.7, 0.5]), "side": "solid"}
    lattices = lattices_of(make_scene(0.1, {"water": WATER}, {"block": block}, dimension=2))
    assert lattices["block"].origin == pytest.approx([0.13, 0.2])


def test_a_periodic_axis_gives_its_lower_end() -> None:
    tank = {"shape": box([-0.2, 0.01], [3.2, 1.0]), "side": "outside"}
    domain = {"periodic": {"x": [0.05, 3.05]}}
    lattices = lattices_of(make_scene(0.1, {"water": WATER}, {"tank": tank}, dimension=2, domain=domain))
    assert lattices["water"].origin == pytest.approx([0.05, 0.01])


def test_turned_boxes_share_a_turned_lattice_and_discs_the_straight_one() -> None:
    tank = turned(box([0.0, 0.0], [2.0, 1.0]), 20.0)
    fluids = {"water": turned(box([0.0, 0.0], [1.0, 0.5]), 20.0), "drop": sphere([0.5, 2.5], 0.2)}
    lattices = lattices_of(make_scene(0.1, fluids, {"tank": {"shape": tank, "side": "outside"}}, dimension=2))
    assert lattices["water"] is lattices["tank"]
    assert lattices["drop"].rotation == pytest.approx(np.eye(2))
    assert lattices["drop"].origin == pytest.approx([0.3, 2.3])


def test_a_half_space_gives_its_surface() -> None:
    floor = {"type": "plane", "point": [0.0, 0.07], "normal": [0.0, 1.0]}
    bounded = {**floor, "bounds": {"min": [0.0, 0.0], "max": [1.0, 1.0]}}
    scene = make_scene(0.1, {"water": WATER}, {"lid": {"shape": bounded, "side": "outside"}}, dimension=2)
    assert lattices_of(scene)["water"].origin == pytest.approx([0.13, 0.07])
