"""The run directory holds what the scene asks for, and nothing of an older run."""

import pytest
from sample_frames import tank_scene

from warpsph.output.errors import OutputError
from warpsph.output.hdf5 import Hdf5Store
from warpsph.output.run_directory import create_run_directory, frame_stores
from warpsph.output.usd import UsdStore


def test_new_run_removes_the_checkpoint_of_an_older_one_and_a_resumed_run_keeps_it(tmp_path):
    directory = create_run_directory(tmp_path / "out" / "tank", tank_scene(2))
    directory.checkpoint.write_bytes(b"state")
    directory.summary.write_text("{}")
    create_run_directory(directory.path, tank_scene(2), resume=True)
    assert directory.checkpoint.exists()
    create_run_directory(directory.path, tank_scene(2))
    assert [file.name for file in directory.path.iterdir()] == ["scene.yaml"]


def test_scene_as_run_is_in_the_directory(tmp_path):
    directory = create_run_directory(tmp_path, tank_scene(2))
    assert directory.scene.read_text() == tank_scene(2).to_yaml()


@pytest.mark.parametrize(
    ("output", "expected"),
    [
        ({}, [UsdStore]),
        ({"hdf5": True}, [UsdStore, Hdf5Store]),
        ({"usd": False, "hdf5": False}, []),
    ],
)
def test_writers_are_those_that_the_scene_asks_for(tmp_path, output, expected):
    scene = tank_scene(2, **output)
    stores = frame_stores(create_run_directory(tmp_path, scene), scene)
    assert [type(store) for store in stores] == expected


def test_directory_that_cannot_be_made_is_an_error_with_path_and_reason(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match=r"file/run: cannot write: Not a directory"):
        create_run_directory(tmp_path / "file" / "run", tank_scene(2))


def test_directory_that_is_closed_to_new_files_is_found_before_the_first_one(tmp_path, monkeypatch):
    monkeypatch.setattr("os.access", lambda path, mode: False)
    with pytest.raises(OutputError, match=r"cannot write: the directory is closed to new files"):
        create_run_directory(tmp_path, tank_scene(2))
    assert list(tmp_path.iterdir()) == []


def test_a_file_in_place_of_the_directory_is_called_a_file(tmp_path):
    (tmp_path / "file").write_text("kept")
    with pytest.raises(OutputError, match=r"this is a file; allowed: a directory"):
        create_run_directory(tmp_path / "file", tank_scene(2))
    assert (tmp_path / "file").read_text() == "kept"
