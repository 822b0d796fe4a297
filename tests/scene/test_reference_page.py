"""docs/scene.md: written from the schema as it is now, with an example that loads."""

import importlib.util
import re
from pathlib import Path

from warpsph.scene import scene_from_yaml

ROOT = Path(__file__).parents[2]


def test_the_page_is_current() -> None:
    specification = importlib.util.spec_from_file_location(
        "scene_reference", ROOT / "tools/scene_reference.py"
    )
    assert specification is not None
    assert specification.loader is not None
    tool = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(tool)
    assert tool.PAGE.read_text() == tool.page(), "run python tools/scene_reference.py"


def test_the_example_of_the_page_is_a_scene() -> None:
    page = (ROOT / "docs/scene.md").read_text()
    example = re.search(r"A whole scene:\n\n```yaml\n(.*?)```", page, re.DOTALL)
    assert example is not None
    assert scene_from_yaml(example[1]).name == "column"
