"""Scenes over resolutions: which cases run, and what stands in the rows."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from compared_scenes import TANK

from warpsph.comparison.compare import compare_run
from warpsph.scene import Scene, SceneError, load_scene, shipped_scenes
from warpsph.solver.errors import SimulationDiverged
from warpsph.validation.runner import cases_of, run_case

REFERENCES = {
    "front": {
        "type": "series",
        "column": "front.position[m]",
        "table": {"time": [0.1], "value": [1.0]},
        "source": "rest",
        "bound": 0.05,
    },
    "energy": {"type": "limit", "column": "energy.kinetic[J/m]", "high": 1.0, "source": "rest"},
}
VALIDATION = "validation: {resolutions: [0.1, 0.2, 0.05], quick: [0.2], set: {time.end: 1.0}}\n"


@pytest.fixture
def scene_file(tmp_path: Path) -> str:
    path = tmp_path / "tank.yaml"
    path.write_text(TANK % json.dumps(REFERENCES) + VALIDATION)
    return str(path)


def spacings(scene_file: str, **options: Any) -> list[float]:
    defaults: dict[str, Any] = {"quick": False, "resolutions": None, "overrides": ()}
    return [case.scene.spacing for case in cases_of(scene_file, **{**defaults, **options})]


def finished_run(scene: Scene, directory: Path) -> Mapping[str, Any]:
    """A run at rest: the front stays where it was."""
    times = np.array([0.0, scene.time.end])
    history = {"time[s]": times, "front.position[m]": np.ones(2), "energy.kinetic[J/m]": np.zeros(2)}
    return {
        "wall_s": 2.0,
        "steps": {"count": 10},
        "particles": 300,
        "particle_steps_per_second": 1500.0,
        "device": "cpu",
        "threads": 2,
        "references": [row.as_record() for row in compare_run(scene, history)],
    }


def diverging_run(scene: Scene, directory: Path) -> Mapping[str, Any]:
    raise SimulationDiverged(
        set="water",
        particle=7,
        position=(0.0, 0.0),
        time=0.5,
        step=9,
        limit="its speed",
        value=1e9,
        advice="Rest.",
    )


def test_resolutions_of_the_scene_run_coarse_first(scene_file: str) -> None:
    assert spacings(scene_file) == [0.2, 0.1, 0.05]


def test_quick_and_asked_resolutions(scene_file: str) -> None:
    assert spacings(scene_file, quick=True) == [0.2]
    assert spacings(scene_file, quick=True, resolutions=(0.05, 0.1)) == [0.1, 0.05]


def test_scene_without_validation_runs_as_it_stands(tmp_path: Path) -> None:
    path = tmp_path / "tank.yaml"
    path.write_text(TANK % json.dumps(REFERENCES))
    assert spacings(str(path)) == [0.1]


def test_overrides_of_the_command_beat_those_of_the_scene(scene_file: str) -> None:
    (case,) = cases_of(scene_file, quick=True, resolutions=None, overrides=())
    assert (case.scene.time.end, case.scene.output.usd) == (1.0, False)
    overrides = ["time.end=0.5", "output.usd=true"]
    (case,) = cases_of(scene_file, quick=True, resolutions=None, overrides=overrides)
    assert (case.scene.time.end, case.scene.output.usd) == (0.5, True)


QUICK = (
    "validation: {resolutions: [0.1], set: {time.end: 1.0}, quick_set: {time.end: 0.05, output.usd: true}}\n"
)


def test_quick_runs_are_shortened_and_say_which_references_they_skip(tmp_path: Path) -> None:
    path = tmp_path / "tank.yaml"
    path.write_text(TANK % json.dumps(REFERENCES) + QUICK)
    (case,) = cases_of(str(path), quick=True, resolutions=None, overrides=())
    assert (case.scene.time.end, case.scene.output.usd) == (0.05, True)
    assert (list(case.scene.references), case.skipped) == (["energy"], {"front": 0.1})
    result = run_case(case, tmp_path, finished_run)
    energy, front = result.rows
    assert (energy["quantity"], energy["holds"]) == ("energy", True)
    assert (front["quantity"], front["holds"], front["value"]) == ("front", None, None)
    assert "skipped: it looks at the run until t = 0.1 s, and this one ends at 0.05 s" in front["note"]
    assert result.holds
    (case,) = cases_of(str(path), quick=False, resolutions=None, overrides=())
    assert (case.scene.time.end, case.skipped) == (1.0, {})
    overrides = ["time.end=0.5"]
    (case,) = cases_of(str(path), quick=True, resolutions=None, overrides=overrides)
    assert (case.scene.time.end, case.skipped) == (0.5, {})


@pytest.mark.parametrize("name", shipped_scenes())
def test_quick_sets_of_shipped_scenes_load_and_name_what_they_skip(name: str) -> None:
    scene = load_scene(name)
    if not scene.references:
        return
    for case in cases_of(name, quick=True, resolutions=None, overrides=()):
        assert {*case.scene.references, *case.skipped} == set(scene.references)
        assert not case.skipped or case.scene.time.end < scene.time.end


def test_scene_without_references_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "tank.yaml"
    path.write_text(TANK % "{}")
    with pytest.raises(SceneError, match="nothing to compare with"):
        cases_of(str(path), quick=False, resolutions=None, overrides=())


def test_rows_carry_every_agreed_key(scene_file: str, tmp_path: Path) -> None:
    (case,) = cases_of(scene_file, quick=True, resolutions=None, overrides=())
    result = run_case(case, tmp_path, finished_run)
    assert result.holds
    agreed = {
        "scene",
        "resolution",
        "quantity",
        "value",
        "reference",
        "error",
        "bound",
        "holds",
        "wall_seconds",
    }
    agreed |= {"steps", "particles", "particle_steps_per_second", "device", "threads"}
    assert all(agreed <= row.keys() for row in result.rows)
    assert [row["quantity"] for row in result.rows] == ["front", "energy"]


def test_no_row_of_a_diverged_run_holds(scene_file: str, tmp_path: Path) -> None:
    (case,) = cases_of(scene_file, quick=True, resolutions=None, overrides=())
    result = run_case(case, tmp_path, diverging_run)
    assert not result.holds
    assert [row["holds"] for row in result.rows] == [False, False]
    assert result.failure is not None
    assert "particle 7 of water" in result.failure


def test_diverged_run_fails_even_where_no_reference_has_a_bound(scene_file: str, tmp_path: Path) -> None:
    overrides = ["references.front.bound=null"]
    (case,) = cases_of(scene_file, quick=True, resolutions=None, overrides=overrides)
    result = run_case(case, tmp_path, diverging_run)
    assert result.rows[0]["holds"] is None
    assert not result.holds
