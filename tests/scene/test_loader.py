"""The loader: every problem at once, each with file, line, key, value and what is allowed."""

from pathlib import Path

import pytest
from scene_texts import DAM_BREAK, changed, problems_of

from warpsph.scene import Problem, Scene, SceneError, load_scene, scene_from_yaml, shipped_scenes


def write(path: Path, content: str | bytes) -> Path:
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def test_a_scene_file_becomes_a_scene(tmp_path: Path) -> None:
    scene = load_scene(write(tmp_path / "dam.yaml", DAM_BREAK))
    assert isinstance(scene, Scene)
    assert scene.fluids["water"].kinematic_viscosity == 1e-6
    assert scene.base_directory == tmp_path


def test_numbers_of_yaml_1_2_need_no_point() -> None:
    text, _ = changed("spacing: 0.05", "spacing: 5e-2")
    assert scene_from_yaml(text).spacing == 0.05


def test_all_problems_are_reported_at_once_in_the_order_of_the_file() -> None:
    text = DAM_BREAK
    for old, new in [
        ("spacing: 0.05", "spacing: -0.05"),
        ("side: outside", "side: outsid"),
        ("alpha: 0.05", "beta: 0.05"),
        ("force, boundary: tank", "force, boundary: tnk"),
    ]:
        text = text.replace(old, new)
    found = [(problem.line, problem.key) for problem in problems_of(text)]
    assert found == [
        (4, "spacing"),
        (12, "numerics.viscosity.beta"),
        (23, "boundaries.tank.side"),
    ]


def test_physics_is_checked_beside_wrong_values() -> None:
    text = DAM_BREAK.replace("side: outside", "side: outsid").replace("boundary: tank}", "boundary: tnk}")
    assert [problem.key for problem in problems_of(text)] == ["boundaries.tank.side", "probes.load.boundary"]


@pytest.mark.parametrize(
    ("old", "new", "key", "near"),
    [
        ("spacing: 0.05", "spacin: 0.05", "spacin", "spacing"),
        ("alpha: 0.05", "alhpa: 0.05", "numerics.viscosity.alhpa", "alpha"),
        ("frequency: 1.0", "frequency: 1.0, pase: 3", "boundaries.tank.motion.0.pase", "phase"),
        ("window: [1.0, 2.0]", "windw: [1.0, 2.0]", "references.energy.windw", "window"),
        ("type: water_level", "type: water_lvel", "probes.height.type", "water_level"),
        ("side: outside", "side: outsid", "boundaries.tank.side", "outside"),
        ("{time: [0.1, 0.2]", "{times: [0.1, 0.2]", "references.front.table.times", "time"),
    ],
)  # fmt: skip
def test_what_is_unknown_gets_the_nearest_known(old: str, new: str, key: str, near: str) -> None:
    text, line = changed(old, new)
    problem = next(problem for problem in problems_of(text) if problem.key == key)
    assert f"did you mean {near!r}?" in problem.message
    assert near in problem.allowed
    assert problem.line == line


@pytest.mark.parametrize(
    ("old", "new", "key", "allowed"),
    [
        ("sound_speed: auto", "sound_speed: fast", "numerics.sound_speed", "auto or a number greater than 0"),
        ("sound_speed: auto", "sound_speed: {}", "numerics.sound_speed", "auto or a number greater than 0"),
        ("sound_speed: auto", "h_over_dp: 9", "numerics.h_over_dp", "a number at least 1 and at most 4"),
        ("dimension: 2", "dimension: 4", "dimension", "2, 3"),
        ("type: force, ", "", "probes.load.type", "front, line, momentum, point, reach"),
        ("box, min: [0.0, 0.0], max: [4", "bx, min: [0, 0], max: [4", "boundaries.tank.shape.type", "box"),
        ("{type: energy}", "energy", "probes.energy", "a mapping with a type: "),
        ("{type: energy}", "{type: 3}", "probes.energy.type", "energy"),
        ("{type: energy}", "", "probes.energy", "a mapping with a type: "),
        ("at: [4.0, 0.1]", "at: [4.0, true]", "probes.patch.at.1", "a number"),
        ("at: [4.0, 0.1]", "at: 4.0", "probes.patch.at", "a list of 2 or 3 values, each a number"),
        ("at: [4.0, 0.1], ", "", "probes.patch.at", "a list of 2 or 3 values, each a number"),
        ("open: [y_max]", "open: [top]", "boundaries.tank.open.0", "x_min, x_max, y_min"),
        ("  tank:\n", "  my tank:\n", "boundaries.my tank", "letters, digits and underscores"),
        ("periodic: {}", "periodic: {w: [0, 1]}", "domain.periodic.w", "x, y, z"),
        ("resolutions: [0.05, 0.025]", "resolutions: []", "validation.resolutions", "a list of values"),
        ("name: dam_break", "name: Dam break", "name", "Lower-case letters"),
        ("description: A column of water collapses in a tank.", "description: 3", "description", "text"),
    ],
)  # fmt: skip
def test_a_refused_value_comes_with_what_is_allowed(old: str, new: str, key: str, allowed: str) -> None:
    text, line = changed(old, new)
    problem = next(problem for problem in problems_of(text) if problem.key == key)
    assert allowed in problem.allowed
    assert problem.line == line


def test_a_missing_section_is_named() -> None:
    text, _ = changed("time: {end: 2.0, frame_rate: 50.0}\n", "")
    problem = problems_of(text)[0]
    assert (problem.key, problem.line, problem.has_value) == ("time", 1, False)
    assert "end, frame_rate" in problem.allowed


