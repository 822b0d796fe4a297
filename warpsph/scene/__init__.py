"""Scenes: what a run computes, as a YAML file or as Python objects."""

from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.json_schema import scene_json_schema
from warpsph.scene.library import shipped_scenes
from warpsph.scene.loader import load_scene, scene_from_yaml
from warpsph.scene.schema import Scene

__all__ = [
    "Problem",
    "Scene",
    "SceneError",
    "load_scene",
    "scene_from_yaml",
    "scene_json_schema",
    "shipped_scenes",
]
