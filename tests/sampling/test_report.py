"""What a scene says of its particles: volumes and extents beside those of the shapes, evenness where relaxed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from sampling.tank_scenes import box, make_scene, sphere

from warpsph.sampling import sample
from warpsph.sampling.report import shape_report
from warpsph.scene.schema import Scene

TANK = {"shape": box([0.0, 0.0], [1.0, 1.0]), "side": "outside", "layers": 3}


def reported(scene: Scene) -> list[dict[str, Any]]:
    return shape_report(scene, sample(scene))


def test_volume_and_extent_of_a_box_that_fits_the_lattice() -> None:
    water, tank = reported(
        make_scene(0.1, {"water": box([0.0, 0.0], [1.0, 0.5])}, {"tank": TANK}, dimension=2)
    )
    assert (water["volume"], water["sampled_volume"]) == (0.5, pytest.approx(0.5))
    assert np.array(water["sampled_extent"]) == pytest.approx(np.array(water["extent"]), abs=1e-12)
    assert (water["evenness"], water["is_filled"]) == (None, True)
    assert (tank["is_filled"], tank["volume"]) == (False, 1.0)
    assert tank["sampled_volume"] == pytest.approx(1.6**2 - 1.0)
    assert np.array(tank["sampled_extent"]) == pytest.approx(np.array([[-0.3, -0.3], [1.3, 1.3]]))


def test_length_that_is_no_multiple_of_the_spacing_shows() -> None:
    (water,) = reported(make_scene(0.1, {"water": box([0.0, 0.0], [1.04, 0.5])}, {}, dimension=2))
    assert water["volume"] == pytest.approx(0.52)
    assert water["sampled_volume"] == pytest.approx(0.5)
    assert water["sampled_extent"][1] == pytest.approx([1.0, 0.5])


def test_relaxed_particles_say_how_uneven_they_are_left() -> None:
    scene = make_scene(0.02, {"water": sphere([0.003, 0.001], 0.5)}, {}, dimension=2)
    fluid = scene.fluids["water"].model_copy(update={"placement": "relaxed"})
    (water,) = reported(scene.model_copy(update={"fluids": {"water": fluid}}))
    assert 0.0 < water["evenness"]["unevenness"] < 0.03
    assert 0.75 < water["evenness"]["closest"] < 1.0
    assert 0.0 < water["evenness"]["spread"] < 0.15


def test_plane_without_end_has_no_extent_and_no_volume() -> None:
    floor = {
        "shape": {
            "type": "plane",
            "point": [0.0, 0.0],
            "normal": [0.0, 1.0],
            "bounds": {"min": [0.0, 0.0], "max": [1.0, 1.0]},
        },
        "side": "inside",
    }
    _, plane = reported(
        make_scene(0.1, {"water": box([0.0, 0.0], [1.0, 0.5])}, {"floor": floor}, dimension=2)
    )
    assert (plane["extent"], plane["volume"]) == (None, None)
