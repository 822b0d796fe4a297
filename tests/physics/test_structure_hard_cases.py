"""Structures meant to break the scheme: each survives, with an error that is stated here."""

import numpy as np
import pytest
from structure_builders import (
    DENSITY,
    NU,
    YOUNG,
    block,
    deform,
    forces,
    gradients,
    jittered,
    reference_of,
    region,
    system_of,
)

from warpsph.particles.state import write_array
from warpsph.solver.errors import SimulationDiverged
from warpsph.solver.run import run_scene
from warpsph.solver.simulation import Simulation

STATIC = {"solution": {"type": "static", "tolerance": 1e-4}}


def elastic(ledger) -> float:
    return ledger.energies["strain"] + ledger.energies["hourglass"]


def tip_deflection(thick: int, nu: float, plane: str) -> float:
    """Of a beam of eight thicknesses that carries its weight, linear, over that of a Timoshenko beam."""
    spacing, length = 0.3 / thick, 2.4
    held = region((-1.0, -1.0), (0.0, 1.0))
    shape = {"type": "box", "min": (-2 * spacing, 0.0), "max": (length, 0.3)}
    scene = block(
        (length, 0.3),
        spacing=spacing,
        gravity=(0.0, -0.1),
        material={"law": "linear_elastic", "poisson_ratio": nu},
        structure={"shape": shape, "plane": plane, "clamps": {"root": {"region": held}}},
        numerics=STATIC,
        time={"end": 1.0, "frame_rate": 1.0},
    )
    simulation = Simulation(scene, device="cpu", threads=1)
    simulation.advance(1.0)
    X, u = reference_of(simulation.system), simulation.array("displacement").numpy()
    modulus = YOUNG / (1 - nu**2) if plane == "strain" else YOUNG
    weight, shear = DENSITY * 0.1 * 0.3, YOUNG / (2 * (1 + nu)) * 0.3 * 5.0 / 6.0
    beam = weight * length**4 / (8 * modulus * 0.3**3 / 12) + weight * length**2 / (2 * shear)
    return -u[X[:, 0] > length - spacing, 1].mean() / beam


@pytest.mark.parametrize(("thick", "error"), [(3, 0.03), (6, 0.015)])
def test_few_particles_through_the_thickness_bend_as_a_beam(thick, error):
    """Measured: -2.5 % with three particles, -1.0 % with six, -0.8 % with eight.

    Of second order in the spacing, (1/2n)^2 = 2.8 % and 0.7 %, beside some 0.5 % by which Timoshenko's clamp, free to
    warp, differs from one that holds the whole section.
    """
    assert abs(tip_deflection(thick, NU, "stress") - 1.0) < error


def test_a_poisson_ratio_near_one_half_does_not_lock():
    """In plane strain the beam is stiffer by 1/(1 - nu^2) alone; one that locks would hardly bend, at any spacing.

    Measured: -13 % with three particles through the thickness, -22 % with four, -8 % with six, -5 % with eight.
    """
    worst, fine = (tip_deflection(thick, 0.49, "strain") for thick in (4, 8))
    assert abs(worst - 1.0) < 0.25
    assert abs(fine - 1.0) < 0.3 * abs(worst - 1.0)


def pulled(law: str, speed: float, height: float):
    """A bar of one metre between clamps, the right one of which moves; in equilibrium at every tenth of a second."""
    clamps = {
        "left": {"region": region((0.0, 0.0), (0.2, height))},
        "right": {
            "region": region((1.2, 0.0), (1.4, height)),
            "motion": [{"type": "linear", "velocity": (speed, 0.0)}],
        },
    }
    scene = block(
        (1.4, height),
        material={"law": law},
        structure={"clamps": clamps},
        numerics=STATIC,
        time={"end": 1.0, "frame_rate": 10.0},
    )
    simulation = Simulation(scene, device="cpu", threads=1)
    simulation.run()
    return simulation


def uniaxial_neo_hookean(stretch: float) -> tuple[float, float]:
    """Stretch across and Cauchy stress along, where nothing acts across: mu (t^2 - 1) + lambda ln(s t) = 0."""
    lame, mu = YOUNG * NU / ((1 + NU) * (1 - 2 * NU)), YOUNG / (2 * (1 + NU))
    low, high = 0.01, 10.0
    for _ in range(100):
        t = 0.5 * (low + high)
        low, high = (low, t) if mu * (t**2 - 1) + lame * np.log(stretch * t) > 0 else (t, high)
    J = stretch * t
    return t, (mu * (stretch**2 - 1) + lame * np.log(J)) / J


