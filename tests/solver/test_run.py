"""A whole run: its files, going on after an end of any kind, and what it says when it fails."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy as np
import pytest
from builders import still_tank
from open_boundary_builders import channel
from pxr import Usd, UsdGeom

from warpsph.output.checkpoint import CheckpointError, read_checkpoint
from warpsph.output.probes_csv import read_probes
from warpsph.scene.schema import Scene
from warpsph.solver.errors import SimulationDiverged
from warpsph.solver.run import run_scene

PROBES = {"energy": {"type": "energy"}, "level": {"type": "water_level", "at": (0.25,), "axis": "y"}}


def sloshing(end: float = 0.4, **changes) -> Scene:
    """Water that begins to slosh because gravity is tilted."""
    output = {"checkpoint_every": 2, "hdf5": True, "probe_rate": 30.0}
    return still_tank(gravity=(3.0, -9.0), time={"end": end}, output=output, probes=PROBES, **changes)


RECORDED = {
    "statistics": {"min": (0.1, 0.1), "max": (0.4, 0.3), "start": 0.1},
    "paths": {"middle": {"seeds": [(0.25, 0.25), (0.1, 0.1)], "every": 0.15}},
}


def recorded(directory: Path) -> dict[str, np.ndarray]:
    """Every array of the recordings of a run."""
    found = {}
    for name in ("statistics.h5", "paths.h5"):
        with h5py.File(directory / name, "r") as file:
            file.visititems(
                lambda key, item: found.update({key: item[()]}) if hasattr(item, "shape") else None
            )
    return found


def test_recordings_of_a_run_that_goes_on_are_those_of_one_without_a_break(tmp_path):
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    scene = sloshing()
    scene = scene.model_copy(update={"output": type(scene.output)(**scene.output.model_dump() | RECORDED)})
    run_scene(scene, whole, device="cpu")
    run_scene(scene, broken, device="cpu", frames=5)
    run_scene(scene, broken, device="cpu", resume=True)
    expected = recorded(whole)
    assert expected["samples"].shape == (7, 5)
    assert (expected["samples"] == 10).all()
    for name, values in recorded(broken).items():
        np.testing.assert_array_equal(values, expected[name])
    stage = Usd.Stage.Open(str(whole / "paths.usdc"))
    curves = UsdGeom.BasisCurves(stage.GetPrimAtPath("/still_tank/middle"))
    counts = np.array(curves.GetCurveVertexCountsAttr().Get())
    assert list(counts[:2]) == [13, 13]
    paths = expected["middle/position"]
    assert len(counts) == paths.shape[1]
    assert counts.sum() == np.isfinite(paths[..., 0]).sum()
    points = np.array(curves.GetPointsAttr().Get())
    assert points[:13, :2] == pytest.approx(paths[:, 0], abs=1e-6)


def last_state(directory: Path) -> dict:
    return read_checkpoint(directory / "checkpoint.h5").state["simulation"]


def same_bits(first: Path, second: Path) -> bool:
    a, b = last_state(first), last_state(second)
    return all(np.array_equal(a[name], b[name]) for name in a)


def test_a_run_leaves_everything_behind(tmp_path):
    summary = run_scene(sloshing(), tmp_path, device="cpu")
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {
        "scene.yaml",
        "summary.json",
        "probes.csv",
        "particles.usdc",
        "frames.h5",
        "checkpoint.h5",
    }
    record = json.loads((tmp_path / "summary.json").read_text())
    assert record["status"] == "complete"
    assert [shape["name"] for shape in record["shapes"]] == [one["name"] for one in record["sets"]]
    stage = Usd.Stage.Open(str(tmp_path / "particles.usdc"))
    points = [UsdGeom.Points(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Points)]
    assert sum(len(p.GetPointsAttr().Get(8)) for p in points) == summary["particles"]
    assert stage.GetEndTimeCode() == 8
    history = read_probes(tmp_path / "probes.csv")
    assert np.array_equal(np.round(np.array(history["time[s]"]) * 30.0, 9) % 1.0, np.zeros(13))
    mass = summary["ledger"]["end"]["mass"]
    assert mass == pytest.approx(summary["ledger"]["start"]["mass"], rel=1e-12)


def test_the_same_run_twice_gives_the_same_bits(tmp_path):
    for name, threads in (("one", 1), ("two", 2)):
        run_scene(sloshing(), tmp_path / name, device="cpu", threads=threads)
    assert same_bits(tmp_path / "one", tmp_path / "two")
    assert (tmp_path / "one/probes.csv").read_text() == (tmp_path / "two/probes.csv").read_text()


def test_a_run_stopped_after_some_frames_goes_on_with_the_same_bits(tmp_path):
    run_scene(sloshing(), tmp_path / "whole", device="cpu")
    run_scene(sloshing(), tmp_path / "parts", device="cpu", frames=6)  # frame 5; the checkpoint is of frame 4
    summary = run_scene(sloshing(), tmp_path / "parts", device="cpu", resume=True)
    assert summary["frames"] == 9
    assert same_bits(tmp_path / "whole", tmp_path / "parts")
    assert (tmp_path / "whole/probes.csv").read_text() == (tmp_path / "parts/probes.csv").read_text()


def test_a_checkpoint_of_another_scene_is_refused(tmp_path):
    run_scene(sloshing(end=0.1), tmp_path, device="cpu")
    other = sloshing(end=0.1, numerics={"h_over_dp": 1.6})
    with pytest.raises(CheckpointError, match="numerics"):
        run_scene(other, tmp_path, device="cpu", resume=True)


def test_a_checkpoint_without_a_field_of_the_present_scheme_is_refused(tmp_path):
    run_scene(sloshing(end=0.1), tmp_path, device="cpu")
    older = sloshing(end=0.2)
    with h5py.File(tmp_path / "checkpoint.h5", "a") as file:
        del file["state/simulation/wall_surface_normal"]
        del file.attrs["written_by"]
    missing = r"checkpoint\.h5: it lacks wall_surface_normal, .* did not leave its name\. Start anew"
    with pytest.raises(CheckpointError, match=missing):
        run_scene(older, tmp_path, device="cpu", resume=True)


def test_resume_without_a_checkpoint_is_refused(tmp_path):
    with pytest.raises(CheckpointError, match="no such checkpoint"):
        run_scene(sloshing(), tmp_path, device="cpu", resume=True)


def run_in_a_process(scene: Scene, out: Path) -> subprocess.Popen:
    path = out.with_suffix(".yaml")
    path.write_text(scene.to_yaml())
    code = (
        "import sys, warp; warp.config.quiet = True\n"
        "from pathlib import Path; from warpsph import load_scene, run_scene\n"
        "try: run_scene(load_scene(sys.argv[1]), Path(sys.argv[2]), device='cpu')\n"
        "except KeyboardInterrupt: sys.exit(130)"
    )
    return subprocess.Popen([sys.executable, "-c", code, str(path), str(out)], env=os.environ)


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGKILL, -9)])
def test_a_run_that_is_stopped_from_outside_goes_on_with_the_same_bits(tmp_path, number, code):
    scene, out = sloshing(end=2.0), tmp_path / "stopped"
    process = run_in_a_process(scene, out)
    deadline = time.monotonic() + 120.0
    while not (out / "checkpoint.h5").exists() and time.monotonic() < deadline:
        time.sleep(0.01)
    process.send_signal(number)
    assert process.wait(60) == code
    if number == signal.SIGINT:
        assert json.loads((out / "summary.json").read_text())["status"] == "interrupted"
    assert Usd.Stage.Open(str(out / "particles.usdc"))
    run_scene(scene, out, device="cpu", resume=True)
    run_scene(scene, tmp_path / "whole", device="cpu")
    assert same_bits(tmp_path / "whole", out)
    assert (tmp_path / "whole/probes.csv").read_text() == (out / "probes.csv").read_text()


def test_a_diverging_run_says_where_and_keeps_its_frames(tmp_path):
    # Without gravity in the estimate and at a sound speed far below the speed of the fall, the water collapses.
    scene = sloshing(end=2.0, numerics={"sound_speed": 0.3})
    with pytest.raises(SimulationDiverged) as failure:
        run_scene(scene, tmp_path, device="cpu")
    error = failure.value
    assert error.set == "water"
    assert len(error.position) == 2
    assert 0.0 <= error.time < 2.0
    assert "numerics.sound_speed" in str(error)
    assert json.loads((tmp_path / "summary.json").read_text())["status"].startswith("diverged")
    assert read_checkpoint(tmp_path / "checkpoint.h5").state
    assert Usd.Stage.Open(str(tmp_path / "particles.usdc"))


def test_the_cost_of_a_resumed_run_includes_what_came_before(tmp_path):
    whole = run_scene(sloshing(), tmp_path / "whole", device="cpu")
    run_scene(sloshing(), tmp_path / "parts", device="cpu")
    again = run_scene(sloshing(), tmp_path / "parts", device="cpu", resume=True)  # nothing is left to do
    before = json.loads((tmp_path / "whole/summary.json").read_text())
    assert again["steps"]["count"] == whole["steps"]["count"]
    assert again["list_builds"] == whole["list_builds"]
    assert set(again["wall_s_by_stage"]) == set(before["wall_s_by_stage"])
    steps_of_particles = again["particles"] * again["steps"]["count"]
    seconds = sum(again["wall_s_by_stage"].values())
    assert again["particle_steps_per_second"] == pytest.approx(steps_of_particles / seconds)
    assert again["wall_s_by_stage"]["accelerate"] > 0.0
    assert seconds < again["wall_s"] + 1.0


def test_a_directory_may_be_named_by_a_string_and_a_run_has_at_least_one_frame(tmp_path):
    assert run_scene(sloshing(), str(tmp_path / "run"), device="cpu", frames=1)["frames"] == 1
    with pytest.raises(ValueError, match="frames is 0; allowed"):
        run_scene(sloshing(), tmp_path / "none", device="cpu", frames=0)
    assert not (tmp_path / "none").exists()


def test_a_run_that_ended_between_two_frame_times_goes_on_in_both_stores(tmp_path):
    run_scene(sloshing(end=0.12), tmp_path, device="cpu")  # frames 0, 1, 2 and, at the end, 3
    run_scene(sloshing(end=0.2), tmp_path, device="cpu", resume=True)
    expected = [0.0, 0.05, 0.1, 0.15, 0.2]
    with h5py.File(tmp_path / "frames.h5") as file:
        assert np.allclose(file["time"], expected, rtol=0.0, atol=1e-12)
        assert len(file["frames"]) == 5
    stage = Usd.Stage.Open(str(tmp_path / "particles.usdc"))
    samples = UsdGeom.Points(stage.GetPrimAtPath("/still_tank/water")).GetPointsAttr().GetTimeSamples()
    assert samples == [0.0, 1.0, 2.0, 3.0, 4.0]


def test_a_checkpoint_from_after_the_end_is_refused(tmp_path):
    run_scene(sloshing(end=0.2), tmp_path, device="cpu")
    with pytest.raises(CheckpointError, match=r"it is of t = 0\.2 s, after time\.end = 0\.1 s"):
        run_scene(sloshing(end=0.1), tmp_path, device="cpu", resume=True)


def test_probes_that_need_no_field_of_particles_are_written(tmp_path: Path) -> None:
    """What passes an open boundary is no field; its rows are written all the same."""
    scene = channel(
        time={"end": 0.2, "frame_rate": 10.0}, probes={"flux": {"type": "flux", "patch": "inlet"}}
    )
    run_scene(scene, out=tmp_path, device="cpu")
    rows = (tmp_path / "probes.csv").read_text().splitlines()
    assert len(rows) == 1 + 3
