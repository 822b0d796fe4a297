"""frames.h5: every field, bit for bit."""

import h5py
import numpy as np
import pytest
from sample_frames import FRAME_RATE, frame_of, tank_scene

from warpsph.output.hdf5 import Hdf5Store

COUNTS = [30, 0, 1]


@pytest.fixture(params=["running", "finished"])
def stored(request, scene, tmp_path):
    """A run of frames with COUNTS fluid particles, opened while it goes on or after its end."""
    store = Hdf5Store(tmp_path / "frames.h5", scene)
    store.open()
    for index, count in enumerate(COUNTS):
        store.write(frame_of(scene, index, count))
    if request.param == "finished":
        store.close()
    with h5py.File(tmp_path / "frames.h5", "r") as file:
        yield file


def test_every_field_of_every_frame_has_the_bits_and_the_type_that_were_written(stored, scene):
    for index, count in enumerate(COUNTS):
        for particle_set in frame_of(scene, index, count).sets:
            group = stored[f"frames/{index:06d}/{particle_set.name}"]
            assert group.attrs["kind"] == particle_set.kind
            assert set(group) == set(particle_set.fields)
            for name, values in particle_set.fields.items():
                assert group[name].dtype == values.dtype
                np.testing.assert_array_equal(group[name][()], values)


def test_times_and_units_are_stated(stored, scene):
    np.testing.assert_array_equal(stored["time"], np.arange(len(COUNTS)) / FRAME_RATE)
    assert stored["time"].attrs["unit"] == "s"
    water = stored["frames/000000/water"]
    units = {name: water[name].attrs["unit"] for name in ("position", "velocity", "pressure", "mass")}
    assert units == {
        "position": "m",
        "velocity": "m/s",
        "pressure": "Pa",
        "mass": "kg/m" if scene.dimension == 2 else "kg",
    }


def test_fields_are_compressed(tmp_path):
    scene = tank_scene(3)
    store = Hdf5Store(tmp_path / "frames.h5", scene)
    store.open()
    store.write(frame_of(scene, 0, 5000))
    store.close()
    with h5py.File(tmp_path / "frames.h5", "r") as file:
        ids = file["frames/000000/water/id"]
        assert ids.id.get_storage_size() < 0.2 * ids.nbytes
