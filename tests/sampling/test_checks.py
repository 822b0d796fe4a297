"""Scenes whose shapes do not fit together are refused with place and reason."""

from typing import Any

import pytest
from sampling.tank_scenes import box, make_scene, sphere, without

from warpsph.sampling import sample
from warpsph.scene.errors import Problem, SceneError

TANK = {"shape": box([0.0, 0.0], [2.0, 1.0]), "side": "outside"}
WATER = box([0.0, 0.0], [1.0, 0.5])


def problems_of(fluids: dict[str, Any], boundaries: dict[str, Any], **more: Any) -> tuple[Problem, ...]:
    scene = make_scene(more.pop("spacing", 0.1), fluids, boundaries, dimension=2, **more)
    with pytest.raises(SceneError) as refused:
        sample(scene)
    return refused.value.problems


def test_fluid_inside_a_wall() -> None:
    """An obstacle that was not cut out of the fluid: every cell within its layers is in the way."""
    (problem,) = problems_of(
        {"water": WATER}, {"tank": TANK, "post": {"shape": box([0.5, 0.0], [0.7, 0.8]), "side": "solid"}}
    )
    assert problem.key == "fluids.water.shape"
    assert problem.message == "10 of its 50 particles lie inside the wall 'post', such as (0.55, 0.05)"
    assert "difference" in problem.allowed


def test_fluid_that_sticks_out_of_a_round_tank() -> None:
    tank = {"shape": sphere([0.0, 0.0], 0.5), "side": "outside"}
    (problem,) = problems_of({"water": box([-0.5, -0.5], [0.5, 0.0])}, {"tank": tank})
    assert problem.key == "fluids.water.shape"
    assert "inside the wall 'tank'" in problem.message


def test_fluid_cut_to_the_obstacle_is_accepted() -> None:
    disc = sphere([1.0, 0.3], 0.25)
    boundaries = {"tank": TANK, "disc": {"shape": disc, "side": "inside"}}
    sample(make_scene(0.1, {"water": without(box([0.0, 0.0], [2.0, 0.8]), disc)}, boundaries, dimension=2))


def test_fluid_that_stands_above_an_open_tank_is_in_no_wall() -> None:
    tank = {**TANK, "open": ["y_max"]}
    sample(make_scene(0.1, {"water": box([0.5, 0.0], [2.0, 1.6])}, {"tank": tank}, dimension=2))


def test_overlapping_fluids() -> None:
    (problem,) = problems_of({"water": WATER, "oil": box([0.8, 0.2], [1.5, 0.5])}, {"tank": TANK})
    assert problem.key == "fluids.oil.shape"
    assert problem.message == "6 of its particles lie in fluids.water, such as (0.85, 0.25)"


def test_all_conflicts_are_told_at_once() -> None:
    posts = {
        f"post_{k}": {"shape": box([x, 0.0], [x + 0.2, 0.8]), "side": "solid"}
        for k, x in enumerate([0.2, 0.7])
    }
    assert len(problems_of({"water": WATER}, {"tank": TANK, **posts})) == 2


def test_a_shape_between_the_cells_is_empty() -> None:
    sliver = {"type": "polygon", "points": [[0.5, 0.55], [0.7, 0.75], [0.69, 0.76]]}
    (problem,) = problems_of({"water": sliver}, {"tank": TANK})
    assert problem.key == "fluids.water.shape"
    assert "no particle" in problem.message


def test_a_plane_without_end_is_no_wall() -> None:
    floor = {"type": "plane", "point": [0.0, 0.0], "normal": [0.0, 1.0]}
    (problem,) = problems_of({"water": WATER}, {"floor": {"shape": floor, "side": "inside"}})
    assert problem.key == "boundaries.floor.shape"
    assert "bounds" in problem.allowed


def test_a_combined_shape_without_end_is_no_wall() -> None:
    floor = {"type": "plane", "point": [0.0, 0.0], "normal": [0.0, 1.0]}
    union = {"type": "union", "shapes": [floor, sphere([0.5, 0.0], 0.3)]}
    (problem,) = problems_of(
        {"water": box([0.0, 1.0], [1.0, 2.0])}, {"floor": {"shape": union, "side": "inside"}}
    )
    assert problem.key == "boundaries.floor.shape"


def test_a_period_must_be_a_whole_number_of_spacings() -> None:
    (problem,) = problems_of({"water": WATER}, {}, spacing=0.07, domain={"periodic": {"x": [0.0, 1.0]}})
    assert problem.key == "spacing"
    assert problem.value == 0.07
    assert problem.allowed.endswith("such as 0.066666667 or 0.071428571 m")


@pytest.mark.parametrize("ends", [(0.0, 1.5), (0.1, 1.5), (-1.0, 1.0)])
def test_a_tank_that_ends_at_a_periodic_face_would_leak(ends: tuple[float, float]) -> None:
    tank = {"shape": box([ends[0], 0.0], [ends[1], 1.0]), "side": "outside"}
    water = box([0.5, 0.0], [1.0, 0.5])
    (problem,) = problems_of({"water": water}, {"tank": tank}, domain={"periodic": {"x": [0.0, 2.0]}})
    assert problem.key == "boundaries.tank.shape"
    assert "periodic face in x" in problem.message


@pytest.mark.parametrize("ends", [(0.0, 2.0), (-1.0, 3.0), (0.3, 1.7)])
def test_a_tank_across_the_period_or_within_it_is_accepted(ends: tuple[float, float]) -> None:
    tank = {"shape": box([ends[0], 0.0], [ends[1], 1.0]), "side": "outside"}
    water = box([0.5, 0.0], [1.0, 0.5])
    sample(
        make_scene(0.1, {"water": water}, {"tank": tank}, dimension=2, domain={"periodic": {"x": [0.0, 2.0]}})
    )


def test_a_wall_that_needs_more_memory_than_there_is() -> None:
    huge = {"shape": box([0.0, 0.0], [1e4, 1e4]), "side": "outside"}
    (problem,) = problems_of({"water": WATER}, {"tank": huge})
    assert problem.key == "boundaries.tank.shape"
    assert "1e+10 cells" in problem.message
