"""Contact with walls and its friction: slopes, moving walls, the force on a wall, resumed runs."""

import numpy as np
import pytest
from contact_builders import SPACING, body, centre, on_slope, simulate, total, touching, two_blocks
from structure_builders import region

from warpsph.particles.state import host_view

G = 9.81
MASS = 1000.0 * 0.6 * 0.3
DAMPING = 20.0


def settled(angle: float, friction: float):
    """A damped block on a slope after 0.4 s, when its bounces have died away."""
    simulation = simulate(on_slope(angle, friction, DAMPING))
    simulation.advance(0.4)
    return simulation


def wall_force(simulation) -> np.ndarray:
    return np.asarray(simulation.frame(("force",)).set_named("floor").fields["force"]).sum(axis=0)


def test_a_wall_carries_what_lies_on_it():
    simulation = settled(0.0, 0.0)
    simulation.advance(0.8)
    force = wall_force(simulation)
    assert force == pytest.approx([0.0, -MASS * G], rel=1e-3, abs=1e-3 * MASS * G)


def test_a_block_slides_down_a_smooth_slope():
    """a = g sin(alpha); bumps of the lattice would slow it down. Bounces of the block last, as nothing damps them."""
    simulation = simulate(on_slope(5.0, 0.0))
    start = centre(simulation, "block")
    simulation.advance(0.8)
    way = centre(simulation, "block") - start
    assert way[0] == pytest.approx(0.5 * G * np.sin(np.radians(5.0)) * 0.8**2, rel=0.01)
    assert abs(way[1]) < 0.05 * SPACING


@pytest.mark.parametrize("angle", [5.0, 10.0, 16.0])
def test_a_block_sticks_below_the_angle_of_friction(angle):
    """tan(16 degrees) = 0.287 < 0.3: no creep, and the wall holds the block with m g sin(alpha)."""
    simulation = settled(angle, 0.3)
    place = centre(simulation, "block")
    simulation.advance(0.8)
    assert np.abs(centre(simulation, "block") - place).max() < 1e-4 * SPACING
    a = np.radians(angle)
    assert wall_force(simulation) == pytest.approx([MASS * G * np.sin(a), -MASS * G * np.cos(a)], rel=2e-3)


@pytest.mark.parametrize("angle", [18.0, 20.0, 30.0])
def test_a_block_slides_above_the_angle_of_friction(angle):
    """Damped at the rate k it approaches v = g (sin alpha - mu cos alpha) / k.

    The forces along the slope are met to 1 % of the force of friction: the lattice's bumps, see the sliding lattices.
    """
    simulation = settled(angle, 0.3)
    place = centre(simulation, "block")
    simulation.advance(0.8)
    speed = (centre(simulation, "block") - place)[0] / 0.4
    a = np.radians(angle)
    pull, friction = G * np.sin(a), 0.3 * G * np.cos(a)
    assert DAMPING * speed == pytest.approx(pull - friction, abs=0.01 * friction)


def test_friction_stops_a_block_and_keeps_the_books():
    """It rests after v^2 / (2 mu g), and its kinetic energy has become heat; the sum of all energies holds to 1 %.

    Starting from touch it also falls into its contact and bounces, which gives friction a little more to take.
    """
    speed = 1.0
    simulation = simulate(on_slope(0.0, 0.3, speed=speed))
    start, energy = centre(simulation, "block"), total(simulation)
    simulation.advance(1.0)
    ledger = simulation.ledger()
    way = (centre(simulation, "block") - start)[0]
    assert way == pytest.approx(speed**2 / (2 * 0.3 * G), rel=0.05)
    assert ledger.energies["dissipated"] == pytest.approx(0.5 * MASS * speed**2, rel=0.05)
    assert total(simulation) == pytest.approx(energy, abs=0.01 * 0.5 * MASS * speed**2)


def test_friction_between_structures_keeps_momentum():
    """Two blocks that rub: friction is opposite in pairs as well, and heat comes out of the motion."""
    scene = two_blocks(gap=0.0, speed=0.5, contact={"friction": 0.5}, gravity=(0.0, 0.0))
    structures = {name: dict(one) for name, one in scene.model_dump()["structures"].items()}
    structures["left"]["velocity"] = (0.5, 1.0)
    simulation = simulate(scene.model_validate(scene.model_dump() | {"structures": structures}))
    before, energy = simulation.ledger(), total(simulation)
    simulation.advance(0.1)
    after = simulation.ledger()
    assert after.energies["dissipated"] > 0.01 * energy
    assert after.momentum == pytest.approx(before.momentum, abs=1e-10 * 160.0)
    assert total(simulation) == pytest.approx(energy, rel=0.01)


def pushed():
    """A wall that moves at 0.2 m/s pushes a free block, from touch."""
    wall = {
        "shape": region((-0.1, -0.3), (0.0, 0.8)),
        "side": "solid",
        "motion": [{"type": "linear", "velocity": (0.2, 0.0)}],
    }
    return touching(
        {"block": body((0.0, 0.0), (0.4, 0.4))},
        boundaries={"wall": wall},
        probes={"push": {"type": "force", "boundary": "wall"}},
    )


