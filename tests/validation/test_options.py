"""Values of scene options that run side by side."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from compared_scenes import TANK

from warpsph.scene import SceneError
from warpsph.validation.options import (
    ComparedOption,
    combinations,
    compared_options,
    options_in_words,
    split_values,
    without_effect,
)
from warpsph.validation.runner import Case, cases_of

REFERENCES = {
    "energy": {"type": "limit", "column": "energy.kinetic[J/m]", "high": 1.0, "source": "rest"},
}


@pytest.fixture
def scene_file(tmp_path: Path) -> str:
    path = tmp_path / "tank.yaml"
    path.write_text(TANK % json.dumps(REFERENCES))
    return str(path)


def cases(scene_file: str, *compared: str) -> tuple[Case, ...]:
    options = compared_options(compared)
    return cases_of(scene_file, quick=False, resolutions=(0.2, 0.1), overrides=(), compared=options)


def test_commas_within_brackets_and_quotes_part_nothing() -> None:
    text = "{type: laminar}, {type: artificial, alpha: 0.1},[0, 1],'a,b',plain"
    expected = ["{type: laminar}", "{type: artificial, alpha: 0.1}", "[0, 1]", "'a,b'", "plain"]
    assert list(split_values(text)) == expected


def test_every_combination_runs() -> None:
    options = (ComparedOption("a", ("1", "2")), ComparedOption("b", ("x", "y")))
    assert combinations(options) == (("a=1", "b=x"), ("a=1", "b=y"), ("a=2", "b=x"), ("a=2", "b=y"))
    assert combinations(()) == ((),)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("numerics.kernel", "at least two"),
        ("numerics.kernel=wendland_c2", "at least two"),
        ("numerics.kernel=wendland_c2,", "at least two"),
        ("numerics.kernel=wendland_c2,wendland_c2", "different"),
        ("=1,2", "a key"),
        ("spacing=0.1,0.2", "--resolutions"),
    ],
)
def test_what_compares_nothing_is_refused(text: str, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        compared_options([text])


def test_a_key_is_compared_once() -> None:
    with pytest.raises(ValueError, match="twice"):
        compared_options(["time.cfl=0.1,0.2", "time.cfl=0.3,0.4"])


def test_cases_take_the_values_and_run_in_directories_of_their_own(scene_file: str) -> None:
    found = cases(scene_file, "numerics.kernel=wendland_c2,cubic_spline")
    assert [(case.scene.numerics.kernel, case.scene.spacing) for case in found] == [
        ("wendland_c2", 0.2),
        ("wendland_c2", 0.1),
        ("cubic_spline", 0.2),
        ("cubic_spline", 0.1),
    ]
    assert len({case.directory for case in found}) == 4
    assert found[-1].directory == Path("tank/numerics.kernel=cubic_spline/0.1")


def test_names_of_directories_hold_no_separator(scene_file: str) -> None:
    found = cases(scene_file, "description=a/b,..")
    assert {case.directory.parts[1] for case in found} == {"description=a%2Fb", "description=.."}


def test_every_bad_value_is_told_once_with_its_option(scene_file: str) -> None:
    with pytest.raises(SceneError) as caught:
        cases(scene_file, "numerics.kernel=wendland_c2,cone,box", "numerics.nothing=1,2")
    told = {(problem.file, problem.key) for problem in caught.value.problems}
    assert told == {
        ("--compare numerics.kernel=cone", "numerics.kernel"),
        ("--compare numerics.kernel=box", "numerics.kernel"),
        ("--compare numerics.nothing=1", "numerics.nothing"),
        ("--compare numerics.nothing=2", "numerics.nothing"),
    }
    assert len(caught.value.problems) == 4


def test_options_are_called_by_the_end_of_their_keys_where_that_is_enough() -> None:
    assert options_in_words({"numerics.kernel": "a", "time.cfl": "0.1"}) == "kernel=a, cfl=0.1"
    same = {"fluids.oil.density": "1", "fluids.water.density": "2"}
    assert options_in_words(same) == "fluids.oil.density=1, fluids.water.density=2"
    assert options_in_words(None) == ""


def test_an_option_without_effect_is_found_beside_one_that_has_some() -> None:
    rows = [
        {"resolution": h, "quantity": "front", "value": h * float(a), "options": {"a": a, "b": b}}
        for h in (0.2, 0.1)
        for a in ("1", "2")
        for b in ("x", "y")
    ]
    assert without_effect(rows) == ("b",)
    assert without_effect([{"resolution": 0.1, "quantity": "front", "value": 1.0}]) == ()


@pytest.mark.parametrize("values", [(1.0,), (None, None), (1.0, None)])
def test_missing_figures_do_not_show_that_an_option_has_no_effect(values: tuple[float | None, ...]) -> None:
    rows = [
        {"resolution": 0.1, "quantity": "front", "value": value, "options": {"a": str(k)}}
        for k, value in enumerate(values)
    ]
    assert without_effect(rows) == ()
