"""Corrected first derivatives: exact for linear fields up to a surface, and what they cost in conservation."""

import numpy as np
import pytest
from builders import free_drop, still_tank

from warpsph.scene.schema import Scene
from warpsph.solver.simulation import Simulation

FORMS = ("renormalised", "finite_particle")
BARE = {
    "precision": "double",
    "state": {"type": "linear"},
    "viscosity": {"type": "none"},
    "density_diffusion": {"type": "none"},
}


def drop_in(dimension: int, form: str, velocity: list[str]) -> Simulation:
    """A drop in a velocity field, in steps so short that nothing moves."""
    scene = free_drop(dimension, 0.1, numerics=BARE | {"kernel_gradient": form}, time={"max_step": 1e-9})
    plain = scene.model_dump()
    plain["fluids"]["water"]["velocity"] = velocity[:dimension]
    return Simulation(Scene(**plain), device="cpu")


def displace(sim: Simulation) -> np.ndarray:
    """Put the particles off the lattice by up to 0.15 spacings, and return where they are."""
    position = sim.array("position").numpy()
    position += np.random.default_rng(4).uniform(-0.015, 0.015, position.shape)
    sim.system.stepper.renew_lists()
    return sim.array("position").numpy()


def has_neighbours(position: np.ndarray) -> np.ndarray:
    """Whether a particle is none of the corners and, in 3D, of the edges, whose own sums may be left as they are."""
    return (np.abs(position - 0.5) > 0.35).sum(axis=1) < position.shape[1]


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("form", FORMS)
def test_the_divergence_of_a_linear_velocity_is_exact(dimension, form):
    # v = (0.3 x + 0.1 y, -0.2 x + 0.4 y, 0.1 z): drho/dt = -rho div v everywhere, the surface included.
    sim = drop_in(dimension, form, ["0.3 * x + 0.1 * y", "0.4 * y - 0.2 * x", "0.1 * z"])
    position = displace(sim)
    matrix = np.array([[0.3, 0.1, 0.0], [-0.2, 0.4, 0.0], [0.0, 0.0, 0.1]])[:dimension, :dimension]
    sim.array("velocity_volume").numpy()[:, :-1] = position @ matrix.T
    sim.system.parts.fluid.synchronise()
    sim.system.parts.fluid.update_density()
    rate = sim.system.parts.assembly.state.density_rate.numpy()
    expected = -1000.0 * np.trace(matrix)
    assert rate[has_neighbours(position)] == pytest.approx(expected, rel=1e-10)


def test_the_plain_divergence_misses_the_surface():
    # What the correction is for: across a flat surface about half of the derivative is missing.
    sim = drop_in(2, "plain", ["0.3 * x", "0.4 * y"])
    rate = sim.system.parts.assembly.state.density_rate.numpy()
    assert np.abs(rate + 700.0).max() > 200.0


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_finite_particle_gradient_of_a_linear_pressure_is_exact(dimension):
    # p = c0^2 (rho - rho0) with a linear density: a = -grad p / rho everywhere.
    sim = drop_in(dimension, "finite_particle", ["0.0", "0.0", "0.0"])
    position = displace(sim)
    slope = np.array([3.0, -2.0, 1.0])[:dimension]
    sim.array("density_deviation").numpy()[:] = position @ slope
    sim.system.parts.fluid.synchronise()
    sim.system.parts.fluid.accelerate()
    density = 1000.0 + position @ slope
    expected = -(sim.sound_speed**2) * slope / density[:, None]
    kept = has_neighbours(position)
    assert sim.array("acceleration").numpy()[kept] == pytest.approx(expected[kept], rel=1e-9)


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_renormalised_form_conserves_momentum_to_rounding(dimension):
    scene = free_drop(dimension, numerics={"kernel_gradient": "renormalised", "precision": "double"})
    sim = Simulation(scene, device="cpu")

    def momentum() -> np.ndarray:
        water = sim.frame(["velocity", "mass"]).sets[0].fields
        return (water["mass"][:, None] * water["velocity"]).sum(axis=0)

    before = momentum()
    for _ in range(20):
        sim.step()
    assert np.abs(momentum() - before).max() < 1e-14 * 1000.0


@pytest.mark.verification
def test_still_water_stays_under_its_surface():
    sim = Simulation(still_tank(numerics={"kernel_gradient": "renormalised"}), device="cpu")
    sim.advance(0.5)
    water = sim.frame(["velocity"]).sets[0].fields
    # The drop over one spacing, sqrt(2 g dp), is the speed of water that lets go.
    assert np.abs(water["velocity"]).max() < 0.2 * np.sqrt(2.0 * 9.81 * 0.05)
    assert water["position"][:, 1].max() == pytest.approx(0.475, abs=0.025)


@pytest.mark.verification
@pytest.mark.parametrize("form", ["plain", *FORMS])
def test_density_drifts_only_with_plain_sums(form):
    # Periodic vortices lose no volume, so the mean density must stay. Sums over disordered particles have a
    # divergence where the flow has none, which adds up; corrected ones have none of a uniform gradient.
    k = 2.0 * np.pi
    fluid = {
        "shape": {"type": "box", "min": (0.0, 0.0), "max": (1.0, 1.0)},
        "density": 1.0,
        "kinematic_viscosity": 0.01,
        "velocity": (f"-cos({k} * x) * sin({k} * y)", f"sin({k} * x) * cos({k} * y)"),
        "pressure": {"type": "uniform", "value": 0.0},
    }
    numerics = {"h_over_dp": 2.0, "viscosity": {"type": "laminar"}, "kernel_gradient": form}
    scene = Scene(
        name="vortices",
        dimension=2,
        spacing=1.0 / 30,
        domain={"periodic": {"x": (0.0, 1.0), "y": (0.0, 1.0)}},
        time={"end": 1.0, "frame_rate": 10.0},
        fluids={"water": fluid},
        numerics=numerics | {"sound_speed": 10.0, "particle_order": {"type": "transport_velocity"}},
    )
    sim = Simulation(scene, device="cpu")
    sim.advance(1.0)
    drift = float(sim.frame(["density"]).sets[0].fields["density"].mean() - 1.0)
    assert (abs(drift) < 2e-3) == (form != "plain"), drift