def test_a_bar_stretched_to_three_times_its_length():
    """In the middle the state is that of uniaxial stretch; the clamps are more than a width away."""
    simulation = pulled("neo_hookean", 2.3, 0.3)
    X = reference_of(simulation.system)
    mid = int(np.argmin(np.linalg.norm(X - [0.65, 0.15], axis=1)))
    F = gradients(simulation.system)[mid] + np.eye(2)
    stress = simulation.frame(("cauchy_stress",)).sets[0].fields["cauchy_stress"][mid]
    across, along = uniaxial_neo_hookean(F[0, 0])
    assert F[0, 0] > 3.0
    assert F[1, 1] == pytest.approx(across, rel=0.01)
    assert stress[0, 0] == pytest.approx(along, rel=0.01)


@pytest.mark.parametrize("law", ["neo_hookean", "split_neo_hookean"])
def test_a_block_compressed_to_half_its_length(law):
    """Laws whose energy grows without bound as J goes to zero hold; the hourglass penalty does not carry the block."""
    simulation = pulled(law, -0.52, 0.8)
    X, u = reference_of(simulation.system), simulation.array("displacement").numpy()
    x = X + u
    axis = (X[:, 0] > 0.2) & (X[:, 0] < 1.2) & (abs(X[:, 1] - 0.4) < 0.1)
    assert np.ptp(x[axis, 0]) < 0.5 * np.ptp(X[axis, 0])
    energies = simulation.ledger().energies
    # From a quarter on, a summary would warn that the penalty carries the result. Measured: 2 % and 1 %.
    assert energies["hourglass"] < 0.25 * elastic(simulation.ledger())


def test_st_venant_kirchhoff_softens_under_compression():
    """P = s (lambda + 2 mu)(s^2 - 1)/2 has its extreme at s = 1/sqrt(3) = 0.577, where dP/ds is zero."""
    one = system_of(block((0.9, 0.8)))
    X, stress = reference_of(one), {}
    for s in (0.62, 0.577, 0.53):
        deform(one, X * [s - 1.0, 0.0])
        sigma = one.frame_sets(("cauchy_stress",), ordered=True)[0].fields["cauchy_stress"]
        stress[s] = sigma[0, 0, 0]  # along x; the cross section does not change, so that P = sigma here
    assert stress[0.577] < min(stress[0.62], stress[0.53])


def checkerboard(amplitude: float, law: str, damping: float = 0.0) -> Simulation:
    scene = block((1.0, 0.6), material={"law": law}, structure={"damping": damping})
    simulation = Simulation(scene, device="cpu", threads=1)
    cells = np.rint(reference_of(simulation.system) / 0.1 - 0.5).astype(int)
    sign = np.where(cells.sum(axis=1) % 2, 1.0, -1.0)
    deform(simulation.system, 0.1 * amplitude * sign[:, None] * [1.0, 0.0])
    return simulation


@pytest.mark.parametrize(("amplitude", "law"), [(0.02, "st_venant_kirchhoff"), (0.3, "neo_hookean")])
def test_a_checkerboard_dies_out_with_damping(amplitude, law):
    """Damping c lets an amplitude fall by exp(-c t / 2), its energy by exp(-c t) = 0.7 % in the mean."""
    simulation = checkerboard(amplitude, law, damping=50.0)
    start = simulation.ledger()
    assert start.energies["hourglass"] > 0.5 * elastic(start)
    simulation.advance(0.1)
    end = simulation.ledger()
    assert end.energies["hourglass"] < 0.03 * start.energies["hourglass"]


@pytest.mark.parametrize(
    ("amplitude", "law"), [(0.02, "st_venant_kirchhoff"), (0.1, "st_venant_kirchhoff"), (0.1, "neo_hookean")]
)
def test_a_checkerboard_without_damping_is_bounded(amplitude, law):
    """It rings at nearly the largest frequency omega, where Verlet does not conserve the sum itself.

    What it conserves differs by up to (omega dt / 2)^2 = cfl^2 = 0.8^2 of the potential part: a bound for all times.
    """
    simulation = checkerboard(amplitude, law)
    start = elastic(simulation.ledger())
    for k in range(1, 11):
        simulation.advance(0.05 * k)
        ledger = simulation.ledger()
        assert ledger.kinetic_energy + elastic(ledger) < start / (1.0 - 0.8**2)
        assert ledger.energies["hourglass"] < start


