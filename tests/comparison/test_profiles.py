"""Profile references: interpolation along a line against a table; and errors relative to the peak."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from compared_scenes import tank_with

from warpsph.comparison.compare import Comparison, compare_run, field_samples, fields_needed
from warpsph.frame import Frame, SetFrame
from warpsph.scene import Scene, SceneError

NO_PROBES = {"time[s]": np.array([0.0, 2.0])}
TABLE = {"position": [0.2, 0.45, 0.8], "value": [1.4, 1.9, 2.6]}


def water(slope: float) -> Frame:
    """A tank of disordered water in which velocity_x = 1 + slope y."""
    x, y = np.meshgrid(np.arange(0.05, 1.0, 0.1), np.arange(0.05, 1.0, 0.1))
    position = np.column_stack([x.ravel(), y.ravel()])
    position += 0.02 * np.random.default_rng(0).uniform(-1.0, 1.0, position.shape)
    velocity = np.column_stack([1.0 + slope * position[:, 1], np.zeros(len(position))])
    fields = {"position": position, "velocity": velocity}
    constant = {"density": np.full(len(position), 1000.0), "mass": np.full(len(position), 10.0)}
    return Frame(20, 2.0, 2, 0.1, (SetFrame("water", "fluid", fields | constant),))


def scene_with(base: Path | None = None, **changes: Any) -> Scene:
    reference = {"type": "profile", "field": "velocity_x", "through": [0.5, 0.0], "axis": "y", "table": TABLE}
    return tank_with(base, profile=reference | changes)


def row_of(scene: Scene, frame: Frame) -> Comparison:
    (row,) = compare_run(scene, NO_PROBES, field_samples(scene, frame))
    return row


def test_linear_field_is_exact_on_disordered_particles() -> None:
    row = row_of(scene_with(bound=1e-9), water(2.0))
    assert row.holds is True
    assert row.compared == "velocity_x along y"


def test_errors_are_relative_to_the_peak_of_the_profile() -> None:
    row = row_of(scene_with(relative_to="peak"), water(3.0))
    # 1 + 3 y against 1 + 2 y: the largest difference 0.8 at y = 0.8, over the peak 2.6
    assert row.error == pytest.approx(0.8 / 2.6, rel=1e-9)


def test_the_points_of_the_profile_are_kept() -> None:
    (sample,) = row_of(scene_with(), water(3.0)).samples
    expected = [[y, 1.0 + 3.0 * y, 1.0 + 2.0 * y] for y in TABLE["position"]]
    np.testing.assert_allclose(sample.as_record()["points"], expected, rtol=1e-9)
    (dry,) = row_of(scene_with(through=[2.5, 0.0]), water(2.0)).samples
    assert dry.as_record()["points"][0] == [0.2, None, 1.4]


def test_a_dry_point_is_no_number() -> None:
    assert row_of(scene_with(bound=1.0, through=[2.5, 0.0]), water(2.0)).holds is False


def test_frames_carry_what_the_interpolation_needs() -> None:
    assert fields_needed(scene_with()) == {"velocity", "density", "mass", "volume"}


def test_table_in_a_file(tmp_path: Path) -> None:
    (tmp_path / "profile.csv").write_text("# half scale\ns,u\n0.1,0.7\n0.4,1.3\n")
    table = {"file": "profile.csv", "position": "s", "value": "u", "position_scale": 2.0, "value_scale": 2.0}
    assert row_of(scene_with(tmp_path, table=table, bound=1e-9), water(2.0)).holds is True


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"field": "velocity_z"}, "field"),
        ({"axis": "z"}, "axis"),
        ({"table": {"position": [0.1], "value": [1.0, 2.0]}}, "table.value"),
        ({"table": {"position": [0.1], "value": [0.0]}}, "table.value"),
        ({"table": {"file": "missing.csv", "position": "s", "value": "u"}}, "table.file"),
    ],
)
def test_profiles_that_mean_nothing_are_refused(changes: dict[str, Any], key: str) -> None:
    with pytest.raises(SceneError, match=rf"references\.profile\.{key}"):
        scene_with(**changes)
