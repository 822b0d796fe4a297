"""Force coefficients are forces over dynamic pressure and area, along directions that the scene chooses."""

import numpy as np
import pytest
from particles import DENSITY, frame_of, lattice, probe_of, scene_with, wall
from pydantic import ValidationError

BODY = {"type": "force_coefficients", "boundaries": ["tank"], "speed": 2.0, "length": 0.5}


def evaluate(dimension=2, **changes):
    probe = probe_of(scene_with(BODY | changes, dimension))
    random = np.random.default_rng(3)
    position, force, viscous = random.normal(size=(3, 40, dimension))
    frame = frame_of(wall(position, force=force, viscous_force=viscous))
    probe.start(frame)
    values = dict(zip((c.removeprefix("probe.") for c in probe.columns), probe.evaluate(frame), strict=True))
    return values, position, force, viscous


def test_coefficients_in_the_plane():
    """c = 2 F / (rho U^2 L), moments over another L about the centre of mass."""
    values, position, force, viscous = evaluate()
    scale = 0.5 * DENSITY * 2.0**2 * 0.5
    arm = position - position.mean(axis=0)
    moment = (arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]).sum()
    assert values["drag[1]"] == pytest.approx(force[:, 0].sum() / scale)
    assert values["lift[1]"] == pytest.approx(force[:, 1].sum() / scale)
    assert values["moment[1]"] == pytest.approx(moment / scale / 0.5)
    assert values["viscous_drag[1]"] == pytest.approx(viscous[:, 0].sum() / scale)
    assert values["viscous_lift[1]"] == pytest.approx(viscous[:, 1].sum() / scale)
    assert values["drag_force[N/m]"] == pytest.approx(force[:, 0].sum())


def test_directions_of_any_length_turn_drag_and_lift():
    values, position, force, _ = evaluate(drag=[3.0, 4.0], lift=[-8.0, 6.0], density=10.0, about=[1.0, 2.0])
    scale = 0.5 * 10.0 * 2.0**2 * 0.5
    total, arm = force.sum(axis=0), position - np.array([1.0, 2.0])
    assert values["drag[1]"] == pytest.approx(total @ [0.6, 0.8] / scale)
    assert values["lift[1]"] == pytest.approx(total @ [-0.8, 0.6] / scale)
    moment = (arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]).sum()
    assert values["moment[1]"] == pytest.approx(moment / scale / 0.5)


def test_in_space_the_area_is_length_times_span_and_the_moment_is_about_drag_cross_lift():
    values, position, force, _ = evaluate(3, span=0.2, drag=[0.0, 0.0, 1.0], lift=[1.0, 0.0, 0.0])
    scale = 0.5 * DENSITY * 2.0**2 * 0.5 * 0.2
    moment = np.cross(position - position.mean(axis=0), force).sum(axis=0)[1]
    assert values["drag[1]"] == pytest.approx(force[:, 2].sum() / scale)
    assert values["moment[1]"] == pytest.approx(moment / scale / 0.5)


def test_evaluation_before_the_start_is_refused():
    probe = probe_of(scene_with(BODY))
    with pytest.raises(ValueError, match="start"):
        probe.evaluate(frame_of(wall(lattice([0.0, 0.0], [1.0, 1.0]))))


@pytest.mark.parametrize(
    ("changes", "key", "message"),
    [
        ({"boundaries": []}, "boundaries", "no body"),
        ({"boundaries": ["tnak"]}, "boundaries.0", "did you mean 'tank'"),
        ({"boundaries": ["tank", "tank"]}, "boundaries.1", "already"),
        ({"structures": ["beam"]}, "structures.0", "no structure"),
        ({"lift": [1.0, 1.0]}, "lift", "not perpendicular"),
        ({"drag": [0.0, 0.0]}, "drag", "no direction"),
        ({"span": 1.0}, "span", "not over a span"),
    ],
)
def test_what_makes_no_sense_is_refused(changes, key, message):
    with pytest.raises(ValidationError) as caught:
        scene_with(BODY | changes)
    assert f"probes.probe.{key}: " in str(caught.value)
    assert message in str(caught.value)


def test_space_needs_a_span():
    with pytest.raises(ValidationError, match="over a span"):
        scene_with(BODY, 3)
