"""Shapes from files in scenes: where files are looked for, what is refused, and how scenes are written back."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import mesh_builders as build
import numpy as np
import pytest
import trimesh
from pydantic import TypeAdapter

from warpsph.scene import load_scene, scene_from_yaml
from warpsph.scene.bounds import bounding_box, dimension_of
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.shapes import Shape

SHAPE: TypeAdapter[Any] = TypeAdapter(Shape)
TEXT = """\
name: test
dimension: {dimension}
spacing: 0.0002
time: {{end: 1.0, frame_rate: 10}}
fluids:
  water:
    density: 1000
    shape:
      {shape}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A directory with a box of 1 x 2 x 3 and a square of 2 x 1, in files."""
    trimesh.Trimesh(*build.box((0.0,) * 3, (1.0, 2.0, 3.0))).export(tmp_path / "box.stl")
    (tmp_path / "square.csv").write_text("x,y\n0,0\n2,0\n2,1\n0,1\n")
    return tmp_path


def scene_file(folder: Path, shape: str, dimension: int = 3) -> Path:
    path = folder / "scene.yaml"
    path.write_text(TEXT.format(dimension=dimension, shape=shape))
    return path


def problem_of(path: Path) -> Problem:
    with pytest.raises(SceneError) as refused:
        load_scene(path)
    (problem,) = refused.value.problems
    return problem


@pytest.mark.parametrize(("unit", "metres"), [("mm", 1e-3), ("in", 0.0254), (0.5, 0.5), ("auto", 1.0)])
def test_files_lie_beside_the_scene_and_have_a_unit(
    folder: Path, monkeypatch: pytest.MonkeyPatch, unit: str | float, metres: float
) -> None:
    monkeypatch.chdir("/")
    text = TEXT.format(dimension=3, shape=f"{{type: mesh, file: box.stl, unit: {unit}}}")
    shape = scene_from_yaml(text, folder, [f"spacing={0.1 * metres}"]).fluids["water"].shape
    assert bounding_box(shape)[1] == pytest.approx(np.array([1.0, 2.0, 3.0]) * metres)
    assert dimension_of(shape) == 3


def test_outline_of_a_file(folder: Path) -> None:
    scene = load_scene(scene_file(folder, "{type: polygon, file: square.csv, unit: mm}", dimension=2))
    assert bounding_box(scene.fluids["water"].shape)[1] == pytest.approx([2e-3, 1e-3])


def test_sections_of_extrusions(folder: Path) -> None:
    section = "{type: polygon, file: square.csv, unit: mm}"
    path = scene_file(folder, f"{{type: extrusion, section: {section}, axis: z, low: 0, high: 0.004}}")
    assert bounding_box(load_scene(path).fluids["water"].shape)[1] == pytest.approx([2e-3, 1e-3, 4e-3])


@pytest.mark.parametrize(
    ("shape", "dimension", "key", "message"),
    [
        ("{type: mesh, file: none.stl}", 3, "file", "there is no such file"),
        ("{type: mesh, file: scene.yaml}", 3, "file", "a mesh file ends in one of .stl"),
        ("{type: mesh, file: box.stl, prim: /World}", 3, "file", "for USD stages only"),
        ("{type: mesh, file: box.stl, unit: mile}", 3, "unit", "this value is not allowed here"),
        ("{type: mesh, file: box.stl, unit: mm}", 2, "type", "a mesh exists only where dimension is 3"),
        ("{type: polygon, file: none.csv}", 2, "file", "No such file"),
        ("{type: polygon}", 2, "", "needs its points, or a file"),
        ("{type: polygon, unit: mm, points: [[0, 0], [1, 0], [0, 1]]}", 2, "", "unit is that of a file"),
        ("{type: naca, digits: '2000', chord: 1}", 2, "digits", "thickness, which is not zero"),
        ("{type: naca, digits: 2012, chord: 1}", 2, "digits", "needs its place"),
        ("{type: naca, digits: 12345, chord: 1}", 2, "digits", ""),
        ("{type: naca, digits: '0012', chord: 1}", 3, "type", "a naca exists only where dimension is 2"),
    ],
)
def test_what_is_no_solid_is_an_error_of_the_scene(
    folder: Path, shape: str, dimension: int, key: str, message: str
) -> None:
    problem = problem_of(scene_file(folder, shape, dimension))
    assert problem.key == f"fluids.water.shape.{key}".rstrip(".")
    assert message in problem.message
    assert (problem.file, problem.line) == (str(folder / "scene.yaml"), 9 if key else 8)


def test_mesh_in_millimetres_taken_for_metres_is_told_by_its_size(folder: Path) -> None:
    problem = problem_of(scene_file(folder, "{type: mesh, file: box.stl, unit: 100}"))
    assert problem.key == "spacing"
    assert "most of them fluids.water.shape of 100 x 200 x 300 m" in problem.message


def test_open_mesh_is_an_error_of_the_scene(folder: Path) -> None:
    vertices, faces = build.box()
    trimesh.Trimesh(vertices, faces[1:]).export(folder / "open.stl")
    problem = problem_of(scene_file(folder, "{type: mesh, file: open.stl}"))
    assert problem.key == "fluids.water.shape.file"
    assert "open along 3 of its 18 edges" in problem.message


def test_scene_written_elsewhere_finds_its_files(folder: Path) -> None:
    scene = load_scene(scene_file(folder, "{type: mesh, file: box.stl, unit: mm}"))
    elsewhere = folder / "out"
    elsewhere.mkdir()
    (elsewhere / "scene.yaml").write_text(scene.to_yaml(elsewhere))
    again = load_scene(elsewhere / "scene.yaml")
    assert again.fluids["water"].shape.file == "../box.stl"
    assert np.array_equal(*(bounding_box(s.fluids["water"].shape) for s in (scene, again)))


@pytest.mark.parametrize("digits", ["'0012'", "0012", "12"])
def test_four_digits_as_text_or_number(folder: Path, digits: str) -> None:
    scene = load_scene(scene_file(folder, f"{{type: naca, digits: {digits}, chord: 0.1}}", dimension=2))
    assert scene.fluids["water"].shape.digits == "0012"
    assert scene_from_yaml(scene.to_yaml()) == scene


def test_angle_of_attack_turns_the_nose_up_about_the_quarter_chord() -> None:
    section = SHAPE.validate_python(
        {"type": "naca", "digits": "0012", "chord": 2.0, "position": [3.0, 1.0], "angle_of_attack": 30.0}
    )
    nose, tail = section.outline[section.outline[:, 0].argmin()], section.outline[0]
    assert tail == pytest.approx([3.0 + 1.5 * np.cos(np.pi / 6.0), 1.0 - 0.75], abs=1e-12)
    assert nose == pytest.approx([3.0 - 0.5 * np.cos(np.pi / 6.0), 1.0 + 0.25], abs=0.03)


def test_mesh_made_in_python_counts_from_the_current_directory(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    assert SHAPE.validate_python({"type": "mesh", "file": "box.stl"}).surface.volume == pytest.approx(6.0)


def test_file_that_changes_is_read_again(folder: Path) -> None:
    spec = {"type": "mesh", "file": str(folder / "box.stl")}
    before = SHAPE.validate_python(spec)
    trimesh.Trimesh(*build.ball(fineness=2)).export(folder / "box.stl")
    assert SHAPE.validate_python(spec).surface.volume < 4.2
    assert before.surface.volume == pytest.approx(6.0)
