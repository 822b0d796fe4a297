"""Physics and consistency: nonsense is refused at its line, by its key, with the reason."""

import pytest
from pydantic import ValidationError
from scene_texts import DAM_BREAK, changed, problems_of

from warpsph.scene import Scene, scene_from_yaml
from warpsph.scene.numerics import Numerics

BOX = "{type: box, min: [0.0, 0.0], max: [1.0, 2.0]}"
TANK = "{type: box, min: [0.0, 0.0], max: [4.0, 3.0]}"
MOTION = "{type: sinusoid, translation: [0.1, 0.0], frequency: 1.0}"
APART = "[{type: box, min: [0, 0], max: [1, 1]}, {type: box, min: [2, 0], max: [3, 1]}]"

NONSENSE = [
    # numbers
    ("density: 1000.0", "density: -1000.0", "fluids.water.density", "too small"),
    ("density: 1000.0", "density: 0", "fluids.water.density", "too small"),
    ("density: 1000.0", "density: .nan", "fluids.water.density", "not finite"),
    ("kinematic_viscosity: 1e-6", "kinematic_viscosity: -1e-6",
     "fluids.water.kinematic_viscosity", "too small"),
    ("spacing: 0.05", "spacing: 0.0", "spacing", "too small"),
    ("radius: 0.1", "radius: 0", "probes.patch.radius", "too small"),
    ("alpha: 0.05", "alpha: 50", "numerics.viscosity.alpha", "too large"),
    ("max: [4.0, 3.0]", "max: [4.0, 1e300]", "boundaries.tank.shape.max.1", "of this magnitude"),
    # time
    ("end: 2.0", "end: -2.0", "time.end", "too small"),
    ("end: 2.0", "end: 2.0, cfl: 2.0", "time.cfl", "too large"),
    ("frame_rate: 50.0", "frame_rate: 5e5", "time.frame_rate", "need 1e+06 frames"),
    ("probe_rate: 200.0", "probe_rate: 1e8", "output.probe_rate", "need 2e+08 probe samples"),
    # dimension
    ("gravity: [0.0, -9.81]", "gravity: [0.0, 0.0, -9.81]", "gravity", "3 components where dimension is 2"),
    (BOX, "{type: sphere, center: [1, 1, 1], radius: 1}", "fluids.water.shape.center", "3 components"),
    (BOX, "{type: cylinder, start: [0, 0, 0], end: [0, 0, 1], radius: 1}",
     "fluids.water.shape.type", "cylinder"),
    (TANK, "{type: union, shapes: [{type: sphere, center: [1, 1, 1], radius: 1}]}",
     "boundaries.tank.shape.shapes.0.center", "3 components"),
    ("translation: [0.1, 0.0]", "translation: [0.1, 0.0, 0.0]",
     "boundaries.tank.motion.0.translation", "3 comp"),
    ("[0.1*y, 0.0]", "[0.1*y, 0.0, 0.0]", "fluids.water.velocity", "3 components where dimension is 2"),
    ("[0.1*y, 0.0]", "[0.1*z, 0.0]", "fluids.water.velocity.0", "z has no meaning here"),
    ("[0.1*y, 0.0]", "[0.0, 0.1*t]", "fluids.water.velocity.1", "t has no meaning here"),
    ("open: [y_max]", "open: [y_max, z_min]", "boundaries.tank.open.1", "no z where dimension is 2"),
    ("periodic: {}", "periodic: {z: [0, 1]}", "domain.periodic.z", "no z where dimension is 2"),
    ("axis: x, fluid: water", "axis: z, fluid: water", "probes.front.axis", "no z where dimension is 2"),
    ("at: [0.0], axis: auto", "at: [0.0, 1.0], axis: auto", "probes.height.at", "2 coordinates"),
    ("field: pressure", "field: velocity_z", "references.pressure.field", "no z where dimension is 2"),
    ("(2.0-y)", "(2.0-z)", "references.pressure.expression", "z has no meaning here"),
    # geometry
    ("max: [1.0, 2.0]", "max: [1.0, -2.0]", "fluids.water.shape.max", "greater than min"),
    ("spacing: 0.05", "spacing: 1.5", "spacing", "larger than fluids.water.shape, which is 1 m across"),
    ("[0.05, 0.025]", "[0.05, 1.5]", "validation.resolutions.1", "larger than fluids.water.shape"),
    ("quick: [0.05]", "quick: [1.5]", "validation.quick.0", "larger than fluids.water.shape"),
    ("spacing: 0.05", "spacing: 1e-6", "spacing", "2e+12 particles"),
    (BOX, "{type: plane, point: [0, 0], normal: [0, 1]}", "fluids.water.shape", "without end"),
    ("kill_box: {min: [-1.0, -1.0]", "kill_box: {min: [6.0, -1.0]",
     "domain.kill_box.max", "greater than min"),
    ("kill_box: {min: [-1.0, -1.0]", "kill_box: {min: [0.5, -1.0]", "domain.kill_box", "removed at once"),
    ("periodic: {}", "periodic: {x: [1.0, 0.0]}", "domain.periodic.x", "not below high"),
    ("periodic: {}", "periodic: {x: [0.9, 1.0]}", "domain.periodic.x", "too short for the neighbour search"),
    # walls
    ("open: [y_max]", "open: [x_min, x_max, y_min, y_max]", "boundaries.tank.open", "no wall is left"),
    ("side: outside", "side: outside\n    layers: 0", "boundaries.tank.layers", "too small"),
    (MOTION, "{type: sinusoid, frequency: 1.0}", "boundaries.tank.motion.0", "needs a translation"),
    # names
    ("  tank:\n", "  water:\n", "boundaries.water", "a fluid has the name 'water' already"),
    ("axis: x, fluid: water", "axis: x, fluid: wator", "probes.front.fluid", "did you mean 'water'?"),
    ("force, boundary: tank", "force, boundary: tnk", "probes.load.boundary", "did you mean 'tank'?"),
    ("set: water", "set: tank", "references.pressure.set", "there is no fluid 'tank'"),
    ("column: front.position[m]", "column: front.x[m]",
     "references.front.column", "no probe column 'front.x[m]'"),
    ("column: energy.kinetic[J/m]", "column: energy.kinetic[J]", "references.energy.column", "did you mean"),
    ("fields: [pressure]", "fields: [pressure, pressure]", "probes.middle.fields.1", "already"),
    ("fields: [velocity, pressure]", "fields: [velocity, velocity]", "output.fields.1", "already"),
    # references
    ("value: [1.0, 1.1]", "value: [1.0]", "references.front.table.value", "1 values for 2 times"),
    ("value: [1.0, 1.1]", "value: [1.0, 0.0]", "references.front.table.value", "relative to the value 0"),
    ("time: [0.1, 0.2]", "time: [0.2, 0.1]", "references.front.table.time", "do not increase"),
    ("bound: 0.03", "bound: -0.03", "references.front.bound", "too small"),
    ("high: 0.5", "high: 0.5\n    low: 1.0", "references.energy.low", "low is above high"),
    ("window: [1.0, 2.0]", "window: [2.0, 1.0]", "references.energy.window", "ends before it begins"),
    ("1000*9.81*(2.0-y)", "1000*9.81*(2.0-h)",
     "references.pressure.expression", "h is not one of x, y, z, t"),
    ("set: {time.end: 1.0}", "set: {time.ned: 1.0}", "time.ned", "unknown key 'ned'"),
    ("set: {time.end: 1.0}", "set: {time.end: -1.0}", "time.end", "too small"),
]  # fmt: skip

