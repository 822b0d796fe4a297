"""Rigid bodies: what they cannot be is refused by its key, with the reason; all mistakes of a file at once."""

import pytest
from scene_texts import problems_of

from warpsph.scene import scene_from_yaml

FLAT = """\
name: raft
dimension: 2
spacing: 0.1
gravity: [0.0, -9.81]
time: {end: 1.0, frame_rate: 10.0}
structures:
  raft:
    shape: {type: box, min: [0.0, 0.0], max: [1.0, 0.3]}
    material: {density: 500.0, youngs_modulus: 1.0e6, poisson_ratio: 0.3}
    rigid:
      free: [x, y, rz]
  beam:
    shape: {type: box, min: [2.0, 0.0], max: [3.0, 0.3]}
    material: {density: 500.0, youngs_modulus: 1.0e6, poisson_ratio: 0.3}
"""
SOLID = """\
name: raft
dimension: 3
spacing: 0.1
gravity: [0.0, 0.0, -9.81]
time: {end: 1.0, frame_rate: 10.0}
structures:
  raft:
    shape: {type: box, min: [0.0, 0.0, 0.0], max: [1.0, 0.3, 0.3]}
    material: {density: 500.0, youngs_modulus: 1.0e6, poisson_ratio: 0.3}
    rigid: {}
"""
RAFT = "structures.raft"
RIGID = f"{RAFT}.rigid"
SWAY = "[{type: linear, velocity: [1.0, 0.0]}]"
TURN = "[{type: rotation, center: [0.0, 0.0], rate: 10.0}]"

WRONG = [
    (FLAT, [f"{RIGID}.free=[x, rx]"], f"{RIGID}.free.1", "there is no rx where dimension is 2"),
    (FLAT, [f"{RIGID}.free=[x, x]"], f"{RIGID}.free.1", "already"),
    (FLAT, [f"{RIGID}.free=[heave]"], f"{RIGID}.free.0", ""),
    (FLAT, [f"{RIGID}.mass=0"], f"{RIGID}.mass", "too small"),
    (FLAT, [f"{RIGID}.inertia=[1.0, 1.0, 1.0]"], f"{RIGID}.inertia", "3 numbers where dimension is 2"),
    (FLAT, [f"{RIGID}.inertia=[-1.0]"], f"{RIGID}.inertia", "resists every rotation"),
    (FLAT, [f"{RIGID}.center_of_mass=[0.5, 0.1, 0.0]"], f"{RIGID}.center_of_mass", "3 components"),
    (FLAT, [f"{RIGID}.pivot=[0.0, 0.0]"], f"{RIGID}.pivot", "can move along an axis"),
    (FLAT, [f"{RIGID}.free=[]", f"{RIGID}.pivot=[0.0, 0.0]"], f"{RIGID}.pivot", "does not turn"),
    (FLAT, [f"{RIGID}.free=[rz]", f"{RIGID}.pivot=[0.0, 0.0]", f"{RIGID}.motion={SWAY}"],
     f"{RIGID}.pivot", "stays where it is"),
    (FLAT, [f"{RIGID}.motion={SWAY}"], f"{RIGID}.motion", "all axes are free"),
    (FLAT, [f"{RIGID}.free=[y, rz]", f"{RIGID}.motion={TURN}"], f"{RIGID}.motion.0", "whose rz is free"),
    (FLAT, [f"{RAFT}.clamps={{root: {{region: {{type: box, min: [0, 0], max: [1, 1]}}}}}}"],
     f"{RAFT}.clamps", "not by clamps"),
    (FLAT, [f"{RAFT}.displacement=[0.0, 0.1]"], f"{RAFT}.displacement", "begins where its shape is"),
    (FLAT, [f"{RAFT}.damping=1.0"], f"{RAFT}.damping", "not damped"),
    (FLAT, ["numerics={structure: {solution: {type: static}}}"], RIGID, "no equilibrium"),
    (FLAT, ["probes={motion: {type: rigid_body, structure: beam}}"], "probes.motion.structure", "is flexible"),
    (FLAT, ["probes={motion: {type: rigid_body, structure: rafts}}"], "probes.motion.structure", "did you mean"),
    (SOLID, [f"{RIGID}.inertia=[1.0]"], f"{RIGID}.inertia", "1 numbers where dimension is 3"),
    (SOLID, [f"{RIGID}.inertia=[1.0, 1.0, 1.0, 2.0, 0.0, 0.0]"], f"{RIGID}.inertia", "resists every rotation"),
    (SOLID, [f"{RIGID}.free=[rx]", f"{RIGID}.motion=[{{type: rotation, center: [0, 0, 0], rate: 10}}]"],
     f"{RIGID}.motion.0.axis", ""),
]  # fmt: skip


@pytest.mark.parametrize(("text", "overrides", "key", "reason"), WRONG)
def test_what_a_rigid_body_cannot_be_is_refused(
    text: str, overrides: list[str], key: str, reason: str
) -> None:
    problems = {problem.key: problem for problem in problems_of(text, overrides)}
    assert key in problems
    assert reason in problems[key].message
    assert problems[key].allowed


@pytest.mark.parametrize(
    ("text", "overrides"),
    [
        (FLAT, []),
        (FLAT, [f"{RIGID}.free=[]", f"{RIGID}.motion={TURN}"]),
        (FLAT, [f"{RIGID}.free=[y, rz]", f"{RIGID}.motion={SWAY}"]),
        (FLAT, [f"{RIGID}.free=[rz]", f"{RIGID}.pivot=[0.0, 0.0]", f"{RIGID}.inertia=[3.0]"]),
        (SOLID, [f"{RIGID}.inertia=[1.0, 2.0, 3.0]"]),
        (SOLID, [f"{RIGID}.inertia=[1.0, 2.0, 3.0, 0.1, 0.0, 0.2]", f"{RIGID}.mass=2.0"]),
    ],
)
def test_what_a_rigid_body_can_be_is_accepted(text: str, overrides: list[str]) -> None:
    assert scene_from_yaml(text, overrides=overrides).structures["raft"].rigid is not None


def test_all_mistakes_are_told_at_once() -> None:
    overrides = [
        f"{RIGID}.free=[x, rx]",
        f"{RIGID}.inertia=[0.0]",
        f"{RAFT}.damping=2.0",
        f"{RIGID}.pivot=[0.0, 0.0]",
    ]
    keys = {problem.key for problem in problems_of(FLAT, overrides)}
    assert keys == {f"{RIGID}.free.1", f"{RIGID}.inertia", f"{RAFT}.damping", f"{RIGID}.pivot"}
