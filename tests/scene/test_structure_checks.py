"""Structures: nonsense is refused at its line, by its key, with the reason; all mistakes of a file at once."""

import pytest
from scene_texts import problems_of

BEAM = """\
name: beam
dimension: 2
spacing: 0.1
gravity: [0.0, -9.81]
time: {end: 1.0, frame_rate: 10.0}
structures:
  beam:
    shape: {type: box, min: [0.0, 0.0], max: [1.0, 0.3]}
    material:
      law: neo_hookean
      density: 1000.0
      youngs_modulus: 1.0e6
      poisson_ratio: 0.3
    plane: strain
    velocity: [0.0, 0.1*x]
    displacement: [0.0, 0.0]
    damping: 0.0
    clamps:
      root:
        region: {type: box, min: [0.0, 0.0], max: [0.2, 0.3]}
        axes: [x, y]
        motion: [{type: linear, velocity: [0.0, 0.1]}]
    loads:
      tip: {type: force, region: {type: box, min: [0.9, 0.0], max: [1.0, 0.3]}, value: [0.0, 5.0], factor: sin(t)}
      pull: {type: body, value: [1.0, 2.0]}
numerics:
  structure:
    h_over_dp: 0.8
    hourglass: 0.5
    cfl: 0.8
    solution: {type: static, tolerance: 0.001}
contact:
  stiffness: 1.0
  friction: 0.0
"""

ROOT, TIP = "structures.beam.clamps.root", "structures.beam.loads.tip"
NONSENSE = [
    # material
    ("law: neo_hookean", "law: neo_hokean", "structures.beam.material.law", "did you mean 'neo_hookean'?"),
    ("law: neo_hookean", "law: wood", "structures.beam.material.law", "there is no law 'wood'"),
    ("density: 1000.0", "density: 0", "structures.beam.material.density", "too small"),
    ("youngs_modulus: 1.0e6", "youngs_modulus: -1", "structures.beam.material.youngs_modulus", "too small"),
    ("youngs_modulus: 1.0e6", "youngs: 1e6", "structures.beam.material.youngs", "did you mean 'youngs_modulus'?"),
    ("poisson_ratio: 0.3", "poisson_ratio: 0.5", "structures.beam.material.poisson_ratio", "too large"),
    ("poisson_ratio: 0.3", "poisson_ratio: -1.0", "structures.beam.material.poisson_ratio", "too small"),
    ("plane: strain", "plane: stres", "structures.beam.plane", "did you mean 'stress'?"),
    # the body
    ("max: [1.0, 0.3]}\n    mat", "max: [1.0, -0.3]}\n    mat", "structures.beam.shape.max", "greater than min"),
    ("velocity: [0.0, 0.1*x]", "velocity: [0.0, 0.1*z]", "structures.beam.velocity.1", "z has no meaning here"),
    ("velocity: [0.0, 0.1*x]", "velocity: [0.0]", "structures.beam.velocity", "too few values"),
    ("displacement: [0.0, 0.0]", "displacement: [0.0, t]", "structures.beam.displacement.1",
     "t has no meaning here"),
    ("displacement: [0.0, 0.0]", "displacement: [0.0, 0.0, 0.0]", "structures.beam.displacement",
     "3 components where dimension is 2"),
    ("damping: 0.0", "damping: -1.0", "structures.beam.damping", "too small"),
    # clamps
    ("axes: [x, y]", "axes: [x, z]", f"{ROOT}.axes.1", "no z where dimension is 2"),
    ("axes: [x, y]", "axes: [x, x]", f"{ROOT}.axes.1", "already"),
    ("axes: [x, y]", "axes: []", f"{ROOT}.axes", "no component is prescribed"),
    ("max: [0.2, 0.3]", "max: [0.2, 0.3, 0.1]", f"{ROOT}.region.max", "3 components"),
    ("velocity: [0.0, 0.1]}]", "velocity: [0.0, 0.1, 0.0]}]", f"{ROOT}.motion.0.velocity", "3 components"),
    # loads
    ("factor: sin(t)", "factor: sin(x)", f"{TIP}.factor", "x has no meaning here"),
    ("value: [0.0, 5.0]", "value: [0.0, 5.0, 0.0]", f"{TIP}.value", "3 components"),
    ("type: force", "type: forse", TIP, "did you mean 'force'?"),
    ("max: [1.0, 0.3]}, value", "max: [1.0, 0.3, 1.0]}, value", f"{TIP}.region.max", "3 components"),
    ("value: [1.0, 2.0]", "value: [1.0, 2.0], region: {type: sphere, center: [0, 0, 0], radius: 1}",
     "structures.beam.loads.pull.region.center", "3 components"),
    # numerics and contact
    ("h_over_dp: 0.8", "h_over_dp: 0.5", "numerics.structure.h_over_dp", "too small"),
    ("hourglass: 0.5", "hourglass: -0.5", "numerics.structure.hourglass", "too small"),
    ("cfl: 0.8", "cfl: 1.2", "numerics.structure.cfl", "too large"),
    ("tolerance: 0.001", "tolerance: 0", "numerics.structure.solution.tolerance", "too small"),
    ("type: static", "type: statik", "numerics.structure.solution", "did you mean 'static'?"),
    ("stiffness: 1.0", "stiffness: 0", "contact.stiffness", "too small"),
    ("friction: 0.0", "friction: -0.1", "contact.friction", "too small"),
]  # fmt: skip

