"""Bonds between structures: what cannot hold together is refused by its key, with the reason."""

import pytest
from scene_texts import problems_of

from warpsph.scene import scene_from_yaml

LAYERS = """\
name: layers
dimension: 2
spacing: 0.1
gravity: [0.0, -9.81]
time: {end: 1.0, frame_rate: 10.0}
structures:
  beam:
    shape: {type: box, min: [0.0, 0.0], max: [2.0, 0.3]}
    material: &rubber {density: 1000.0, youngs_modulus: 1.0e6, poisson_ratio: 0.3}
  coating:
    shape: {type: box, min: [0.0, 0.3], max: [2.0, 0.5]}
    material: *rubber
  raft:
    shape: {type: box, min: [3.0, 0.0], max: [4.0, 0.5]}
    material: *rubber
bonds: [[beam, coating]]
"""

WRONG = [
    (["bonds=[[beam, coatin]]"], "bonds.0.1", "did you mean 'coating'"),
    (["bonds=[[beam, beam]]"], "bonds.0.1", "stands in bonds.0.0 already"),
    (["bonds=[[beam, coating], [coating, raft]]"], "bonds.1.0", "stands in bonds.0.1 already"),
    (["bonds=[[beam]]"], "bonds.0", ""),
    (["bonds=[[beam, raft]]", "structures.raft.rigid={}"], "bonds.0.1", "a rigid body cannot be bonded"),
    (["structures.coating.plane=stress"], "bonds.0", "different states across the plane"),
]


def test_a_group_of_bonded_structures_is_read_and_written() -> None:
    scene = scene_from_yaml(LAYERS)
    assert scene.bonds == (("beam", "coating"),)
    assert scene_from_yaml(scene.to_yaml()) == scene


@pytest.mark.parametrize(("overrides", "key", "reason"), WRONG)
def test_what_cannot_hold_together_is_refused(overrides: list[str], key: str, reason: str) -> None:
    problems = {problem.key: problem for problem in problems_of(LAYERS, overrides)}
    assert list(problems) == [key]
    assert reason in problems[key].message
    assert problems[key].allowed


def test_separate_structures_may_be_in_different_states() -> None:
    text = LAYERS.replace("max: [4.0, 0.5]}", "max: [4.0, 0.5]}\n    plane: stress\n    rigid: {}")
    assert scene_from_yaml(text).structures["raft"].plane == "stress"
