"""Contact of structures: the penalty by hand, balances, bounces, self-contact and walls."""

import numpy as np
import pytest
from contact_builders import SPACING, body, centre, simulate, total, touching, two_blocks
from structure_builders import YOUNG, region

from warpsph.particles.launch import Launcher
from warpsph.particles.state import host_view, write_array
from warpsph.sampling import sample
from warpsph.solver.structure_system import StructureSystem


def shifted(scene, offset):
    """The system of two blocks, the second of them displaced as a whole, and the forces of contact (n, dim) [N]."""
    system = StructureSystem(scene, sample(scene), Launcher("cpu", 1))
    second = system.parts.bodies[1].range
    displacement = np.zeros_like(host_view(system.parts.model.state.displacement))
    displacement[second] = offset
    write_array(system.parts.model.state.displacement, displacement)
    system.stepper.find_forces()
    return system, np.array(host_view(system.parts.model.scratch.contact_force), dtype=float)


def energy_at(offset, **options) -> float:
    system, _ = shifted(two_blocks(gap=0.0, **options), offset)
    return system.ledger().energies["contact"]


def test_blocks_side_by_side_do_not_feel_each_other():
    """Particles one spacing apart are at the threshold c_0 or, at corners, below.

    Sides add particles at sqrt(8) spacings, whose weight 1e-5 counts as a depth of some 1e-5 spacings.
    """
    _, force = shifted(two_blocks(gap=0.0), (0.0, 0.0))
    assert np.abs(force).max() < 1e-4 * YOUNG * SPACING


@pytest.mark.parametrize("dimension", [2, 3])
def test_stiffness_is_that_of_cells(dimension):
    """Opposite particles of wide flat faces: force = stiffness E dp^(dim-2) depth, for small depths.

    Only a particle in the middle of a face has the whole layer before it: a face of 10 x 10, the innermost of them.
    """
    depth, wide = 1e-3 * SPACING, (1.0,) * (dimension - 1)
    low = (0.0,) * (dimension - 1)
    scene = touching(
        {"left": body((0.0, *low), (0.1, *wide)), "right": body((0.1, *low), (0.2, *wide))},
        contact={"stiffness": 0.7},
        dimension=dimension,
    )
    system, force = shifted(scene, (-depth, *low))
    position = host_view(system.parts.model.reference.position)[system.parts.bodies[0].range]
    inner = np.all(np.abs(position[:, 1:] - 0.5) < 0.1, axis=1)
    expected = -0.7 * YOUNG * SPACING ** (dimension - 2) * depth
    assert force[: len(inner)][inner, 0] == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("dimension", [2, 3])
def test_action_is_reaction(dimension):
    """Pair forces are opposite and central: neither a force nor a torque on the whole, for any position."""
    offset = np.array([-0.04, 0.013, 0.027])[:dimension]
    system, force = shifted(two_blocks(gap=0.0, shift=0.1, dimension=dimension), offset)
    model = system.parts.model
    x = host_view(model.reference.position) + host_view(model.state.displacement)
    scale = np.abs(force).sum()
    assert scale > 0.0
    assert np.abs(force.sum(axis=0)).max() < 1e-12 * scale
    moments = np.einsum("ni,nj->ij", x, force)
    assert np.abs(moments - moments.T).max() < 1e-12 * scale


def test_force_is_the_slope_of_the_energy():
    """Central differences of the energy of contact over a displacement of one body; their error is O(step^2)."""
    at, step = np.array([-0.03, 0.04]), 1e-6
    system, force = shifted(two_blocks(gap=0.0), at)
    on_second = force[system.parts.bodies[1].range].sum(axis=0)
    for axis in range(2):
        e = step * np.eye(2)[axis]
        slope = (energy_at(at + e) - energy_at(at - e)) / (2.0 * step)
        assert on_second[axis] == pytest.approx(-slope, rel=1e-6)


def test_lattices_slide_over_each_other():
    """A flat face along another feels at most 0.5 % of the normal force along itself, wherever the lattices are.

    A repulsion of single pairs within a spacing would hold them up with tan 30 degrees of it. The normal force itself
    keeps its value to 1 %.
    """
    scene = touching({"long": body((0.0, 0.0), (4.0, 0.1)), "short": body((1.0, 0.1), (3.0, 0.2))})
    ratios, normal = [], []
    for part in np.linspace(0.0, 1.0, 11):
        system, force = shifted(scene, (part * SPACING, -0.2 * SPACING))
        # The ends of the upper body meet other surroundings on their way; its inner half is periodic.
        own = system.parts.bodies[1].range
        middle = np.abs(host_view(system.parts.model.reference.position)[own, 0] - 2.0) < 0.5
        inner = force[own][middle].sum(axis=0)
        ratios.append(abs(inner[0] / inner[1]))
        normal.append(inner[1])
    assert max(ratios) < 5e-3
    assert normal == pytest.approx([normal[0]] * len(normal), rel=0.01)


