"""Writes frames until it is killed: python endless_run.py usd|hdf5 PATH; prints a line after each frame."""

import sys
from pathlib import Path

from sample_frames import frame_of, tank_scene

from warpsph.output.hdf5 import Hdf5Store
from warpsph.output.usd import UsdStore

if __name__ == "__main__":
    scene = tank_scene(3)
    store = {"usd": UsdStore, "hdf5": Hdf5Store}[sys.argv[1]](Path(sys.argv[2]), scene)
    store.open()
    for index in range(100_000):
        store.write(frame_of(scene, index, fluid_count=20_000))
        print(index, flush=True)
