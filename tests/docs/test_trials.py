"""The tools behind the pages of choices: tables go between the marks, and every choice can be made."""

from pathlib import Path

import coupling_choices
import fluid_defaults
import particle_order
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


def test_the_page_of_coupling_has_a_place_for_every_table() -> None:
    page = coupling_choices.PAGE.read_text()
    for name in coupling_choices.TABLES:
        assert page.count(f"<!-- {name}:begin -->") == page.count(f"<!-- {name}:end -->") == 1


def test_a_diverging_run_is_a_row_and_not_the_end_of_the_page() -> None:
    """A plate of a hundredth of the stiffness that could bear the water is crushed."""
    scene = coupling_choices.held_back(1.0, 1e2, "auto", 0.6)
    trial = coupling_choices.measure(scene, coupling_choices.elastic_energy)
    assert trial.end < scene.time.end


@pytest.mark.parametrize("scene", particle_order.SCENES)
def test_every_particle_order_is_one_that_the_scene_can_have(scene: str) -> None:
    for overrides in particle_order.CHOICES.values():
        load_scene(scene, [*particle_order.SCENES[scene], *particle_order.FIXED, *overrides])
