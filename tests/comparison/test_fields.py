"""Field references: which frames they take, and the norms over particles and times."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from compared_scenes import tank_with

from warpsph.comparison.compare import Comparison, compare_run, field_samples, fields_needed
from warpsph.frame import Frame, SetFrame
from warpsph.scene import Scene

NO_PROBES = {"time[s]": np.array([0.0, 2.0])}


def frame_at(time: float, **fields: np.ndarray) -> Frame:
    y = np.linspace(0.05, 0.95, 10)
    position = np.column_stack([np.full_like(y, 0.5), y])
    water = SetFrame("water", "fluid", {"position": position, **fields})
    return Frame(round(10 * time), time, 2, 0.1, (water,))


def hydrostatic(factor: float = 1.0) -> np.ndarray:
    return factor * 9810.0 * (1.0 - np.linspace(0.05, 0.95, 10))


def scene_with(**reference: Any) -> Scene:
    default = {
        "type": "field",
        "set": "water",
        "field": "pressure",
        "expression": "9810*(1-y)",
        "relative_to": 9810.0,
    }
    return tank_with(field={**default, **reference})


def row_of(scene: Scene, *frames: Frame) -> Comparison:
    samples = [sample for frame in frames for sample in field_samples(scene, frame)]
    (row,) = compare_run(scene, NO_PROBES, samples)
    return row


def test_exact_field_has_no_error() -> None:
    row = row_of(scene_with(bound=1e-12), frame_at(2.0, pressure=hydrostatic()))
    assert row.holds is True
    assert row.compared == "water.pressure"


def test_max_norm_finds_the_worst_particle() -> None:
    pressure = hydrostatic()
    pressure[3] += 981.0
    row = row_of(scene_with(), frame_at(2.0, pressure=pressure))
    assert row.error == pytest.approx(0.1)
    assert row.value - row.reference == pytest.approx(981.0)


def test_rms_norm_over_particles_and_times() -> None:
    """A uniform offset of 0.3 at one time and 0.4 at the other: sqrt((0.3^2 + 0.4^2)/2)."""
    scene = scene_with(norm="rms", at=[1.0, 2.0])
    frames = [frame_at(t, pressure=hydrostatic() + 9810.0 * e) for t, e in ((1.0, 0.3), (2.0, 0.4))]
    assert row_of(scene, *frames).error == pytest.approx(math.sqrt((0.3**2 + 0.4**2) / 2))


def test_only_the_frame_nearest_to_the_asked_time_counts() -> None:
    scene = scene_with(at=[1.04], bound=1e-9)
    frames = [frame_at(t, pressure=hydrostatic(f)) for t, f in ((0.9, 5.0), (1.0, 1.0), (1.1, 5.0))]
    assert [len(field_samples(scene, frame)) for frame in frames] == [0, 1, 0]
    assert row_of(scene, *frames).holds is True


def test_time_stands_in_the_expression() -> None:
    scene = scene_with(expression="100*t + x", at=[1.0], bound=1e-9)
    assert row_of(scene, frame_at(1.0, pressure=np.full(10, 100.5))).holds is True


def test_velocity_component_is_taken_from_the_vector() -> None:
    scene = scene_with(field="velocity_y", expression="0.5", relative_to=1.0, bound=1e-12)
    velocity = np.tile([9.0, 0.5], (10, 1))
    assert fields_needed(scene) == {"velocity"}
    assert row_of(scene, frame_at(2.0, velocity=velocity)).holds is True


def test_missing_frame_never_holds() -> None:
    row = row_of(scene_with(bound=10.0), frame_at(1.0, pressure=hydrostatic()))
    assert row.holds is False
    assert row.note == "no value at t = 2 s"


def test_particle_that_is_no_number_never_holds() -> None:
    pressure = hydrostatic()
    pressure[0] = np.nan
    for norm in ("max", "rms"):
        assert row_of(scene_with(norm=norm, bound=10.0), frame_at(2.0, pressure=pressure)).holds is False


def test_set_without_particles_never_holds() -> None:
    empty = SetFrame("water", "fluid", {"position": np.zeros((0, 2)), "pressure": np.zeros(0)})
    assert row_of(scene_with(bound=10.0), Frame(20, 2.0, 2, 0.1, (empty,))).holds is False
