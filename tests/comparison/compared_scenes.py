"""Small scenes for tests of comparisons."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from warpsph.scene import Scene, scene_from_yaml

TANK = """
name: tank
dimension: 2
spacing: 0.1
gravity: [0.0, -9.81]
time: {end: 2.0, frame_rate: 10}
fluids:
  water: {shape: {type: box, min: [0, 0], max: [1, 1]}, density: 1000}
boundaries:
  tank: {shape: {type: box, min: [0, 0], max: [1, 2]}, side: outside, open: [y_max]}
probes:
  front: {type: front, axis: x}
  energy: {type: energy}
  body: {type: force_coefficients, boundaries: [tank], speed: 2.0, length: 0.5}
references: %s
"""


def tank_with(base_directory: Path | None = None, **references: dict[str, Any]) -> Scene:
    """A tank of water that is compared with these references."""
    with_source = {name: {"source": "closed form", **reference} for name, reference in references.items()}
    return scene_from_yaml(TANK % json.dumps(with_source), base_directory)