WATER = (
    "fluids={water: {shape: {type: box, min: [2, 0], max: [3, 1]}, density: 1000, kinematic_viscosity: 0}}"
)
TOGETHER = [
    (["structures.beam.plane=stress", "structures.beam.material.law=split_neo_hookean"],
     "structures.beam.plane", "split_neo_hookean is not there for plane stress"),
    (["boundaries={beam: {shape: {type: box, min: [2, 0], max: [3, 1]}, side: solid}}"],
     "structures.beam", "another set has the name 'beam' already"),
    (["structures={}"], "fluids", "neither fluids nor structures"),
    (["structures={}"], "contact", "no structure to be touched"),
    ([WATER], "numerics.structure.solution.type", "fluids move in time"),
    ([WATER, "domain.symmetry={x_min: -1}"], "domain.symmetry", "no images"),
    ([WATER, "structures.beam.slip=no_slip", "numerics.viscosity={type: none}"],
     "structures.beam.slip", "without viscosity cannot stick"),
    (["structures.beam.slip=no_slip"], "structures.beam.slip", "no fluid to stick"),
    (["coupling.sub_steps=4"], "coupling", "nothing to couple"),
    (["probes={load: {type: force, structure: beam}}"], "probes.load.structure", "no fluid acts"),
    ([WATER, "probes={load: {type: force}}"], "probes.load", "one boundary or at one structure"),
    ([WATER, "probes={load: {type: force, structure: bem}}"], "probes.load.structure", "did you mean 'beam'"),
]  # fmt: skip

SOLID = BEAM.replace("dimension: 2", "dimension: 3").replace("plane: strain", "plane: stress")


@pytest.mark.parametrize(("old", "new", "key", "reason"), NONSENSE)
def test_nonsense_is_refused_at_its_line(old: str, new: str, key: str, reason: str) -> None:
    assert BEAM.count(old) == 1, f"{old!r} does not stand exactly once in the scene"
    text = BEAM.replace(old, new)
    line = text.count("\n", 0, text.index(new.split("\n")[0])) + 1
    problems = [problem for problem in problems_of(text) if problem.key in (key, f"{key}.type")]
    assert problems
    assert reason in problems[0].message
    assert problems[0].allowed
    assert problems[0].line == line


@pytest.mark.parametrize(("overrides", "key", "reason"), TOGETHER)
def test_values_that_do_not_go_together_are_refused(overrides: list[str], key: str, reason: str) -> None:
    problems = {problem.key: problem for problem in problems_of(BEAM, overrides)}
    assert key in problems
    assert reason in problems[key].message
    assert problems[key].allowed


def test_there_is_no_plane_in_three_dimensions() -> None:
    problems = {problem.key: problem.message for problem in problems_of(SOLID)}
    assert "no plane in three dimensions" in problems["structures.beam.plane"]


def test_all_mistakes_are_told_at_once() -> None:
    text = BEAM.replace("law: neo_hookean", "law: wood").replace("axes: [x, y]", "axes: [x, z]")
    text = text.replace("factor: sin(t)", "factor: sin(x)").replace("[0.0, -9.81]", "[0.0, 0.0, -9.81]")
    keys = [problem.key for problem in problems_of(text)]
    assert keys == ["gravity", "structures.beam.material.law", f"{ROOT}.axes.1", f"{TIP}.factor"]


def test_a_mistake_in_the_only_body_hides_no_other() -> None:
    text = BEAM.replace("poisson_ratio: 0.3", "poisson_ratio: 0.5")
    text += "probes:\n  tip: {type: displacement, structure: beem, at: [1.0, 0.15]}\n"
    keys = [problem.key for problem in problems_of(text)]
    assert keys == ["structures.beam.material.poisson_ratio", "probes.tip.structure"]