TOGETHER = [
    (["numerics.viscosity={type: laminar}", "fluids.water.kinematic_viscosity=0"],
     "fluids.water.kinematic_viscosity", "laminar viscosity needs it"),
    (["numerics.viscosity={type: none}", "boundaries.tank.slip=no_slip"],
     "boundaries.tank.slip", "without viscosity cannot stick"),
    (["numerics.sound_speed=20", "fluids.water.velocity=[30, 0]"],
     "fluids.water.velocity", "not below the sound speed"),
    (["numerics.sound_speed=20", "numerics.expected_speed=2"],
     "numerics.expected_speed", "no effect beside a given sound_speed"),
    (["gravity=[0, 0]", "fluids.water.pressure.surface=2.0", "probes.height.axis=y"],
     "fluids.water.pressure.surface", "without gravity"),
    (["gravity=[1, -9]"], "probes.height.axis", "does not point along an axis"),
    (["domain.periodic={x: [0.5, 3]}"], "fluids.water.shape", "out of the period"),
    ([f"fluids.water.shape={{type: intersection, shapes: {APART}}}"], "spacing", "0 m across"),
    (["fluids.oil={shape: {type: box, min: [2, 0], max: [3, 1]}, density: 900, kinematic_viscosity: 1e-6}"],
     "fluids.oil.density", "one phase"),
    (["boundaries.tank.shape={type: sphere, center: [2, 1], radius: 3}"],
     "boundaries.tank.open", "a sphere has no faces"),
    (["boundaries.tank.side=solid"], "boundaries.tank.open", "a solid has no faces"),
    (["references.energy.high=null"], "references.energy", "neither low nor high"),
    (["fluids={}"], "fluids", "neither fluids nor structures"),
    (["output.fields=[wall_shear_stress]", "numerics.viscosity={type: artificial}"],
     "output.fields", "which artificial does not know"),
    (["output.fields=[wall_shear_stress]", "numerics.viscosity={type: laminar}"],
     "output.fields", "nothing is sheared"),
    (["output.fields=[age]"], "output.fields", "no open boundaries"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "key", "reason"), NONSENSE)
