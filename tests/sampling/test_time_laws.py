"""Time laws of single motions: values by hand, derivatives against differences, tables from files."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import TypeAdapter

from warpsph.sampling.time_laws import Displacement, displacement_of
from warpsph.scene.errors import SceneError
from warpsph.scene.motion import Motion

KEY = "boundaries.gate.motion.0"


def displacement(base: Path | None = None, **spec: Any) -> Displacement:
    return displacement_of(TypeAdapter(Motion).validate_python(spec), base or Path(), KEY)


def write(path: Path, rows: list[tuple[float, ...]], header: str = "t,x,angle") -> Path:
    text = "\n".join([header, *(",".join(map(str, row)) for row in rows)])
    path.write_text(text + "\n", encoding="utf-8")
    return path.parent


def test_sinusoid_starts_where_the_body_is_whatever_its_phase() -> None:
    law = displacement(
        type="sinusoid", translation=[0.2, 0.0], frequency=0.5, phase=90.0, start=1.0
    ).translation
    assert law(0.7) == pytest.approx(np.zeros((3, 3)))
    assert law(1.0)[0] == pytest.approx(np.zeros(3), abs=1e-15)
    assert law(1.0 + 0.5)[0, 0] == pytest.approx(-0.2)
    assert law(1.0 + 1.0)[0, 0] == pytest.approx(-0.4)
    assert law(1.0 + 0.5)[1, 0] == pytest.approx(-0.2 * np.pi)


def test_sinusoid_rotation_by_hand() -> None:
    """4 degrees at 0.25 Hz: full amplitude after one second, at rest there."""
    law = displacement(type="sinusoid", rotation=4.0, center=[0.0, 0.0], frequency=0.25).angle
    omega = 0.5 * np.pi
    assert law(1.0) == pytest.approx(np.deg2rad([4.0, 0.0, -4.0 * omega**2]), abs=1e-12)
    assert law(0.0) == pytest.approx(np.deg2rad([0.0, 4.0 * omega, 0.0]), abs=1e-12)


def test_a_ramp_starts_without_velocity_or_acceleration_and_ends_in_the_sinusoid() -> None:
    spec = {"type": "sinusoid", "translation": [1.0, 0.0], "frequency": 1.3, "phase": 40.0}
    ramped, plain = displacement(**spec, ramp=0.8).translation, displacement(**spec).translation
    assert ramped(1e-6) == pytest.approx(np.zeros((3, 3)), abs=1e-3)
    assert ramped(0.8) == pytest.approx(plain(0.8))
    assert ramped(0.8 - 1e-6) == pytest.approx(plain(0.8), abs=1e-3)


def test_a_sliding_surface_has_a_velocity_and_stays() -> None:
    law = displacement(type="sliding", velocity=[2.0, 0.0], start=1.0, end=3.0).translation
    assert law(2.0) == pytest.approx(np.array([[0.0] * 3, [2.0, 0.0, 0.0], [0.0] * 3]))
    assert law(0.5) == pytest.approx(np.zeros((3, 3)))
    assert law(3.5) == pytest.approx(np.zeros((3, 3)))


def test_linear_motion_runs_from_start_to_end() -> None:
    law = displacement(type="linear", velocity=[0.0, 2.0], start=1.0, end=3.0).translation
    assert law(0.5) == pytest.approx(np.zeros((3, 3)))
    assert law(2.0)[:, 1] == pytest.approx([2.0, 2.0, 0.0])
    assert law(9.0)[:, 1] == pytest.approx([4.0, 0.0, 0.0])


def test_steady_rotation_has_no_end_by_default() -> None:
    law = displacement(type="rotation", rate=90.0, center=[0.0, 0.0]).angle
    assert law(100.0) == pytest.approx([50.0 * np.pi, 0.5 * np.pi, 0.0])


SMOOTH = {
    "sinusoid": {"type": "sinusoid", "translation": [0.3, -0.1], "frequency": 0.7, "phase": 25.0},
    "ramped": {"type": "sinusoid", "rotation": 20.0, "center": [0.0, 0.0], "frequency": 0.7, "ramp": 2.0},
    "linear": {"type": "linear", "velocity": [1.0, 2.0]},
    "table": {
        "type": "table",
        "file": "m.csv",
        "time": "t",
        "translation": {"y": "x"},
        "rotation": "angle",
        "center": [0.0, 0.0],
    },
}


@pytest.mark.parametrize("spec", SMOOTH.values(), ids=SMOOTH)
@pytest.mark.parametrize("time", [0.13, 0.6, 1.1])
def test_derivatives_agree_with_central_differences(
    spec: dict[str, Any], time: float, tmp_path: Path
) -> None:
    """The differences' own error is of the order of their step squared, 1e-6, times the next derivatives."""
    rows = [(t, np.sin(3.0 * t), 30.0 * t**2) for t in np.linspace(0.0, 2.0, 9)]
    motion = displacement(write(tmp_path / "m.csv", rows), **spec)
    step = 1e-3
    for law in (motion.angle, motion.translation):
        before, now, after = law(time - step), law(time), law(time + step)
        assert now[1] == pytest.approx((after[0] - before[0]) / (2.0 * step), abs=2e-4)
        assert now[2] == pytest.approx((after[1] - before[1]) / (2.0 * step), abs=2e-3)