def noisy(cfl: float, steps: int) -> tuple[float, float]:
    """Energy before and after steps at a part of the limit, from displacements at random."""
    one = system_of(block((0.6, 0.4), material={"law": "linear_elastic"}))
    rng = np.random.default_rng(8)
    deform(one, 1e-4 * rng.normal(size=reference_of(one).shape))
    start = one.ledger()
    one.stepper.begin(cfl * 2.0 / one.stepper.frequency, steps)
    for _ in range(steps):
        one.stepper.sub_step()
    end = one.ledger()
    return elastic(start), end.kinetic_energy + elastic(end)


def test_nine_tenths_of_the_limit_are_stable():
    start, end = noisy(0.9, 5000)
    assert end < 2.0 * start


def test_the_limit_is_real():
    """Power iteration approaches the largest frequency from below, by 3 % at most here: 1.1 is beyond the limit."""
    start, end = noisy(1.1, 100)
    assert not end < 1e6 * start


def test_jittered_particles_move_and_keep_their_energy():
    """Off the lattice by up to a fifth of the spacing: F is exact, so is the balance; the body swings on."""
    scene = block((0.8, 0.4), structure={"velocity": ["-2*y", "4*x"]})
    one = system_of(scene, jittered(scene))
    X = reference_of(one)
    velocity = np.column_stack([-2.0 * X[:, 1], 4.0 * X[:, 0]])
    write_array(one.parts.model.state.velocity, velocity)
    start = one.ledger()
    one.set_target(0.5)
    steps = 0
    while one.time < 0.5:
        steps += one.step(steps).count
    end = one.ledger()
    assert steps > 100
    total = end.kinetic_energy + elastic(end)
    assert total == pytest.approx(start.kinetic_energy, rel=0.01)
    assert elastic(end) < 0.5 * total
    assert one.extremes["flattening"] < -0.5


@pytest.mark.parametrize(("part", "softer"), [(0.1, 1.2), (0.2, 1.5)])
def test_a_jittered_cantilever_is_softer_by_what_the_page_of_the_scheme_says(part, softer):
    """A uniform stress exerts no force inside; at the surface nothing makes it consistent, and bending strains that."""
    held = {"clamps": {"root": {"region": region((-0.1, -0.1), (0.1, 0.3))}}}
    static = {"solution": {"type": "static", "tolerance": 1e-3}}
    scene = block((1.0, 0.2), 0.05, hourglass=0.4, gravity=(0.0, -0.5), structure=held, numerics=static)
    lattice, scattered = tip_of(system_of(scene)), tip_of(system_of(scene, jittered(scene, part)))
    assert 1.0 < scattered / lattice < softer


def tip_of(one) -> float:
    """Mean deflection [m] of the last tenth of a bar at rest."""
    one.set_target(1.0)
    while one.time < 1.0:
        one.step(0)
    return float(one.parts.model.state.displacement.numpy()[reference_of(one)[:, 0] > 0.9, 1].mean())


def test_a_strip_a_hundred_times_as_long_as_thick_bends_and_keeps_its_energy():
    """Bent to an arc of half a turn: (lambda + 2 mu) I k^2 L / 2, less 1/n^2 = 11 % of a sum over n = 3 layers.

    Released, 18 % of that rings across the thickness near the largest frequency, where Verlet's energy is off by up to
    cfl^2 = 16 %: 3 % of all.
    """
    thick, length = 0.03, 3.0
    scene = block((length, thick), spacing=0.01, numerics={"cfl": 0.4})
    simulation = Simulation(scene, device="cpu", threads=1)
    X = reference_of(simulation.system)
    curvature = np.pi / length
    angle, arm = curvature * X[:, 0], 1.0 / curvature - (X[:, 1] - 0.5 * thick)
    bent = np.column_stack([arm * np.sin(angle), 0.5 * thick + 1.0 / curvature - arm * np.cos(angle)])
    deform(simulation.system, bent - X)
    start = simulation.ledger()
    # The sections neither shrink nor grow in this arc: lambda + 2 mu instead of E'.
    stiffness = YOUNG * (1 - NU) / ((1 + NU) * (1 - 2 * NU))
    expected = 0.5 * stiffness * thick**3 / 12 * curvature**2 * length
    assert elastic(start) == pytest.approx(expected, rel=0.15)
    while simulation.step_count < 1000:
        simulation.step()
    end = simulation.ledger()
    assert end.kinetic_energy > 0.0
    assert end.kinetic_energy + elastic(end) == pytest.approx(elastic(start), rel=0.03)
    assert simulation.extremes["flattening"] < -0.98