def test_keys_of_a_tag_and_keys_named_like_it_are_told_apart() -> None:
    text, line = changed(
        "{type: box, min: [0.0, 0.0], max: [4.0", "{type: box, box: 1, min: [0.0, 0.0], max: [4.0"
    )
    problems = problems_of(text)
    assert [(problem.key, problem.line) for problem in problems] == [("boundaries.tank.shape.box", line)]


def test_the_text_of_the_error_is_the_whole_message(tmp_path: Path) -> None:
    text = DAM_BREAK.replace("density: 1000.0", "density: -1.0")
    path = write(tmp_path / "dam.yaml", text)
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    assert str(caught.value).splitlines() == [
        f"{path}, line 16: fluids.water.density: the number is too small",
        "    value:   -1.0",
        "    allowed: a number greater than 0; Reference density [kg/m3]",
    ]


@pytest.mark.parametrize(
    ("content", "line", "reason"),
    [
        (b"", 1, "empty"),
        (b"# nothing but a comment\n", 1, "empty"),
        (b"- 1\n- 2\n", 1, "no mapping"),
        (b"just words", 1, "no mapping"),
        (b"name: x\nfluids: {water: {shape: [", 2, "not valid YAML"),
        (b"a: b: c\n", 1, "not valid YAML"),
        (b"name: x\n---\nname: y\n", 2, "not valid YAML"),
        (b"name: *nobody\n", 1, "not valid YAML"),
        (b"name: x\n\x00\x01\x02", 2, "not text"),
        (b"name: x\nd: \xff\xfe", 2, "not UTF-8"),
        (b"name: x\nname: y\n", 2, "stands in line 1 already"),
        (b"name: x\n1: 2\n", 2, "a key must be a word"),
        (b"name: x\n? [1, 2]\n: 3\n", 2, "a key must be a word"),
        (b"name: x\nspacing: !dp 0.1\n", 2, "tag !dp is not known"),
        (b"name: x\nspacing: !!int word\n", 2, "cannot be read"),
        (b"name: &all [*all]\n", 1, "nested too deeply"),
        (b"a: &a [1,1,1,1,1,1,1,1,1]\n" + b"".join(
            b"%c: &%c [%s]\n" % (key, key, b",".join([b"*%c" % (key - 1)] * 9)) for key in range(98, 108)
        ), None, "expands to too many values"),
        (b"a: " + b"[" * 1000, None, "nested too deeply"),
        (b"#" * 2_000_000, None, "more than 1000000 bytes"),
    ],
)  # fmt: skip
def test_a_broken_file_is_refused_at_its_line(
    tmp_path: Path, content: bytes, line: int | None, reason: str
) -> None:
    path = write(tmp_path / "broken.yaml", content)
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    problem = caught.value.problems[0]
    assert problem.file == str(path)
    assert reason in problem.message
    assert line is None or problem.line == line


@pytest.mark.parametrize("name", ["", "no/such/scene.yaml", "x" * 5000, "nul\0byte"])
def test_what_is_no_file_is_refused(name: str) -> None:
    with pytest.raises(SceneError) as caught:
        load_scene(name)
    assert caught.value.problems[0].message


def test_a_directory_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="directory"):
        load_scene(tmp_path)


def test_a_missing_name_suggests_the_nearest_shipped_scene() -> None:
    name = next(iter(shipped_scenes()))
    with pytest.raises(SceneError, match=f"did you mean '{name}'"):
        load_scene(name[:-1])


def test_an_alias_shares_a_value() -> None:
    text = DAM_BREAK.replace("max: [4.0, 3.0]", "max: &corner [4.0, 3.0]").replace(
        "at: [4.0, 0.1]", "at: *corner"
    )
    assert scene_from_yaml(text).probes["patch"].at == (4.0, 3.0)


def test_tables_are_read_before_the_run(tmp_path: Path) -> None:
    write(tmp_path / "front.csv", "t,x\n0.1,1.0\n0.2,oops\n")
    inline = "table: {time: [0.1, 0.2], value: [1.0, 1.1]}"
    text, line = changed(inline, "table: {file: front.csv, time: t, value: x}")
    with pytest.raises(SceneError) as caught:
        scene_from_yaml(text, tmp_path)
    (problem,) = caught.value.problems
    assert (problem.key, problem.line) == ("references.front.table.file", line)
    assert "front.csv, line 3: 'oops' is not a number" in problem.message


def test_tables_have_increasing_times(tmp_path: Path) -> None:
    write(tmp_path / "sway.csv", "t,x\n0.1,1.0\n0.1,1.1\n")
    motion = "{type: sinusoid, translation: [0.1, 0.0], frequency: 1.0}"
    text, line = changed(motion, "{type: table, file: sway.csv, time: t, translation: {x: x}}")
    with pytest.raises(SceneError) as caught:
        scene_from_yaml(text, tmp_path)
    (problem,) = caught.value.problems
    assert (problem.key, problem.line) == ("boundaries.tank.motion.0.file", line)
    assert "do not increase" in problem.message


def test_later_errors_get_the_lines_of_the_file() -> None:
    scene = scene_from_yaml(DAM_BREAK)
    later = SceneError([Problem(key="fluids.water.shape.max", message="it overlaps a wall")])
    (problem,) = scene.located(later).problems
    assert (problem.file, problem.line) == ("<text>", 15)
