"""Scene.to_yaml: what is written is read back as the same scene."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scene_texts import DAM_BREAK

from warpsph.scene import Scene, load_scene, scene_from_yaml, shipped_scenes
from warpsph.scene.probes import EnergyProbe, FrontProbe, PointProbe
from warpsph.scene.schema import Boundary, Fluid, Time
from warpsph.scene.shapes import Box

positive = st.floats(1e-30, 1e30)
finite = st.one_of(st.just(0.0), positive, st.floats(-1e30, -1e-30))
names = st.from_regex(r"[A-Za-z][A-Za-z0-9_]*", fullmatch=True)
probes = st.one_of(
    st.builds(FrontProbe, axis=st.sampled_from("xy")),
    st.builds(PointProbe, at=st.tuples(finite, finite)),
    st.builds(EnergyProbe),
)


def scene_of(**changes: object) -> Scene:
    """A small scene built from Python."""
    data = {
        "name": "block",
        "dimension": 2,
        "spacing": 0.1,
        "time": Time(end=1.0, frame_rate=10.0),
        "fluids": {"water": Fluid(shape=Box(min=(0.0, 0.0), max=(1.0, 1.0)), density=1000.0)},
    }
    return Scene(**data | changes)


def test_a_scene_file_survives_the_round_trip() -> None:
    scene = scene_from_yaml(DAM_BREAK)
    assert scene_from_yaml(scene.to_yaml()) == scene


@pytest.mark.parametrize("name", shipped_scenes())
def test_shipped_scenes_survive_the_round_trip(name: str) -> None:
    scene = load_scene(name)
    assert scene_from_yaml(scene.to_yaml(), scene.base_directory) == scene


@settings(max_examples=30)
@given(st.text(), positive, st.tuples(finite, finite), st.dictionaries(names, probes, max_size=3))
def test_any_text_and_number_survives_the_round_trip(
    description: str, density: float, gravity: tuple[float, float], probes: dict[str, object]
) -> None:
    water = Fluid(shape=Box(min=(0.0, 0.0), max=(1.0, 1.0)), density=density)
    scene = scene_of(description=description, gravity=gravity, fluids={"water": water}, probes=probes)
    assert scene_from_yaml(scene.to_yaml()) == scene


@pytest.mark.parametrize("text", ["\x85", "a\x85b", "a: \u2028", "\u2029 b\n"])
def test_rare_line_breaks_survive_the_round_trip(text: str) -> None:
    scene = scene_of(description=text)
    assert scene_from_yaml(scene.to_yaml()) == scene


def test_numbers_of_numpy_are_written_as_numbers() -> None:
    scene = scene_of(spacing=np.float64(0.05), gravity=np.array([0.0, -9.81]).tolist())
    assert scene_from_yaml(scene.to_yaml()) == scene


def test_names_that_read_as_other_things_survive_the_round_trip() -> None:
    wall = Boundary(shape=Box(min=(0.0, 0.0), max=(1.0, 1.0)), side="outside")
    scene = scene_of(boundaries=dict.fromkeys(("null", "true", "yes", "n", "e1"), wall))
    assert scene_from_yaml(scene.to_yaml()) == scene


def test_every_default_is_written() -> None:
    text = scene_of().to_yaml()
    for line in ("kernel: wendland_c2", "h_over_dp: 1.5", "max_step: null", "kinematic_viscosity: 0.0"):
        assert line in text


def test_file_names_can_follow_the_scene_to_another_directory(tmp_path: Path) -> None:
    home, run = tmp_path / "home", tmp_path / "out" / "run"
    home.mkdir()
    run.mkdir(parents=True)
    (home / "front.csv").write_text("t,x\n0.1,1.0\n0.2,1.1\n")
    inline = "{time: [0.1, 0.2], value: [1.0, 1.1]}"
    (home / "dam.yaml").write_text(DAM_BREAK.replace(inline, "{file: front.csv, time: t, value: x}"))
    (run / "scene.yaml").write_text(load_scene(home / "dam.yaml").to_yaml(run))
    moved = load_scene(run / "scene.yaml").references["front"].table.file
    assert (run / moved).resolve() == home / "front.csv"