CRUSHED = {"velocity": ["-150*(x-0.3)", "0"]}


def test_an_inverted_particle_stops_the_run_with_its_place():
    scene = block((0.6, 0.4), structure=CRUSHED, time={"end": 1.0})
    simulation = Simulation(scene, device="cpu", threads=1)
    with pytest.raises(SimulationDiverged, match="inverted") as caught:
        simulation.run()
    fault = caught.value
    assert fault.set == "block"
    assert fault.value <= 0.0
    assert 0.0 < fault.time < 0.1
    H = gradients(simulation.system)[fault.particle]
    assert np.linalg.det(np.eye(2) + H) == pytest.approx(fault.value, abs=1e-12)
    place = simulation.frame().set_named("block").fields["position"][fault.particle]
    assert fault.position == pytest.approx(tuple(place))
    # It is the first step that does it: all were well one step before.
    assert fault.step == pytest.approx(fault.time / simulation.system.stepper.stable_step, rel=1.0)


def test_what_was_written_before_an_inversion_is_kept(tmp_path):
    scene = block((0.6, 0.4), structure=CRUSHED, time={"end": 1.0, "frame_rate": 5000.0},
                  output={"checkpoint_every": 1, "hdf5": True})  # fmt: skip
    with pytest.raises(SimulationDiverged):
        run_scene(scene, tmp_path, device="cpu", threads=1)
    names = {path.name for path in tmp_path.iterdir()}
    assert {"scene.yaml", "summary.json", "particles.usdc", "frames.h5", "checkpoint.h5"} <= names
    assert '"status": "diverged' in (tmp_path / "summary.json").read_text()


SHEETS = {"plane": (0.5, 0.4, 0.1), "chain": (0.8, 0.1, 0.1)}


@pytest.mark.parametrize("size", SHEETS.values(), ids=SHEETS)
def test_what_is_one_particle_thick_is_told_and_turns_without_stress(size):
    one = system_of(block(size))
    (warning,) = one.warnings({})
    told = "all their neighbours in one plane" if size[1] > 0.1 else "carry no stress"
    assert told in warning
    assert one.parts.bonds.thin.all()
    c, s = np.cos(1.1), np.sin(1.1)
    R = np.array([[1, 0, 0], [0, c, -s], [0, s, c]]) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    X = reference_of(one)
    deform(one, X @ (R - np.eye(3)).T)
    assert np.abs(forces(one)).max() < 1e-12 * YOUNG
    assert elastic(one.ledger()) < 1e-20 * YOUNG


def test_a_plane_spins_over_and_keeps_its_energy():
    """About an axis in the plane, fast enough to stretch it by a per cent; energy and spin stay."""
    scene = block(SHEETS["plane"], structure={"velocity": ["0", "0", "-20*(x-0.25)"]}, time={"end": 0.5})
    simulation = Simulation(scene, device="cpu", threads=1)
    start = simulation.ledger()
    simulation.advance(0.5)
    end = simulation.ledger()
    assert elastic(end) > 1e-3 * start.kinetic_energy
    assert end.kinetic_energy + elastic(end) == pytest.approx(start.kinetic_energy, rel=5e-3)
    drift = np.subtract(end.angular_momentum, start.angular_momentum)
    assert np.abs(drift).max() < 1e-10 * np.abs(start.angular_momentum).max()


def test_a_plane_resists_stretch_along_itself():
    """P_11 = s (lambda + 2 mu)(s^2 - 1)/2: no stretch is assumed across the plane; sigma_11 = s P_11 / J = P_11."""
    one = system_of(block(SHEETS["plane"]))
    deform(one, reference_of(one) * [0.01, 0.0, 0.0])
    stress = one.frame_sets(("cauchy_stress",), ordered=True)[0].fields["cauchy_stress"]
    lame, mu = YOUNG * NU / ((1 + NU) * (1 - 2 * NU)), YOUNG / (2 * (1 + NU))
    strain = 0.5 * (1.01**2 - 1)
    assert stress[:, 0, 0] == pytest.approx(1.01 * (lame + 2 * mu) * strain, rel=1e-9)
