"""Shipped scenes: each is found by the name that it has inside."""

import pytest

from warpsph.scene import load_scene, shipped_scenes


@pytest.mark.parametrize("name", shipped_scenes())
def test_a_shipped_scene_is_valid_and_has_the_name_of_its_file(name: str) -> None:
    assert load_scene(name).name == name
