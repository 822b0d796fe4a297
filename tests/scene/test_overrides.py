"""Overrides: values beside the file obey the rules of the file, and their problems name the override."""

import pytest
from scene_texts import DAM_BREAK, problems_of

from warpsph.scene import load_scene, scene_from_yaml
from warpsph.scene.fluid_models import FourtakasDiffusion, LaminarViscosity
from warpsph.scene.shapes import Sphere


def test_values_are_read_as_yaml() -> None:
    scene = scene_from_yaml(
        DAM_BREAK,
        overrides=[
            "spacing=2.5e-2",
            "fluids.water.velocity=[0, x*y]",
            "numerics.viscosity={type: laminar}",
            "boundaries.tank.motion=[]",
            "domain.kill_box=null",
            "output.hdf5=true",
            "description=a = b",
        ],
    )
    assert scene.spacing == 0.025
    assert scene.fluids["water"].velocity == (0.0, "x*y")
    assert scene.numerics.viscosity == LaminarViscosity()
    assert scene.boundaries["tank"].motion == ()
    assert scene.domain.kill_box is None
    assert scene.output.hdf5 is True
    assert scene.description == "a = b"


def test_items_of_lists_are_reached_by_their_index() -> None:
    scene = scene_from_yaml(
        DAM_BREAK, overrides=["fluids.water.shape.max.1=1.5", "boundaries.tank.motion.0.frequency=2"]
    )
    assert scene.fluids["water"].shape.max == (1.0, 1.5)
    assert scene.boundaries["tank"].motion[0].frequency == 2.0


def test_a_key_below_a_default_keeps_the_type_of_the_default() -> None:
    scene = scene_from_yaml(DAM_BREAK, overrides=["numerics.density_diffusion.delta=0.2"])
    assert scene.numerics.density_diffusion == FourtakasDiffusion(delta=0.2)


def test_a_new_object_may_be_built_key_by_key() -> None:
    overrides = [
        "boundaries.ball.shape={type: sphere, radius: 0.3}",
        "boundaries.ball.shape.center=[2, 1]",
        "boundaries.ball.side=inside",
    ]
    scene = scene_from_yaml(DAM_BREAK, overrides=overrides)
    assert scene.boundaries["ball"].shape == Sphere(center=(2.0, 1.0), radius=0.3)


def test_the_later_override_wins() -> None:
    assert scene_from_yaml(DAM_BREAK, overrides=["spacing=0.1", "spacing=0.2"]).spacing == 0.2


@pytest.mark.parametrize(
    ("override", "key", "message"),
    [
        ("time.ned=3", "time.ned", "did you mean 'end'?"),
        ("tim.end=3", "tim", "did you mean 'time'?"),
        ("fluids.water.density=-1", "fluids.water.density", "too small"),
        ("time.frame_rate=1e6", "time.frame_rate", "need 2e+06 frames"),
        ("fluids.water.shape.max.2=1", "fluids.water.shape.max.2", "no such item"),
        ("fluids.water.shape.max.top=1", "fluids.water.shape.max.top", "no such item"),
        ("boundaries.tank.open.0.x=1", "boundaries.tank.open.0.x", "is no mapping"),
        ("spacing.x=1", "spacing.x", "is no mapping"),
        ("spacing", "", "no override"),
        ("=1", "", "no override"),
        ("time..end=1", "", "no override"),
        ("spacing=[", "", "not valid YAML"),
        ("numerics={kernel: a, kernel: b}", "kernel", "already"),
    ],
)
def test_a_wrong_override_is_refused_by_its_name(override: str, key: str, message: str) -> None:
    problem = problems_of(DAM_BREAK, [override])[0]
    assert problem.file == f"--set {override}"
    assert problem.line is None
    assert problem.key == key
    assert message in problem.message


def test_all_wrong_overrides_are_reported_at_once() -> None:
    assert len(problems_of(DAM_BREAK, ["spacing.x=1", "time..end=1", "output.fields.9=mass"])) == 3


def test_a_single_override_may_stand_without_a_list() -> None:
    assert load_scene("dam_break_2d", "spacing=0.1").spacing == 0.1
