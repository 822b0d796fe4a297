"""Viscous stress from the strain rate against closed forms of channel flow, and its conservation."""

import numpy as np
import pytest
from builders import GAP, VISCOSITY, channel, free_drop

from warpsph.solver.simulation import Simulation

DRIVE, LID_SPEED, DENSITY = 2.0e-4, 2.5e-5, 1000.0


def profile(scene, t: float) -> tuple[np.ndarray, np.ndarray]:
    sim = Simulation(scene, device="cpu")
    sim.advance(t)
    water = sim.frame(["velocity"]).sets[0].fields
    return water["position"][:, 1], water["velocity"][:, 0]


@pytest.mark.parametrize("viscosity", ["viscous_stress", "sub_particle_scale"])
def test_a_slow_newtonian_flow_is_that_of_laminar_viscosity(viscosity):
    # In a shear flow the transposed part has no divergence, and at a shear rate of 0.1 1/s the eddy viscosity
    # (0.12 dp)^2 0.1 is 4e-6 of the laminar one.
    _, v = profile(channel(10, drive=DRIVE, numerics={"viscosity": {"type": viscosity}}), 0.1)
    _, laminar = profile(channel(10, drive=DRIVE, numerics={"viscosity": {"type": "laminar"}}), 0.1)
    assert v == pytest.approx(laminar, abs=2e-5 * float(laminar.max()))


def power_law_error(particles_across: int, time: float = 1.0) -> float:
    """Largest deviation from the steady flow of a power-law fluid between plates, over the peak speed.

    u = n/(n+1) (G/K)^(1/n) (a^((n+1)/n) - |y|^((n+1)/n)), G the pressure gradient, a half the gap.
    """
    n, half, gradient = 0.5, 0.5 * GAP, DENSITY * DRIVE
    consistency = gradient / np.sqrt(3.0 * LID_SPEED / half**3)
    law = {"type": "herschel_bulkley", "consistency": consistency, "exponent": n, "largest": 5.0e-3}
    viscosity = {"type": "viscous_stress", "law": law}
    y, v = profile(channel(particles_across, drive=DRIVE, numerics={"viscosity": viscosity}), time)
    exact = LID_SPEED * (1.0 - (np.abs(y - half) / half) ** 3)
    return float(np.abs(v - exact).max() / LID_SPEED)


@pytest.mark.verification
def test_power_law_between_plates():
    # The wall is first order in dp, and at n = 1/2 the flow goes with the square of the wall's stress.
    errors = [power_law_error(n) for n in (8, 16)]
    assert errors[1] < 0.6 * errors[0]
    assert errors[1] < 2.0 / 16


@pytest.mark.verification
def test_viscosity_that_varies_in_space_sets_the_slopes():
    # Couette flow of two layers, the upper twice as viscous: its slope is half that of the lower one, and the
    # layers meet at two thirds of the speed of the lid. Between the layers and at the walls a spacing is lost.
    law = {
        "type": "newtonian",
        "viscosity": f"where(y > {0.5 * GAP}, 2.0e-3, 1.0e-3)",
        "largest": 2.0e-3,
    }
    viscosity = {"type": "viscous_stress", "law": law}
    y, v = profile(channel(20, lid_speed=LID_SPEED, numerics={"viscosity": viscosity}), 2.0)
    lower, upper = (y > 0.15 * GAP) & (y < 0.35 * GAP), (y > 0.65 * GAP) & (y < 0.85 * GAP)
    slopes = [np.polyfit(y[part], v[part], 1)[0] for part in (lower, upper)]
    assert slopes[0] / slopes[1] == pytest.approx(2.0, rel=0.02)
    assert slopes[0] == pytest.approx(4.0 / 3.0 * LID_SPEED / GAP, rel=0.05)


@pytest.mark.parametrize("dimension", [2, 3])
def test_sub_particle_stress_of_a_uniform_strain(dimension):
    # The drop is stretched by v = s (x, -y): G = s diag(1, -1), shear rate 2 s; so with nu_t = (0.12 dp)^2 2 s the
    # stress is rho (2 nu_t G - 2/3 0.0066 dp^2 (2 s)^2). Renormalised gradients are exact, up to the surface too.
    spacing, rate = 0.1, 0.5
    scene = free_drop(dimension, spacing, numerics={"viscosity": {"type": "sub_particle_scale"}})
    sim = Simulation(scene, device="cpu")
    model = sim.system.parts.fluid._stress
    model.find()
    diagonal = np.array([1.0, -1.0, 0.0])[:dimension]
    nu_t = (0.12 * spacing) ** 2 * 2.0 * rate
    isotropic = 2.0 / 3.0 * 0.0066 * spacing**2 * (2.0 * rate) ** 2
    expected = np.diag(DENSITY * (2.0 * nu_t * rate * diagonal - isotropic))
    stress = model.stress.numpy()
    inside = np.all(np.abs(sim.array("position").numpy() - 0.5) < 0.35, axis=1)
    assert stress[inside] == pytest.approx(
        np.broadcast_to(expected, stress[inside].shape), abs=1e-5 * abs(expected).max()
    )


def test_the_force_on_the_walls_is_the_opposite_of_what_the_fluid_receives():
    law = {"type": "carreau", "zero_viscosity": 1.0e-3, "time": 10.0}
    numerics = {"precision": "double", "viscosity": {"type": "viscous_stress", "law": law}}
    sim = Simulation(channel(10, lid_speed=LID_SPEED, numerics=numerics), device="cpu")
    sim.advance(0.01)
    frame = sim.frame(["mass", "force"], ordered=False)
    sim.system.parts.fluid.accelerate()
    mass = frame.sets[0].fields["mass"]
    received = mass @ sim.array("acceleration").numpy()[: len(mass)]
    exerted = sum(wall.fields["force"].sum(axis=0) for wall in frame.of_kind("boundary"))
    assert np.abs(exerted[0]) > 0.0
    assert received == pytest.approx(-exerted, abs=1e-12 * np.abs(received).max())


def test_carried_viscosity_follows_its_particle():
    law = {"type": "newtonian", "viscosity": "1.0 + x + 10.0 * y", "largest": 20.0}
    scene = free_drop(2, 0.1, numerics={"viscosity": {"type": "viscous_stress", "law": law}})
    sim = Simulation(scene, device="cpu")
    start = {}
    for moment in range(2):
        carried = sim.system.parts.fluid._stress.carried.numpy()[np.argsort(sim.array("id").numpy())]
        start.setdefault(moment, carried)
        sim.advance(0.3)
        sim.system.stepper.renew_lists()
    position = Simulation(scene, device="cpu").frame().sets[0].fields["position"]
    assert start[0] == pytest.approx(1.0 + position @ [1.0, 10.0], rel=1e-6)
    assert np.array_equal(start[0], start[1])


def test_a_varying_viscosity_needs_a_cap():
    law = {"type": "newtonian", "viscosity": "1.0 + x"}
    with pytest.raises(ValueError, match="needs a cap"):
        free_drop(numerics={"viscosity": {"type": "viscous_stress", "law": law}})


def test_the_physical_viscosity_limits_the_step():
    # h^2 / (8 nu) with the largest viscosity of the law.
    law = {"type": "carreau", "zero_viscosity": 8.0 * DENSITY * VISCOSITY, "time": 1.0}
    scene = channel(10, drive=DRIVE, numerics={"viscosity": {"type": "viscous_stress", "law": law}})
    report = Simulation(scene, device="cpu").step()
    h = 1.5 * GAP / 10
    assert report.limit == "viscous"
    assert report.dt == pytest.approx(h * h / (64.0 * VISCOSITY), rel=1e-12)
