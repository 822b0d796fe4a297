"""Sets of two particles, of one and of none: what is left of the laws when there is nobody to interact with."""

import json

import numpy as np
import pytest

from warpsph.output.probes_csv import read_probes
from warpsph.scene.errors import SceneError
from warpsph.solver.run import run_scene
from warpsph.solver.simulation import Simulation
from warpsph.validation.hard.few_particles import DP, END, RUBBER, row
from warpsph.validation.hard.shapes import GRAVITY

FALL = -0.5 * GRAVITY * END**2

DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])
KINDS = pytest.mark.parametrize("kind", ["fluid", "structure"])


def simulate(scene):
    return Simulation(scene, device="cpu", threads=1)


@DIMENSIONS
@KINDS
@pytest.mark.parametrize("count", [1, 2])
def test_they_fall_like_a_stone(kind, dimension, count):
    """Both steps are exact under a uniform acceleration, so that only some hundred roundings remain."""
    simulation = simulate(row(kind, dimension, count))
    (before,) = simulation.frame(["velocity"]).sets
    simulation.advance(END)
    (after,) = simulation.frame(["velocity"]).sets
    way = after.fields["position"] - before.fields["position"]
    assert way[:, -1] == pytest.approx(FALL, rel=1e-13)
    assert np.array_equal(way[:, :-1], np.zeros((count, dimension - 1)))
    assert after.fields["velocity"][:, -1] == pytest.approx(-GRAVITY * END, rel=1e-13)


@DIMENSIONS
def test_a_single_particle_of_fluid_keeps_its_density(dimension):
    simulation = simulate(row("fluid", dimension, 1, velocity=3.0))
    simulation.advance(END)
    (one,) = simulation.frame(["density"]).sets
    assert np.array_equal(one.fields["density"], [1000.0])


@DIMENSIONS
def test_two_particles_of_fluid_that_meet_part_again(dimension):
    """At a hundredth of the sound speed; they stay each other's mirror image, and lose energy to viscosity alone."""
    simulation = simulate(row("fluid", dimension, 2, velocity="0.4 - 4 * x", gravity=(0.0,) * dimension))
    energy, slowest, closest = simulation.ledger().kinetic_energy, np.inf, np.inf
    for time in np.linspace(0.05, 1.0, 20):
        simulation.advance(time)
        (pair,) = simulation.frame(["velocity"]).sets
        velocity, place = pair.fields["velocity"], pair.fields["position"]
        assert velocity.sum(axis=0) == pytest.approx(0.0, abs=1e-13)
        assert np.abs(velocity[:, 1:]).max() < 1e-13
        assert simulation.ledger().kinetic_energy < energy
        slowest, closest = min(slowest, velocity[0, 0]), min(closest, place[1, 0] - place[0, 0])
    assert slowest < 0.0
    assert closest > 0.9 * DP


@DIMENSIONS
def test_two_particles_of_a_structure_say_what_they_cannot_feel(dimension):
    """In the plane they see a line and resist along it, in space they see too little for any stress."""
    simulation = simulate(row("structure", dimension, 2))
    (warning,) = simulation.system.warnings(simulation.extremes)
    assert warning.startswith("2 particles have")
    assert ("in one line" if dimension == 2 else "too few neighbours") in warning


def test_a_rigid_particle_that_is_free_to_turn_is_refused():
    body = row("structure", 2, 1).structures["body"].model_dump(exclude_unset=True) | {"rigid": {}}
    with pytest.raises(SceneError, match=r"structures\.body\.rigid\.inertia: the particles lie on an axis"):
        simulate(row("structure", 2, 1, structures={"body": body}))


@KINDS
def test_a_shape_between_the_particles_is_refused(kind):
    """No set of a scene is empty: a shape that no particle lies in is a mistake of the scene."""
    hole = {"type": "box", "min": (0.0, 0.0), "max": (0.3, 0.3)}
    shape = {
        "type": "difference",
        "base": {"type": "box", "min": (0.0, 0.0), "max": (0.34, 0.34)},
        "subtract": [hole],
    }
    section = f"{kind}s"
    body = getattr(row(kind, 2, 1), section)["body"].model_dump(exclude_unset=True) | {"shape": shape}
    message = rf"{section}\.body\.shape: no particle of this spacing has its centre there"
    with pytest.raises(SceneError, match=message):
        simulate(row(kind, 2, 1, **{section: {"body": body}}))


@pytest.mark.parametrize("dimension", [2, pytest.param(3, marks=pytest.mark.verification)])
def test_a_run_goes_on_when_all_of_its_fluid_has_left(tmp_path, dimension):
    """Through the kill box; the wall stays, the structure falls on, and probes say that nothing is there."""

    def box(low, high):
        return {"type": "box", "min": (low,) * dimension, "max": (*(high,) * (dimension - 1), low + 0.4)}

    scene = row(
        "fluid",
        dimension,
        3,
        velocity=5.0,
        domain={"kill_box": {"min": (-1.0,) * dimension, "max": (0.6,) * dimension}},
        boundaries={"wall": {"shape": box(-0.4, 0.4), "side": "solid"}},
        structures={"stone": {"shape": box(-0.9, -0.5), "material": RUBBER}},
        probes={
            "volume": {"type": "volume"},
            "energy": {"type": "energy"},
            "front": {"type": "front", "axis": "x"},
            "point": {"type": "point", "at": (0.1,) * dimension},
        },
        output={"hdf5": True},
    )
    run_scene(scene, tmp_path, device="cpu", threads=1)
    record = json.loads((tmp_path / "summary.json").read_text())
    assert record["status"] == "complete"
    assert "3 particles left the kill box and were removed" in record["warnings"]
    history = read_probes(tmp_path / "probes.csv")
    assert history["volume.particles[1]"][-1] == 0.0
    assert next(values[-1] for name, values in history.items() if name.startswith("energy.kinetic")) == 0.0
    assert all(np.isnan(v[-1]) for name, v in history.items() if name.startswith(("front.", "point.")))