def test_table_passes_through_its_rows_counted_from_time_zero(tmp_path: Path) -> None:
    """Absolute coordinates serve as well as displacements: only the change since time zero counts."""
    rows = [(0.0, 5.0, 10.0), (1.0, 5.5, 20.0), (2.0, 5.2, 5.0), (3.0, 5.0, 0.0)]
    base = write(tmp_path / "gate.csv", rows)
    spec = {"type": "table", "file": "gate.csv", "time": "t", "translation": {"y": "x"}, "rotation": "angle"}
    motion = displacement(base, **spec, center=[1.0, 2.0])
    for time, x, angle in rows:
        assert motion.translation(time)[0] == pytest.approx([0.0, x - 5.0, 0.0])
        assert motion.angle(time)[0] == pytest.approx(np.deg2rad(angle - 10.0))
    assert motion.center == pytest.approx([1.0, 2.0, 0.0])


def test_cubic_table_is_exact_for_a_cubic_and_a_linear_one_for_lines(tmp_path: Path) -> None:
    base = write(tmp_path / "m.csv", [(t, t**3 - t, 0.0) for t in np.linspace(0.0, 3.0, 7)])
    spec = {"type": "table", "file": "m.csv", "time": "t", "translation": {"x": "x"}}
    assert displacement(base, **spec).translation(1.3)[:, 0] == pytest.approx([0.897, 4.07, 7.8])
    straight = displacement(base, **spec, interpolation="linear").translation(0.25)[:, 0]
    assert straight == pytest.approx([-0.1875, -0.75, 0.0])


def test_the_body_rests_outside_the_table(tmp_path: Path) -> None:
    base = write(tmp_path / "m.csv", [(1.0, 2.0, 0.0), (2.0, 3.0, 0.0), (3.0, 5.0, 0.0)])
    law = displacement(base, type="table", file="m.csv", time="t", translation={"x": "x"}).translation
    assert law(0.0) == pytest.approx(np.zeros((3, 3)))
    assert law(0.999) == pytest.approx(np.zeros((3, 3)))
    assert law(10.0)[:, 0] == pytest.approx([3.0, 0.0, 0.0])


@pytest.mark.parametrize(
    ("rows", "header", "reason"),
    [
        (
            [(0.0, 1.0, 0.0), (1.0, 1.0, 0.0), (1.0, 2.0, 0.0)],
            "t,x,angle",
            "does not increase from 1 s to 1 s",
        ),
        ([(0.0, 1.0, 0.0)], "t,x,angle", "one row"),
        ([(0.0, 1.0, 0.0), (1.0, 1.0, 0.0)], "time,x,angle", "no column 't'"),
    ],
)
def test_unusable_tables_are_refused(
    rows: list[tuple[float, ...]], header: str, reason: str, tmp_path: Path
) -> None:
    base = write(tmp_path / "m.csv", rows, header)
    with pytest.raises(SceneError) as refused:
        displacement(base, type="table", file="m.csv", time="t", translation={"x": "x"})
    (problem,) = refused.value.problems
    assert problem.key == f"{KEY}.file"
    assert problem.value == "m.csv"
    assert reason in problem.message


def test_a_missing_table_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="No such file"):
        displacement(tmp_path, type="table", file="gone.csv", time="t", translation={"x": "x"})
