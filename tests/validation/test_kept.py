"""Kept runs: the same scene, complete, and no older than the tables that it was compared with."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from compared_scenes import tank_with

from warpsph.output.run_directory import RunDirectory, create_run_directory
from warpsph.scene import Scene
from warpsph.validation.kept import kept_summary


@pytest.fixture
def scene(tmp_path: Path) -> Scene:
    (tmp_path / "front.csv").write_text("t,x\n0,1\n1,2\n")
    table = {"file": "front.csv", "time": "t", "value": "x"}
    return tank_with(tmp_path, front={"type": "series", "column": "front.position[m]", "table": table})


def finished(scene: Scene, directory: Path, status: str = "complete") -> Path:
    create_run_directory(directory, scene)
    RunDirectory(directory).summary.write_text(json.dumps({"status": status, "wall_s": 3.0}))
    return directory


def test_a_complete_run_of_the_same_scene_is_kept(scene: Scene, tmp_path: Path) -> None:
    assert kept_summary(scene, finished(scene, tmp_path / "run")) == {"status": "complete", "wall_s": 3.0}


def test_an_empty_directory_holds_no_run(scene: Scene, tmp_path: Path) -> None:
    assert kept_summary(scene, tmp_path / "nothing") is None


@pytest.mark.parametrize("status", ["interrupted", "failed", "diverged: its speed"])
def test_a_run_that_broke_off_is_made_again(scene: Scene, tmp_path: Path, status: str) -> None:
    assert kept_summary(scene, finished(scene, tmp_path / "run", status)) is None


def test_another_scene_is_run(scene: Scene, tmp_path: Path) -> None:
    directory = finished(scene, tmp_path / "run")
    assert kept_summary(scene.model_copy(update={"spacing": 0.05}), directory) is None


def test_a_table_that_was_written_since_counts_as_another_scene(scene: Scene, tmp_path: Path) -> None:
    directory = finished(scene, tmp_path / "run")
    later = RunDirectory(directory).summary.stat().st_mtime + 10.0
    os.utime(tmp_path / "front.csv", (later, later))
    assert kept_summary(scene, directory) is None
