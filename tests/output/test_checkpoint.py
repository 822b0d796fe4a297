"""A checkpoint gives back the state exactly, or says clearly why it cannot."""

import h5py
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from warpsph import __version__
from warpsph.output.checkpoint import CheckpointError, read_checkpoint, write_checkpoint
from warpsph.output.errors import OutputError

NUMBER_TYPES = st.sampled_from(["f4", "f8", "i4", "i8", "u4", "u8", "?"]).map(np.dtype)
SHAPES = hnp.array_shapes(min_dims=0, max_dims=2, min_side=0, max_side=3)
ARRAYS = NUMBER_TYPES.flatmap(lambda dtype: hnp.arrays(dtype, SHAPES))
TEXT = st.text("aß\n{}:", max_size=8)
SCALARS = st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), TEXT)
NAMES = st.sampled_from(["time", "step", "position", "water"])
GROUPS = st.dictionaries(NAMES, ARRAYS | SCALARS, max_size=3)
STATES = st.dictionaries(NAMES, GROUPS | ARRAYS | SCALARS, max_size=3)


def assert_same(read: object, written: object) -> None:
    """Equal types and bits, NaN included."""
    assert type(read) is type(written)
    if isinstance(written, dict):
        assert read.keys() == written.keys()
        for key, value in written.items():
            assert_same(read[key], value)
    elif isinstance(written, np.ndarray | np.generic):
        assert (read.dtype, read.shape) == (written.dtype, written.shape)
        assert read.tobytes() == written.tobytes()
    else:
        assert repr(read) == repr(written)


@given(state=STATES, scene_text=TEXT)
def test_state_and_scene_come_back_with_types_and_bits(tmp_path_factory, state, scene_text):
    path = tmp_path_factory.getbasetemp() / "checkpoint.h5"
    write_checkpoint(path, state, scene_text)
    checkpoint = read_checkpoint(path)
    assert_same(checkpoint.state, state)
    assert checkpoint.scene_text == scene_text


def test_numpy_scalars_and_long_scenes_come_back(tmp_path):
    state = {"time": np.float64(0.1), "step": np.int32(7), "rng": 2**127 + 1}
    write_checkpoint(tmp_path / "c.h5", state, "x" * 200_000)
    checkpoint = read_checkpoint(tmp_path / "c.h5")
    assert_same(checkpoint.state, state)
    assert len(checkpoint.scene_text) == 200_000
    assert checkpoint.writer == __version__


@pytest.fixture
def checkpoint_file(tmp_path):
    path = tmp_path / "checkpoint.h5"
    write_checkpoint(path, {"position": np.random.default_rng(0).random((5000, 3))}, "name: tank")
    return path


def test_missing_file_is_an_error_that_names_it(tmp_path):
    with pytest.raises(CheckpointError, match=r"nowhere\.h5: there is no such checkpoint"):
        read_checkpoint(tmp_path / "nowhere.h5")


@pytest.mark.parametrize("kept", [0.0, 0.1, 0.5, 0.99])
def test_truncated_file_is_an_error(checkpoint_file, kept):
    content = checkpoint_file.read_bytes()
    checkpoint_file.write_bytes(content[: int(kept * len(content))])
    with pytest.raises(CheckpointError, match="damaged"):
        read_checkpoint(checkpoint_file)


def test_flipped_bit_in_an_array_is_an_error(checkpoint_file):
    content = bytearray(checkpoint_file.read_bytes())
    content[len(content) // 2] ^= 1
    checkpoint_file.write_bytes(content)
    with pytest.raises(CheckpointError, match="damaged"):
        read_checkpoint(checkpoint_file)


def test_foreign_hdf5_file_and_other_version_are_errors(tmp_path, checkpoint_file):
    with h5py.File(tmp_path / "foreign.h5", "w") as file:
        file["x"] = 1.0
    with pytest.raises(CheckpointError, match="no checkpoint of warpsph"):
        read_checkpoint(tmp_path / "foreign.h5")
    with h5py.File(checkpoint_file, "a") as file:
        file.attrs["version"] = 99
    with pytest.raises(CheckpointError, match="version 99"):
        read_checkpoint(checkpoint_file)


def test_full_disk_keeps_the_older_checkpoint(checkpoint_file, disk_full_beyond):
    with disk_full_beyond(10_000), pytest.raises(OutputError, match="File too large"):
        write_checkpoint(checkpoint_file, {"position": np.zeros(20_000)}, "name: new")
    assert read_checkpoint(checkpoint_file).scene_text == "name: tank"