def test_nonsense_is_refused_at_its_line(old: str, new: str, key: str, reason: str) -> None:
    text, line = changed(old, new)
    problems = {problem.key: problem for problem in problems_of(text)}
    assert key in problems
    assert reason in problems[key].message
    assert problems[key].allowed
    assert problems[key].line == line


@pytest.mark.parametrize(("overrides", "key", "reason"), TOGETHER)
def test_values_that_do_not_go_together_are_refused(overrides: list[str], key: str, reason: str) -> None:
    problems = {problem.key: problem for problem in problems_of(DAM_BREAK, overrides)}
    assert key in problems
    assert reason in problems[key].message
    assert problems[key].allowed


def test_one_nonsense_is_one_problem() -> None:
    text, _ = changed("spacing: 0.05", "spacing: 1.5")
    assert len(problems_of(text)) == 1


def test_a_scene_from_python_is_checked_as_one_from_a_file() -> None:
    scene = scene_from_yaml(DAM_BREAK)
    data = {name: getattr(scene, name) for name in Scene.model_fields}
    with pytest.raises(ValidationError, match="larger than fluids"):
        Scene(**data | {"spacing": 1.5})


def test_a_name_whose_object_is_refused_still_counts_as_known() -> None:
    text, _ = changed("side: outside", "side: outsid")
    assert [problem.key for problem in problems_of(text)] == ["boundaries.tank.side"]


def test_support_radius_is_that_of_the_kernel() -> None:
    scene = scene_from_yaml(DAM_BREAK, overrides=["numerics.h_over_dp=2.0"])
    assert scene.support_radius == pytest.approx(2.0 * 2.0 * 0.05)
    assert Numerics().support_over_h == 2.0


@pytest.mark.parametrize(("length", "too_short"), [(0.51, True), (0.52, False)])
def test_a_period_below_three_search_radii_is_refused(length: float, too_short: bool) -> None:
    # The search would meet the same cell from both sides and lose pairs. 3 * 1.15 * 2 h = 0.5175 m here.
    problems = problems_of(DAM_BREAK, [f"domain.periodic={{x: [0.0, {length}]}}"])
    assert any("neighbour search" in problem.message for problem in problems) == too_short
