"""The JSON schema: valid itself, complete, and of one mind with the loader."""

from collections.abc import Iterator
from typing import Any

import jsonschema
import pytest
from ruamel.yaml import YAML
from scene_texts import DAM_BREAK, changed

from warpsph.scene import load_scene, scene_json_schema, shipped_scenes

SCHEMA = scene_json_schema()


def properties(node: Any, path: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    """Every property of every object in the schema, with its path; `type` explains itself."""
    for name, child in node.items() if isinstance(node, dict) else ():
        if name == "properties":
            yield from ((f"{path}.{key}", value) for key, value in child.items() if key != "type")
        yield from properties(child, f"{path}.{name}")


def test_it_is_a_json_schema() -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    assert SCHEMA["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    assert SCHEMA["title"] == "warpsph scene"


def test_every_key_is_described() -> None:
    described = {path: property_.get("description") for path, property_ in properties(SCHEMA)}
    assert len(described) > 100
    assert [path for path, description in described.items() if not description] == []


def test_it_accepts_a_valid_scene() -> None:
    jsonschema.validate(YAML(typ="safe", pure=True).load(DAM_BREAK), SCHEMA)


@pytest.mark.parametrize("name", shipped_scenes())
def test_it_accepts_the_shipped_scenes_with_and_without_defaults(name: str) -> None:
    yaml = YAML(typ="safe", pure=True)
    jsonschema.validate(yaml.load(shipped_scenes()[name]), SCHEMA)
    jsonschema.validate(yaml.load(load_scene(name).to_yaml()), SCHEMA)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("density: 1000.0", "density: -1"),
        ("density: 1000.0", "desnity: 1000"),
        ("type: energy", "type: enrgy"),
        ("{type: energy}", "{}"),
        ("side: outside", "side: out"),
        ("  tank:\n", "  my tank:\n"),
        ("at: [4.0, 0.1]", "at: [4.0]"),
    ],
)
def test_it_refuses_what_the_loader_refuses(old: str, new: str) -> None:
    text, _ = changed(old, new)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(YAML(typ="safe", pure=True).load(text), SCHEMA)
