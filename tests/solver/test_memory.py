"""Memory: what a particle takes, that it is known beforehand, and that what does not fit is refused."""

from __future__ import annotations

import pytest
import warp as wp
from builders import still_tank

from warpsph.sampling import sample
from warpsph.scene import load_scene
from warpsph.scene.errors import SceneError
from warpsph.scene.schema import Scene
from warpsph.solver import memory
from warpsph.solver.simulation import Simulation

MOST_BYTES = 200
"""Of a particle of a single-phase fluid in 3D, without its neighbour list."""


def block_of_water() -> Scene:
    """8,000 particles without walls."""
    fluids = {"water": {"shape": {"type": "box", "min": [0, 0, 0], "max": [1, 1, 1]}, "density": 1000.0}}
    time = {"end": 0.1, "frame_rate": 10.0}
    return Scene(name="block", dimension=3, spacing=0.05, gravity=[0, 0, -9.81], time=time, fluids=fluids)


def test_a_fluid_particle_in_3d_takes_at_most_200_bytes_without_its_list() -> None:
    described = Simulation(block_of_water(), "cpu", 1).describe()
    assert described["bytes_per_particle"] - described["list_bytes"] / described["particles"] <= MOST_BYTES


@pytest.mark.parametrize("scene", [block_of_water(), load_scene("dam_break_2d", ["spacing=0.05"])])
def test_the_estimate_is_what_a_run_takes_up_to_a_tenth(scene: Scene) -> None:
    """Walls have a few arrays more, and lists of other lengths."""
    described = Simulation(scene, "cpu", 1).describe()
    taken = described["bytes_per_particle"] * described["particles"]
    assert memory.estimated_bytes(scene, sample(scene)) == pytest.approx(taken, rel=0.1)


def test_a_scene_that_does_not_fit_is_refused_with_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = still_tank()
    needed = memory.estimated_bytes(scene, sample(scene))
    monkeypatch.setattr(memory, "free_memory", lambda device: needed / 4.0)
    with pytest.raises(SceneError, match=r"spacing.*particles need about"):
        Simulation(scene, "cpu")


def test_the_memory_left_on_this_machine_is_a_number_of_bytes() -> None:
    free = memory.free_memory(wp.get_device("cpu"))
    assert free is None or free > 2**20