@pytest.mark.parametrize("precision", ["single", "double"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_bounce_keeps_momentum_and_energy(dimension, precision):
    """A head-on bounce, off the middle; momentum to the rounding of sums of forces, energy within 1 %."""
    scene = two_blocks(speed=1.0, shift=0.1, dimension=dimension, numerics={"precision": precision})
    simulation = simulate(scene)
    before, energy = simulation.ledger(), total(simulation)
    worst = 0.0
    for k in range(1, 21):
        simulation.advance(0.005 * k)
        worst = max(worst, abs(total(simulation) / energy - 1.0))
    after = simulation.ledger()
    momentum = 1000.0 * 0.4**dimension * 1.0
    rounding = 1e-12 if precision == "double" else 2e-6
    assert np.abs(np.array(after.momentum) - before.momentum).max() < rounding * momentum
    spin = np.abs(np.array(after.angular_momentum) - before.angular_momentum).max()
    assert spin < 10.0 * rounding * momentum
    assert centre(simulation, "left", "velocity")[0] < 0.0 < centre(simulation, "right", "velocity")[0]
    assert worst < 0.01


def test_energy_error_of_a_bounce_falls_with_the_square_of_the_step():
    """Velocity Verlet: a quarter of the energy error at half the step, within a factor of two in a single event."""
    errors = []
    for cfl in (0.8, 0.4, 0.2):
        simulation = simulate(two_blocks(numerics={"structure": {"cfl": cfl}}))
        start, worst = total(simulation), 0.0
        for k in range(1, 11):
            simulation.advance(0.01 * k)
            worst = max(worst, abs(total(simulation) / start - 1.0))
        errors.append(worst)
    assert errors[0] > 2.0 * errors[1] > 4.0 * errors[2]
    assert errors[2] < 1e-3


def test_thin_plates_stop_each_other():
    """Two plates three particles thick, clamped at their ends; one flies at the other and does not pass through it."""
    ends = {
        "ends": {"region": region((-1.0, -1.0), (0.1, 1.0))},
        "far": {"region": region((1.9, -1.0), (3.0, 1.0))},
    }
    scene = touching(
        {
            "lower": body((0.0, -0.3), (2.0, 0.0), clamps=ends),
            "upper": body((0.0, 0.05), (2.0, 0.35), clamps=ends, velocity=("0", "-3 * x * (2 - x)")),
        }
    )
    simulation, start = simulate(scene), None
    for k in range(1, 21):
        simulation.advance(0.02 * k)
        start = start or total(simulation)
        frame = simulation.frame(("position",))
        lower, upper = (frame.set_named(name).fields["position"] for name in ("lower", "upper"))
        assert upper[:, 1].reshape(-1).min() > lower[:, 1].min()
        assert simulation.extremes["penetration"] < 0.5 * SPACING
        assert total(simulation) == pytest.approx(start, rel=0.01)


def fold(**contact):
    """A strip, three particles thick and bent to a hairpin, whose free arm flies at the other: (deepest, nearest).

    Its arms are 0.4 m apart, and the web between them bends. Returned are the deepest penetration and the least
    height of the upper arm's middle line over the lower arm's, in spacings.
    """
    shape = {
        "type": "union",
        "shapes": [
            region((0.0, 0.0), (2.0, 0.3)),
            region((0.0, 0.3), (0.3, 0.7)),
            region((0.0, 0.7), (2.0, 1.0)),
        ],
    }
    arm = {
        "shape": shape,
        "material": {"density": 1000.0, "youngs_modulus": 1.0e6, "poisson_ratio": 0.3, "law": "neo_hookean"},
        "clamps": {"base": {"region": region((-1.0, -1.0), (3.0, 0.15))}},
        "velocity": ("0", "where(y > 0.7, -3 * x, 0)"),
    }
    simulation = simulate(touching({"strip": arm}, contact=contact))
    rest = simulation.frame(("position",)).set_named("strip").fields["position"]
    tip = (rest[:, 0] > 1.5) & (rest[:, 1] > 0.7)
    deepest, nearest = 0.0, np.inf
    for k in range(1, 31):
        simulation.advance(0.01 * k)
        now = simulation.frame(("position",)).set_named("strip").fields["position"]
        deepest = max(deepest, simulation.extremes["penetration"])
        nearest = min(nearest, now[tip, 1].mean() - 0.15)
    return deepest / SPACING, nearest / SPACING


def test_a_folded_strip_does_not_pass_through_itself():
    """Arms of 0.3 m that touch have their middle lines 3 spacings apart; without contact they come nearer."""
    deepest, nearest = fold()
    assert 0.0 < deepest < 0.5
    assert nearest > 2.4
    assert fold(own_surface=False)[1] < 2.0


def test_a_body_does_not_touch_itself_at_rest_or_compressed():
    """Neighbours at rest are left out, and those that a compression to a half brings near stay below the threshold."""
    scene = touching({"block": body((0.0, 0.0), (2.0, 0.3))})
    system = StructureSystem(scene, sample(scene), Launcher("cpu", 1))
    X = host_view(system.parts.model.reference.position)
    write_array(system.parts.model.state.displacement, np.column_stack([-0.5 * X[:, 0], 0.0 * X[:, 1]]))
    system.stepper.find_forces()
    assert system.parts.contact.model.touches
    assert np.all(host_view(system.parts.model.scratch.contact_force) == 0.0)


def test_deep_penetration_is_told():
    scene = two_blocks(speed=6.0, contact={"stiffness": 0.05})
    simulation, deepest = simulate(scene), 0.0
    for k in range(1, 11):
        simulation.advance(0.002 * k)
        deepest = max(deepest, simulation.extremes["penetration"])
    assert deepest > 0.5 * SPACING
    (warning,) = simulation.system.warnings({"penetration": deepest})
    assert "spacings into each other" in warning
