"""The tools behind the pages of choices: tables go between the marks, and every choice can be made."""

from pathlib import Path

import fluid_defaults
import pytest
import trials

from warpsph import load_scene


def test_a_table_replaces_what_stands_between_the_marks(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(f"above\n{trials.BEGIN}\nold\n{trials.END}\nbelow\n")
    trials.write_table(page, ["a", "b"], [["1", "2"]])
    lines = ["| a | b |", "| --- | --- |", "| 1 | 2 |"]
    assert page.read_text().splitlines() == ["above", trials.BEGIN, *lines, trials.END, "below"]


@pytest.mark.parametrize("scene", fluid_defaults.SCENES)
def test_every_choice_is_one_that_the_scene_can_make(scene: str) -> None:
    """A scene that could not be loaded raises here, not after an hour of runs."""
    names = []
    for name, overrides in fluid_defaults.choices(scene):
        load_scene(scene, [*fluid_defaults.SCENES[scene], *overrides])
        names.append(name)
    assert len(names) == len(set(names)) > 10
