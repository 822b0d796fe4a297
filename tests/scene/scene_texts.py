"""A scene that uses every section, and what the loader says of variants of it."""

from collections.abc import Sequence

import pytest

from warpsph.scene import Problem, SceneError, scene_from_yaml

DAM_BREAK = """\
name: dam_break
description: A column of water collapses in a tank.
dimension: 2
spacing: 0.05
gravity: [0.0, -9.81]
domain:
  periodic: {}
  kill_box: {min: [-1.0, -1.0], max: [5.0, 5.0]}
time: {end: 2.0, frame_rate: 50.0}
numerics:
  sound_speed: auto
  viscosity: {type: artificial, alpha: 0.05}
fluids:
  water:
    shape: {type: box, min: [0.0, 0.0], max: [1.0, 2.0]}
    density: 1000.0
    kinematic_viscosity: 1e-6
    velocity: [0.1*y, 0.0]
    pressure: {type: hydrostatic, surface: auto}
boundaries:
  tank:
    shape: {type: box, min: [0.0, 0.0], max: [4.0, 3.0]}
    side: outside
    open: [y_max]
    slip: free_slip
    motion:
      - {type: sinusoid, translation: [0.1, 0.0], frequency: 1.0}
probes:
  front: {type: front, axis: x, fluid: water}
  height: {type: water_level, at: [0.0], axis: auto}
  patch: {type: wall_pressure, boundary: tank, at: [4.0, 0.1], radius: 0.1}
  middle: {type: point, at: [2.0, 0.1], fields: [pressure]}
  load: {type: force, boundary: tank}
  energy: {type: energy}
  volume: {type: volume}
output:
  probe_rate: 200.0
  fields: [velocity, pressure]
references:
  front:
    type: series
    column: front.position[m]
    table: {time: [0.1, 0.2], value: [1.0, 1.1]}
    bound: 0.03
    source: nobody
  pressure:
    type: field
    set: water
    field: pressure
    expression: 1000*9.81*(2.0-y)
    relative_to: 9810.0
    source: hydrostatics
  energy:
    type: limit
    column: energy.kinetic[J/m]
    window: [1.0, 2.0]
    high: 0.5
    source: nobody
validation:
  resolutions: [0.05, 0.025]
  quick: [0.05]
  set: {time.end: 1.0}
"""


def changed(old: str, new: str) -> tuple[str, int]:
    """The scene with one passage replaced, and the line in which the new passage ends."""
    assert DAM_BREAK.count(old) == 1, f"{old!r} does not stand exactly once in the scene"
    text = DAM_BREAK.replace(old, new)
    return text, text.count("\n", 0, DAM_BREAK.index(old) + len(new.rstrip("\n"))) + 1


def problems_of(text: str, overrides: Sequence[str] = ()) -> tuple[Problem, ...]:
    """The problems for which the loader refuses a text."""
    with pytest.raises(SceneError) as caught:
        scene_from_yaml(text, overrides=overrides)
    return caught.value.problems
