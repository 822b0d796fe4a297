"""Loads on structures: the whole of each, where it acts and when."""

import numpy as np
import pytest
from structure_builders import DENSITY, block, reference_of, region, system_of

from warpsph.particles.state import host_view
from warpsph.scene.errors import SceneError
from warpsph.solver.simulation import Simulation

EVERYWHERE_2D = region((-1.0, -1.0), (2.0, 2.0))


def load_of(scene) -> np.ndarray:
    """Force of the scene's only load on each particle (n, dim) [N], before its time law."""
    system = system_of(scene)
    return system.parts.mass[:, None] * system.parts.model.reference.load.numpy()[0].astype(np.float64)


def loaded(load: dict, size=(0.6, 0.4), shape: dict | None = None, **changes):
    structure = {"loads": {"it": load}} | ({"shape": shape} if shape else {})
    return block(size, structure=structure, **changes)


def test_a_force_is_shared_by_mass():
    where = region((0.0, 0.0), (0.2, 0.4))
    scene = loaded({"type": "force", "region": where, "value": (3.0, -4.0)})
    force, X = load_of(scene), reference_of(system_of(scene))
    chosen = X[:, 0] < 0.2
    assert force.sum(axis=0) == pytest.approx([3.0, -4.0], rel=1e-12)
    assert force[chosen] == pytest.approx(np.tile([3.0, -4.0], (chosen.sum(), 1)) / chosen.sum(), rel=1e-12)
    assert (force[~chosen] == 0.0).all()


def test_a_body_load_accelerates_the_particles_of_its_region():
    where = region((0.3, 0.0), (0.6, 0.4))
    scene = loaded({"type": "body", "region": where, "value": (0.0, 2.0)})
    force = load_of(scene)
    assert force.sum(axis=0) == pytest.approx([0.0, 2.0 * DENSITY * 0.3 * 0.4], rel=1e-12)


def test_a_traction_on_a_flat_face_is_its_area_times_it():
    """The right face of the block, 0.4 m high: the corner counts with its right side alone."""
    scene = loaded({"type": "traction", "region": region((0.599, -1.0), (0.7, 2.0)), "value": (5.0, 1.0)})
    force, X = load_of(scene), reference_of(system_of(scene))
    right = X[:, 0] > 0.5
    assert force.sum(axis=0) == pytest.approx([5.0 * 0.4, 1.0 * 0.4], rel=1e-6)
    assert force[right] == pytest.approx(np.tile([0.5, 0.1], (4, 1)), rel=1e-6)
    assert (force[~right] == 0.0).all()


@pytest.mark.parametrize(("dim", "spacing"), [(2, 0.02), (3, 0.04)])
def test_a_traction_on_a_round_body_acts_on_its_whole_surface(dim, spacing):
    """2 pi R and 4 pi R^2: the staircase has the area of the surface but for (dp/R)^2: 0.6 %, 2.6 %."""
    radius, centre = 0.25, (0.3,) * dim
    ball = {"type": "sphere", "center": centre, "radius": radius}
    everywhere = region((-1.0,) * dim, (2.0,) * dim)
    scene = loaded(
        {"type": "traction", "region": everywhere, "value": (7.0,) + (0.0,) * (dim - 1)},
        size=(0.6,) * dim,
        spacing=spacing,
        shape=ball,
    )
    area = load_of(scene).sum(axis=0)[0] / 7.0
    exact = 2 * np.pi * radius if dim == 2 else 4 * np.pi * radius**2
    assert area == pytest.approx(exact, rel=(spacing / radius) ** 2)


def test_a_time_law_moves_a_free_body_as_newton_says():
    """m dv/dt = F sin(w t): v = F (1 - cos(w t)) / (m w); the steps sum it as trapezoids, to (w dt)^2 / 12."""
    load = {"type": "body", "value": (3.0, 0.0), "factor": "sin(40*t)"}
    scene = loaded(load, time={"end": 0.1, "max_step": 5e-4})
    simulation = Simulation(scene, device="cpu", threads=1)
    simulation.advance(0.1)
    velocity = host_view(simulation.array("velocity"))
    expected = 3.0 * (1.0 - np.cos(4.0)) / 40.0
    assert velocity[:, 0] == pytest.approx(expected, rel=(40 * 5e-4) ** 2 / 12 * 2)
    assert np.abs(velocity[:, 1]).max() < 1e-12


def test_work_of_a_load_on_a_free_body_is_its_kinetic_energy():
    """Both are sums over steps, which differ by (w dt)^2 / 12."""
    load = {"type": "body", "value": (3.0, 0.0), "factor": "sin(40*t)"}
    simulation = Simulation(loaded(load, time={"end": 0.1, "max_step": 5e-4}), device="cpu", threads=1)
    simulation.advance(0.1)
    ledger = simulation.ledger()
    assert ledger.energies["work"] == pytest.approx(ledger.kinetic_energy, rel=(40 * 5e-4) ** 2 / 12)


@pytest.mark.parametrize("kind", ["force", "traction", "body"])
def test_a_load_beside_the_structure_is_refused(kind):
    scene = loaded({"type": kind, "region": region((5.0, 5.0), (6.0, 6.0)), "value": (1.0, 0.0)})
    with pytest.raises(SceneError) as caught:
        system_of(scene)
    (problem,) = caught.value.problems
    assert problem.key == "structures.block.loads.it.region"
    assert "has no" in problem.message
    assert problem.allowed
