"""HDF5 files composed in memory, because the HDF5 library crashes the program where a disk fills up."""

from collections.abc import Callable

import h5py


def file_image(fill: Callable[[h5py.File], None]) -> bytes:
    """The bytes of a file with the content that `fill` gives it."""
    with h5py.File.in_memory() as file:
        fill(file)
        file.flush()
        return file.id.get_file_image()
