"""What both frame formats promise: no frame is lost, whatever ends the run, and a run can be continued."""

import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
from pxr import Usd, UsdGeom
from sample_frames import FRAME_RATE, frame_of, tank_scene

from warpsph.output.errors import OutputError
from warpsph.output.frame_store import FrameStore
from warpsph.output.hdf5 import Hdf5Store
from warpsph.output.usd import UsdStore

Positions = dict[float, np.ndarray]


def positions_in_usd(path: Path) -> Positions:
    """Positions of the water by time code, read as a viewer would."""
    stage = Usd.Stage.Open(str(path))
    stage.Reload()
    points = UsdGeom.Points(stage.GetDefaultPrim().GetChild("water")).GetPointsAttr()
    return {code: np.array(points.Get(code)) for code in points.GetTimeSamples()}


def positions_in_hdf5(path: Path) -> Positions:
    """Positions of the water by frame number."""
    with h5py.File(path, "r") as file:
        assert [group.attrs["time"] for group in file["frames"].values()] == list(file["time"])
        return {float(name): group["water/position"][:] for name, group in file["frames"].items()}


FORMATS = {"usd": (UsdStore, positions_in_usd), "hdf5": (Hdf5Store, positions_in_hdf5)}


@pytest.fixture(params=FORMATS)
def file_format(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture
def read(file_format: str) -> Callable[[Path], Positions]:
    return FORMATS[file_format][1]


@pytest.fixture
def store_type(file_format: str) -> type[FrameStore]:
    return FORMATS[file_format][0]


@pytest.fixture
def path(tmp_path: Path, file_format: str) -> Path:
    return tmp_path / {"usd": "particles.usdc", "hdf5": "frames.h5"}[file_format]


SCENE = tank_scene(3)


def write_frames(store: FrameStore, indices: range) -> None:
    for index in indices:
        store.write(frame_of(SCENE, index))


def assert_holds(stored: Positions, indices: range) -> None:
    """Exactly these frames, with the positions that were written."""
    assert sorted(stored) == list(indices)
    for index in indices:
        written = frame_of(SCENE, index).set_named("water").fields["position"]
        np.testing.assert_allclose(stored[index], written, rtol=1e-6)


def test_every_frame_is_readable_as_soon_as_it_is_written(store_type, path, read):
    store = store_type(path, SCENE)
    store.open()
    for index in range(3):
        store.write(frame_of(SCENE, index))
        assert_holds(read(path), range(index + 1))


def test_a_finished_run_is_one_file(store_type, path, read):
    store = store_type(path, SCENE)
    store.open()
    write_frames(store, range(4))
    store.close()
    assert [entry.name for entry in path.parent.iterdir()] == [path.name]
    assert_holds(read(path), range(4))


@pytest.mark.parametrize("finished", [True, False], ids=["after the end", "after a crash"])
def test_resumed_run_equals_the_uninterrupted_one(store_type, path, read, finished):
    """Frames after the checkpoint are dropped, also from a file that was packed; then the run goes on."""
    store = store_type(path, SCENE)
    store.open()
    write_frames(store, range(6))
    if finished:
        store.close()

    resumed = store_type(path, SCENE)
    resumed.open(resume_time=3 / FRAME_RATE)
    write_frames(resumed, range(4, 5))
    assert_holds(read(path), range(5))
    write_frames(resumed, range(5, 8))
    resumed.close()
    assert_holds(read(path), range(8))
    assert [entry.name for entry in path.parent.iterdir()] == [path.name]


def test_resuming_twice_from_a_finished_run(store_type, path, read):
    store = store_type(path, SCENE)
    store.open()
    write_frames(store, range(3))
    store.close()
    for first in (3, 4):
        resumed = store_type(path, SCENE)
        resumed.open(resume_time=(first - 1) / FRAME_RATE)
        write_frames(resumed, range(first, first + 1))
    resumed.close()
    assert_holds(read(path), range(5))


def test_resuming_without_a_new_frame_changes_nothing(store_type, path, read):
    store = store_type(path, SCENE)
    store.open()
    write_frames(store, range(3))
    store.close()
    resumed = store_type(path, SCENE)
    resumed.open(resume_time=2 / FRAME_RATE)
    resumed.close()
    assert_holds(read(path), range(3))
    assert [entry.name for entry in path.parent.iterdir()] == [path.name]


def test_new_run_replaces_the_result_of_an_older_one(store_type, path, read):
    for frames in (range(5), range(2)):
        store = store_type(path, SCENE)
        store.open()
        write_frames(store, frames)
    assert_holds(read(path), range(2))


@pytest.mark.parametrize("delay", [0.0, 0.02])
def test_killed_run_leaves_every_frame_that_it_reported(file_format, path, read, delay):
    """kill -9 at some moment of writing: all frames reported before are there, complete."""
    script = Path(__file__).with_name("endless_run.py")
    command = [sys.executable, script, file_format, path]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    with subprocess.Popen(command, stdout=subprocess.PIPE, env=environment) as run:
        reported = [int(run.stdout.readline()) for _ in range(4)]
        time.sleep(delay)
        run.kill()
    stored = read(path)
    assert set(reported) <= set(stored)
    for index, positions in stored.items():
        written = frame_of(SCENE, int(index), fluid_count=20_000).set_named("water").fields["position"]
        np.testing.assert_allclose(positions, written, rtol=1e-6)


def test_full_disk_is_an_error_with_path_and_reason_and_costs_no_frame(
    store_type, path, read, disk_full_beyond
):
    store = store_type(path, SCENE)
    store.open()
    write_frames(store, range(3))
    with disk_full_beyond(20_000), pytest.raises(OutputError, match=r"000003.*File too large"):
        store.write(frame_of(SCENE, 3, fluid_count=2000))
    assert_holds(read(path), range(3))


def test_frames_stay_in_parts_where_the_disk_cannot_hold_the_packed_file(
    store_type, path, read, disk_full_beyond, caplog
):
    store = store_type(path, SCENE)
    store.open()
    write_frames(store, range(8))
    largest = max(file.stat().st_size for file in path.parent.rglob("*") if file.is_file())
    with disk_full_beyond(largest + 100):
        store.close()
    assert "File too large" in caplog.text
    assert_holds(read(path), range(8))


def test_unwritable_directory_is_an_error_with_path_and_reason(store_type, tmp_path):
    (tmp_path / "file").write_text("not a directory")
    with pytest.raises(OutputError, match=r"file/frames.*Not a directory"):
        store_type(tmp_path / "file" / "frames", SCENE).open()


def test_continuing_a_foreign_file_is_an_error(store_type, path):
    path.write_text("no frames here")
    with pytest.raises(OutputError, match=f"{path.name}: cannot continue"):
        store_type(path, SCENE).open(resume_time=0.1)