def test_a_moving_wall_pushes_a_block():
    """An elastic bounce off a wall at the speed V leaves a body at rest with 2 V less what then oscillates in it.

    The work of the wall is the energy of the block, and equals V times the momentum given.
    """
    simulation = simulate(pushed())
    simulation.advance(0.5)
    ledger = simulation.ledger()
    speed = centre(simulation, "block", "velocity")[0]
    assert 0.3 < speed < 0.4
    energies = ledger.energies
    held = ledger.kinetic_energy + energies["strain"] + energies["hourglass"] + energies["contact"]
    assert energies["work"] == pytest.approx(held, rel=0.01)
    assert energies["work"] == pytest.approx(0.2 * ledger.momentum[0], rel=1e-3)
    wall = simulation.frame(("position", "velocity")).set_named("wall").fields
    assert wall["position"].max(axis=0)[0] == pytest.approx(-0.05 + 0.2 * 0.5)
    assert np.all(wall["velocity"] == [0.2, 0.0])


def test_a_turning_wall_carries_what_lies_on_it():
    """A slowly turning table: the block stays on it by friction."""
    table = {
        "shape": region((-0.5, -SPACING), (1.1, 0.0)),
        "side": "solid",
        "motion": [{"type": "rotation", "rate": np.degrees(0.2), "center": (0.3, 0.0)}],
    }
    scene = touching(
        {"block": body((0.0, 0.0), (0.6, 0.3), damping=DAMPING)},
        contact={"friction": 0.6},
        gravity=(0.0, -G),
        boundaries={"table": table},
    )
    simulation = simulate(scene)
    simulation.advance(1.0)
    angle = 0.2
    turned = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    expected = turned @ [0.0, 0.15] + [0.3, 0.0]
    assert centre(simulation, "block") == pytest.approx(expected, abs=0.1 * SPACING)


@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_a_resumed_run_has_the_same_bits(friction):
    def fresh():
        return simulate(two_blocks(speed=2.0, shift=0.1, contact={"friction": friction}))

    whole, first = fresh(), fresh()
    for simulation in (whole, first):
        simulation.advance(0.02)
    second = fresh()
    second.load_state(first.save_state())
    for simulation in (whole, second):
        simulation.advance(0.05)
    assert whole.step_count == second.step_count
    for name in ("displacement", "velocity", "dissipated"):
        assert np.array_equal(host_view(whole.array(name)), host_view(second.array(name)))


def test_static_contact_comes_to_rest():
    """A block on a floor in equilibrium: the floor carries its weight, and it lies a small depth in it."""
    scene = on_slope(0.0, 0.0, numerics={"structure": {"solution": {"type": "static"}}})
    simulation = simulate(scene)
    simulation.advance(1.0)
    assert wall_force(simulation)[1] == pytest.approx(-MASS * G, rel=0.01)


def test_contact_does_not_reach_over_periodic_faces():
    with pytest.raises(ValueError, match="periodic"):
        simulate(two_blocks(domain={"periodic": {"y": (0.0, 2.0)}}))


def test_walls_that_are_left_out_while_far_change_nothing(monkeypatch):
    """A block slides from one end of a long floor towards the other, into walls that were out of its reach at first."""

    def slide(leeway: float):
        monkeypatch.setattr("warpsph.physics.contact.LEEWAY", leeway)
        simulation = simulate(on_slope(30.0, 0.1, speed=3.0))
        model = simulation.system.parts.contact.model
        near_at_first = len(model.near)
        simulation.advance(0.4)
        return simulation, near_at_first, model

    few, near, model = slide(2.0)
    all_of_them, _, whole = slide(1e3)
    assert near < 0.7 * model.count
    assert len(whole.near) == whole.count
    assert centre(few, "block")[0] > 1.2
    for field in ("position", "velocity"):
        expected = all_of_them.frame((field,)).set_named("block").fields[field]
        assert np.array_equal(few.frame((field,)).set_named("block").fields[field], expected)
    assert np.array_equal(wall_force(few), wall_force(all_of_them))


def test_all_near_walls_are_looked_at_and_no_far_ones():
    model = simulate(on_slope(0.0, 0.0)).system.parts.contact.model
    places = host_view(model.arrays.position)
    structures, walls = places[: model.bodies], places[model.bodies :]
    distance = np.linalg.norm(walls[:, None] - structures, axis=2).min(axis=1)
    near = distance < (2.0 * 1.5 + 1.0 + 8.0) * SPACING  # support of the kernel, skin, leeway
    assert 0 < near.sum() < len(walls)
    assert np.array_equal(model.near, [*range(model.bodies), *(model.bodies + np.flatnonzero(near))])


def test_a_far_wall_that_moves_costs_few_lists():
    """A gate runs away from a block by ten spacings: lists are due with half the leeway, not with half the skin."""
    gate = {"shape": region((10.0, 0.0), (10.2, 0.5)), "side": "solid"}
    gate["motion"] = [{"type": "linear", "velocity": (5.0, 0.0)}]
    simulation = simulate(touching({"block": body((0.0, 0.0), (0.6, 0.3))}, boundaries={"gate": gate}))
    simulation.advance(0.2)
    by_half_the_skin = 10.0 / 0.5
    assert simulation.system.parts.contact.model.builds < 0.4 * by_half_the_skin
