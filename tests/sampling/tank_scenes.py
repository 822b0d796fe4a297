"""Tanks and obstacles of every kind, filled with water."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from warpsph.scene.schema import Scene

Spec = dict[str, Any]

BED = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.6], [2.0, 1.2], [0.0, 1.2]]


def make_scene(spacing: float, fluids: Spec, boundaries: Spec, *, dimension: int, **more: Any) -> Scene:
    """A scene of fluids of the given shapes, with gravity along the last axis."""
    base = {
        "name": "test",
        "dimension": dimension,
        "spacing": spacing,
        "gravity": [0.0] * (dimension - 1) + [-9.81],
        "time": {"end": 1.0, "frame_rate": 10.0},
        "fluids": {name: {"shape": shape, "density": 1000.0} for name, shape in fluids.items()},
        "boundaries": boundaries,
    }
    return Scene.model_validate(base | more)


def box(low: list[float], high: list[float]) -> Spec:
    return {"type": "box", "min": low, "max": high}


def sphere(center: list[float], radius: float) -> Spec:
    return {"type": "sphere", "center": center, "radius": radius}


def cut(*shapes: Spec) -> Spec:
    return {"type": "intersection", "shapes": list(shapes)}


def united(*shapes: Spec) -> Spec:
    return {"type": "union", "shapes": list(shapes)}


def without(base: Spec, *shapes: Spec) -> Spec:
    return {"type": "difference", "base": base, "subtract": list(shapes)}


def turned(shape: Spec, angle: float, **rotation: Any) -> Spec:
    return {"type": "transform", "shape": shape, "rotate": {"angle": angle, **rotation}}


def box_tank(spacing: float = 0.05) -> Scene:
    tank = {"shape": box([0.0, 0.0], [2.0, 1.5]), "side": "outside", "open": ["y_max"]}
    return make_scene(spacing, {"water": box([0.0, 0.0], [0.5, 1.0])}, {"tank": tank}, dimension=2)


def box_tank_3d(spacing: float = 0.1) -> Scene:
    tank = {"shape": box([0.0, 0.0, 0.0], [1.0, 0.5, 1.0]), "side": "outside", "open": ["z_max"]}
    return make_scene(spacing, {"water": box([0.0, 0.0, 0.0], [0.5, 0.5, 0.5])}, {"tank": tank}, dimension=3)


def sloping_bed(spacing: float = 0.05) -> Scene:
    bed = {"type": "polygon", "points": BED}
    water = cut(bed, box([0.0, 0.0], [2.0, 0.9]))
    return make_scene(spacing, {"water": water}, {"tank": {"shape": bed, "side": "outside"}}, dimension=2)


def sloping_bed_3d(spacing: float = 0.1) -> Scene:
    bed = {"type": "extrusion", "points": BED, "axis": "y", "low": 0.0, "high": 0.5}
    water = cut(bed, box([0.0, 0.0, 0.0], [2.0, 0.5, 0.9]))
    return make_scene(spacing, {"water": water}, {"tank": {"shape": bed, "side": "outside"}}, dimension=3)


def disc_obstacle(spacing: float = 0.05, side: str = "inside") -> Scene:
    disc = sphere([1.0, 0.5], 0.3)
    boundaries = {
        "tank": {"shape": box([0.0, 0.0], [2.0, 1.5]), "side": "outside", "open": ["y_max"]},
        "disc": {"shape": disc, "side": side},
    }
    water = without(box([0.0, 0.0], [2.0, 0.9]), disc)
    return make_scene(spacing, {"water": water}, boundaries, dimension=2)


def ball_obstacle(spacing: float = 0.08) -> Scene:
    ball = sphere([0.48, 0.48, 0.4], 0.25)
    boundaries = {
        "tank": {"shape": box([0.0, 0.0, 0.0], [0.96, 0.96, 0.96]), "side": "outside"},
        "ball": {"shape": ball, "side": "inside"},
    }
    water = without(box([0.0, 0.0, 0.0], [0.96, 0.96, 0.8]), ball)
    return make_scene(spacing, {"water": water}, boundaries, dimension=3)


def l_shaped_tank(spacing: float = 0.05) -> Scene:
    tank = united(box([0.0, 0.0], [1.0, 1.5]), box([1.0, 0.0], [2.0, 0.5]))
    water = united(box([0.0, 0.0], [1.0, 0.8]), box([1.0, 0.0], [2.0, 0.5]))
    return make_scene(spacing, {"water": water}, {"tank": {"shape": tank, "side": "outside"}}, dimension=2)


def cylinder_tank(spacing: float = 0.06) -> Scene:
    tank = {"type": "cylinder", "start": [0.0, 0.0, 0.0], "end": [0.0, 0.0, 0.9], "radius": 0.5}
    water = {**tank, "end": [0.0, 0.0, 0.6]}
    return make_scene(spacing, {"water": water}, {"tank": {"shape": tank, "side": "outside"}}, dimension=3)


def bowl(spacing: float = 0.05) -> Scene:
    ball = sphere([0.0, 0.0, 0.0], 0.5)
    tank = cut(ball, box([-1.0, -1.0, -1.0], [1.0, 1.0, 0.2]))
    water = cut(ball, box([-1.0, -1.0, -1.0], [1.0, 1.0, -0.1]))
    return make_scene(spacing, {"water": water}, {"tank": {"shape": tank, "side": "outside"}}, dimension=3)


def rolled_tank(spacing: float = 0.05) -> Scene:
    tank = turned(box([0.0, 0.0], [2.0, 1.0]), 17.0, center=[1.0, 0.5])
    water = cut(tank, box([-2.0, -2.0], [4.0, 0.6]))
    return make_scene(spacing, {"water": water}, {"tank": {"shape": tank, "side": "outside"}}, dimension=2)


def stadium_with_tower(spacing: float = 0.05) -> Scene:
    tank = united(box([0.0, 0.0], [1.5, 1.0]), sphere([1.5, 0.5], 0.5))
    tower = united(sphere([0.8, 0.6], 0.2), box([0.7, 0.0], [0.9, 0.5]))
    boundaries = {"tank": {"shape": tank, "side": "outside"}, "tower": {"shape": tower, "side": "solid"}}
    return make_scene(spacing, {"water": without(tank, tower)}, boundaries, dimension=2)


def tilted_floor(spacing: float = 0.05) -> Scene:
    floor = {"type": "plane", "point": [0.0, 0.0], "normal": [-0.3, 1.0]}
    bounded = {**floor, "bounds": {"min": [-0.3, -1.0], "max": [2.3, 1.0]}}
    water = without(box([0.0, 0.0], [2.0, 1.0]), floor)
    return make_scene(spacing, {"water": water}, {"floor": {"shape": bounded, "side": "inside"}}, dimension=2)


TANKS: dict[str, Callable[[], Scene]] = {
    make.__name__: make
    for make in (
        box_tank,
        box_tank_3d,
        sloping_bed,
        sloping_bed_3d,
        disc_obstacle,
        ball_obstacle,
        l_shaped_tank,
        cylinder_tank,
        bowl,
        rolled_tank,
        stadium_with_tower,
        tilted_floor,
    )
}
