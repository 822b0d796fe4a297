"""The JSON schema of scene files, by which editors complete and check them."""

from __future__ import annotations

from typing import Any

from warpsph.scene.schema import Scene


def scene_json_schema() -> dict[str, Any]:
    """JSON schema (draft 2020-12) of a scene file, with title, description and default of every key."""
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "warpsph scene"}
    return head | {key: value for key, value in Scene.model_json_schema().items() if key != "title"}
