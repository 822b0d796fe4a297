"""Motions refuse what would not move the body as said."""

from typing import Any

import pytest
from pydantic import TypeAdapter, ValidationError

from warpsph.scene.motion import Motion

MOTION: TypeAdapter[Any] = TypeAdapter(Motion)
SWING = {"type": "sinusoid", "rotation": 4.0, "frequency": 1.0}
TABLE = {"type": "table", "file": "gate.csv", "time": "t"}


@pytest.mark.parametrize(
    ("spec", "reason"),
    [
        ({"type": "sinusoid", "frequency": 1.0}, "a translation, a rotation, or both"),
        (SWING, "a rotation needs its center"),
        ({**SWING, "center": [0.0, 0.0], "axis": [0.0, 0.0, 0.0]}, "axis must not be zero"),
        ({**SWING, "center": [0.0, 0.0], "frequency": 0.0}, "greater than 0"),
        (
            {"type": "sinusoid", "translation": [1.0, 0.0], "frequency": 1.0, "center": [0.0, 0.0]},
            "no effect without a rotation",
        ),
        ({"type": "linear", "velocity": [1.0, 0.0], "start": 2.0, "end": 1.0}, "greater than start = 2"),
        ({"type": "rotation", "rate": 1.0}, "a rotation needs its center"),
        (TABLE, "for a translation, for a rotation, or for both"),
        ({**TABLE, "translation": {}}, "at least 1 item"),
        ({**TABLE, "rotation": "angle"}, "a rotation needs its center"),
        ({**TABLE, "translation": {"x": "x"}, "interpolation": "nearest"}, "'cubic' or 'linear'"),
    ],
)
def test_motions_that_say_too_little_or_too_much(spec: dict[str, Any], reason: str) -> None:
    with pytest.raises(ValidationError) as refused:
        MOTION.validate_python(spec)
    assert reason in str(refused.value)


@pytest.mark.parametrize(
    ("spec", "dimension", "keys"),
    [
        ({**SWING, "center": [0.0, 0.0]}, 2, []),
        ({**SWING, "center": [0.0, 0.0, 0.0]}, 3, ["axis"]),
        ({**SWING, "center": [0.0, 0.0], "axis": [0.0, 0.0, 1.0]}, 2, ["axis"]),
        ({"type": "linear", "velocity": [1.0, 0.0]}, 2, []),
        ({**TABLE, "translation": {"x": "x", "z": "z"}}, 2, ["translation.z"]),
        ({**TABLE, "translation": {"x": "x", "z": "z"}}, 3, []),
    ],
)
def test_motions_out_of_their_dimension_are_named_by_key(
    spec: dict[str, Any], dimension: int, keys: list[str]
) -> None:
    assert [problem.key for problem in MOTION.validate_python(spec).dimension_problems(dimension)] == keys
