"""Open boundaries that cannot be: what is said of them, and where."""

from __future__ import annotations

from typing import Any

import pytest
from open_boundary_builders import channel, pipe

from warpsph.sampling import sample
from warpsph.scene import Scene, SceneError
from warpsph.scene.loader import scene_from_yaml


def changed(scene: Scene, changes: dict[str, Any]) -> Scene:
    """The scene with some values, by their keys with dots, replaced; read as from a file."""
    import json

    data = json.loads(scene.model_dump_json())
    for key, value in changes.items():
        *path, last = key.split(".")
        node = data
        for name in path:
            node = node[name]
        node[last] = value
    return scene_from_yaml(json.dumps(data))


def problems(make: Any) -> dict[str, str]:
    """Message of each problem by its key."""
    with pytest.raises(SceneError) as caught:
        make()
    return {problem.key: problem.message for problem in caught.value.problems}


INLET = "open_boundaries.inlet"
BALANCE = {
    "type": "volume_balance",
    "walls": [{"structure": "plate", "start": [0.0, 0.0], "end": [2.0, 0.0]}],
}


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        ({f"{INLET}.shape.normal": [0.0, 0.0]}, f"{INLET}.shape.normal", "must not be zero"),
        ({f"{INLET}.shape.width": None}, f"{INLET}.shape", "needs one of width"),
        ({f"{INLET}.shape.normal": [1.0, 0.0, 0.0]}, f"{INLET}.shape.normal", "3 components"),
        ({f"{INLET}.fluid": "oil"}, f"{INLET}.fluid", "there is no fluid 'oil'"),
        ({"domain.periodic": {"x": [-1.0, 3.0]}}, f"{INLET}.shape.normal", "periodic axis"),
        ({f"{INLET}.velocity": {"type": "parabolic"}}, f"{INLET}.velocity", "its mean, or its flow_rate"),
        ({f"{INLET}.history": "x"}, f"{INLET}.history", "x has no meaning here"),
        (
            {f"{INLET}.velocity": {"type": "expression", "value": ["z", 0.0]}},
            f"{INLET}.velocity.value.0",
            "z has no meaning here",
        ),
        ({"numerics.density": "summation"}, "numerics.density", "ends at the far end"),
        ({"probes": {"q": {"type": "flux", "patch": "inlte"}}}, "probes.q.patch", "did you mean 'inlet'"),
        ({"probes": {"q": BALANCE}}, "probes.q.walls.0.structure", "there is no structure 'plate'"),
        ({"probes": {"q": BALANCE}, "open_boundaries": {}}, "probes.q.type", "no open boundary"),
    ],
)
def test_what_is_wrong_is_said_at_its_place(changes: dict[str, Any], key: str, words: str) -> None:
    found = problems(lambda: changed(channel(), changes))
    matching = [message for at, message in found.items() if at.startswith(key)]
    assert any(words in message for message in matching), found


def test_a_segment_is_no_patch_in_space() -> None:
    changes = {f"{INLET}.shape.size": None, f"{INLET}.shape.width": 1.0}
    assert "rectangle or a disc" in problems(lambda: changed(pipe(), changes))[f"{INLET}.shape.width"]


def test_walls_have_to_go_on_beside_the_buffer() -> None:
    short = {"type": "box", "min": (-0.1, 0.0), "max": (3.5, 1.0)}
    walls = {"plates": {"shape": short, "side": "outside", "open": ("x_min", "x_max")}}
    found = problems(lambda: sample(channel(boundaries=walls)))
    assert "does not go on behind it" in found[f"{INLET}.shape"]


def test_a_wall_in_the_buffer_closes_it() -> None:
    closed = {"type": "box", "min": (0.0, 0.0), "max": (3.5, 1.0)}
    walls = {"plates": {"shape": closed, "side": "outside", "open": ("x_max",)}}
    assert "stands in its buffer" in problems(lambda: sample(channel(boundaries=walls)))[f"{INLET}.shape"]


def test_buffers_do_not_lie_in_each_other() -> None:
    found = problems(lambda: sample(changed(channel(), {"open_boundaries.outlet.shape.center": [-0.2, 0.5]})))
    assert "lies in that of 'inlet'" in found["open_boundaries.outlet.shape"]


def test_a_history_that_is_not_there_is_named() -> None:
    found = problems(lambda: _laws(changed(channel(), {f"{INLET}.history": {"file": "no.csv"}})))
    assert any("no.csv" in message for message in found.values())


def _laws(scene: Scene) -> None:
    from warpsph.sampling.patch_laws import patch_laws

    patch_laws(scene)
