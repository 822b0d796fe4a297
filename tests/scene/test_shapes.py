"""Shapes refuse what is no solid, with the reason, and know where they can stand."""

import math
from typing import Any

import pytest
from pydantic import TypeAdapter, ValidationError

from warpsph.scene.shapes import Shape

SHAPE: TypeAdapter[Any] = TypeAdapter(Shape)
SQUARE = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
BOX = {"type": "box", "min": [0.0, 0.0], "max": [1.0, 1.0]}


@pytest.mark.parametrize(
    ("spec", "reason"),
    [
        ({"type": "box", "min": [0.0, 0.0], "max": [1.0, -2.0]}, "greater than min in y, but -2 <= 0"),
        ({"type": "box", "min": [0.0, 0.0], "max": [1.0, 1.0, 1.0]}, "3 components and min has 2"),
        ({"type": "sphere", "center": [0.0, 0.0], "radius": 0.0}, "greater than 0"),
        ({"type": "cylinder", "start": [1.0, 0.0, 0.0], "end": [1.0, 0.0, 0.0], "radius": 1.0}, "no length"),
        ({"type": "plane", "point": [0.0, 0.0], "normal": [0.0, 0.0]}, "normal must not be zero"),
        (
            {"type": "extrusion", "points": SQUARE, "axis": "z", "low": 1.0, "high": 1.0},
            "greater than low = 1",
        ),
        ({"type": "union", "shapes": []}, "at least 1 item"),
        ({"type": "difference", "base": BOX, "subtract": []}, "at least 1 item"),
        ({"type": "transform", "shape": BOX}, "at least one of scale, rotate and translate"),
        ({"type": "transform", "shape": BOX, "scale": -1.0}, "greater than 0"),
        (
            {"type": "transform", "shape": BOX, "rotate": {"angle": 1.0, "axis": [0, 0, 0]}},
            "must not be zero",
        ),
        ({"type": "blob"}, "does not match any of the expected tags"),
    ],
)
def test_what_is_no_solid_is_refused_with_the_reason(spec: dict[str, Any], reason: str) -> None:
    with pytest.raises(ValidationError) as refused:
        SHAPE.validate_python(spec)
    assert reason in str(refused.value)


@pytest.mark.parametrize(
    ("points", "reason"),
    [
        ([[0, 0], [1, 1], [1, 0], [0, 1]], "edges 0 and 2 meet"),
        ([[0, 0], [2, 0], [2, 2], [1, 0], [0, 2]], "touches itself"),
        ([[0, 0], [2, 0], [1, 0]], "touches itself"),
        ([[0, 0], [1, 0], [1, 0], [1, 1]], "points 1 and 2 coincide"),
        ([[0, 0], [1, 0], [1, 1], [0, 0]], "points 3 and 0 coincide"),
        ([[0, 0], [1, 0]], "at least 3 items"),
    ],
)
def test_polygons_that_are_not_simple_are_refused(points: list[list[float]], reason: str) -> None:
    with pytest.raises(ValidationError) as refused:
        SHAPE.validate_python({"type": "polygon", "points": [[float(x), float(y)] for x, y in points]})
    assert reason in str(refused.value)


@pytest.mark.parametrize("corners", [3, 4, 50, 2000])
@pytest.mark.parametrize("sense", [1, -1])
def test_simple_polygons_of_many_corners_in_either_sense_are_accepted(corners: int, sense: int) -> None:
    def corner(index: int) -> list[float]:
        angle = sense * 2.0 * math.pi * index / corners
        radius = 1.0 + 0.4 * (index % 2)
        return [radius * math.cos(angle), radius * math.sin(angle)]

    SHAPE.validate_python({"type": "polygon", "points": [corner(index) for index in range(corners)]})


def test_a_corner_in_the_middle_of_a_straight_edge_is_no_crossing() -> None:
    SHAPE.validate_python({"type": "polygon", "points": [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 2.0]]})


@pytest.mark.parametrize(
    ("spec", "dimension", "keys"),
    [
        (BOX, 2, []),
        ({"type": "polygon", "points": SQUARE}, 3, ["type"]),
        ({"type": "extrusion", "points": SQUARE, "axis": "x", "low": 0.0, "high": 1.0}, 2, ["type"]),
        ({"type": "cylinder", "start": [0.0] * 3, "end": [1.0] * 3, "radius": 1.0}, 2, ["type"]),
        ({"type": "transform", "shape": BOX, "rotate": {"angle": 1.0}}, 2, []),
        ({"type": "transform", "shape": BOX, "rotate": {"angle": 1.0}}, 3, ["rotate.axis"]),
        (
            {"type": "transform", "shape": BOX, "rotate": {"angle": 1.0, "axis": [0.0, 0.0, 1.0]}},
            2,
            ["rotate.axis"],
        ),
        (
            {
                "type": "difference",
                "base": {"type": "union", "shapes": [BOX, {"type": "polygon", "points": SQUARE}]},
                "subtract": [{"type": "transform", "shape": BOX, "rotate": {"angle": 1.0}}],
            },
            3,
            ["base.shapes.1.type", "subtract.0.rotate.axis"],
        ),
    ],
)
def test_shapes_out_of_their_dimension_are_named_by_key(
    spec: dict[str, Any], dimension: int, keys: list[str]
) -> None:
    problems = SHAPE.validate_python(spec).dimension_problems(dimension)
    assert [problem.key for problem in problems] == keys


def test_every_property_has_a_description() -> None:
    schema = SHAPE.json_schema()
    described = [
        (name, key)
        for name, model in schema["$defs"].items()
        for key, spec in model["properties"].items()
        if key != "type" and "description" not in spec
    ]
    assert described == []
