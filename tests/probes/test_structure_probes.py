"""Probes of structures: exact where they must be, sums of mechanics elsewhere."""

import re
from dataclasses import replace

import numpy as np
import pytest
from particles import disordered, frame_of, lattice, probe_of
from scipy.spatial.transform import Rotation

from warpsph.frame import SetFrame
from warpsph.scene.errors import SceneError
from warpsph.scene.rigid import Rigid
from warpsph.scene.schema import Scene

DENSITY = 1000.0
SPACING = 0.1
ENERGIES = ("strain_energy", "hourglass_energy", "contact_energy", "dissipated", "work")


def beam_scene(probe, dimension=2, **changes):
    """A beam of length 1 and thickness 0.4, clamped at its left end."""
    high = [1.0, *[0.4] * (dimension - 1)]
    beam = {
        "shape": {"type": "box", "min": [0.0] * dimension, "max": high},
        "material": {"density": DENSITY, "youngs_modulus": 1e6, "poisson_ratio": 0.3},
        "clamps": {
            "root": {
                "region": {"type": "box", "min": [-1.0] * dimension, "max": [0.2, *[2.0] * (dimension - 1)]}
            }
        },
    }
    scene = {
        "name": "beam",
        "dimension": dimension,
        "spacing": SPACING,
        "gravity": [0.0] * (dimension - 1) + [-2.0],
        "time": {"end": 1.0, "frame_rate": 10.0},
        "structures": {"beam": beam},
        "probes": {"probe": probe},
    }
    return Scene.model_validate(scene | changes)


def body(rest, displacement=0.0, **fields):
    n, dimension = rest.shape
    u = np.broadcast_to(displacement, rest.shape)
    given = {
        "id": np.arange(n),
        "position": rest + u,
        "displacement": np.array(u),
        "velocity": np.zeros((n, dimension)),
        "reaction": np.zeros((n, dimension)),
        "mass": np.full(n, DENSITY * SPACING**dimension),
        **{name: np.zeros(n) for name in ENERGIES},
    }
    return SetFrame("beam", "structure", given | fields)


def displacement_probe(at, **changes):
    spec = {"type": "displacement", "structure": "beam", "at": list(at)}
    return probe_of(beam_scene(spec, len(at), **changes))


@pytest.mark.parametrize("at", [(0.52, 0.21), (1.0, 0.2), (1.0, 0.4), (0.0, 0.0, 0.0), (0.97, 0.4, 0.13)])
def test_linear_displacements_are_exact_inside_on_faces_and_at_corners(at):
    """u = c + H X is reproduced by a first-order consistent fit up to rounding, on jittered particles too."""
    dimension = len(at)
    rest = disordered(lattice([0.0] * dimension, [1.0, *[0.4] * (dimension - 1)]))
    gradient = np.random.default_rng(2).normal(size=(dimension, dimension))
    u, v = rest @ gradient.T + 3.0, 2.0 - rest @ gradient.T
    probe = displacement_probe(at)
    probe.start(frame_of(body(rest)))
    expected = [*(gradient @ np.array(at) + 3.0), *(2.0 - gradient @ np.array(at))]
    np.testing.assert_allclose(probe.evaluate(frame_of(body(rest, u, velocity=v))), expected, rtol=1e-11)


def test_the_point_is_one_of_the_body_at_rest_where_a_run_begins_displaced():
    """Weights come from the reference configuration, not from where the particles are at the start."""
    rest = lattice([0.0, 0.0], [1.0, 0.4])
    moved = body(rest, np.array([5.0, -3.0]))
    probe = displacement_probe((1.0, 0.2))
    probe.start(frame_of(moved))
    assert probe.evaluate(frame_of(moved))[:2] == pytest.approx((5.0, -3.0), abs=1e-12)


def test_a_single_row_of_particles_is_exact_for_fields_along_it():
    rest = lattice([0.0, 0.0], [1.0, 0.1])
    u = np.column_stack([0.3 * rest[:, 0], 2.0 * rest[:, 0]])
    scene = beam_scene({"type": "displacement", "structure": "beam", "at": [1.0, 0.1]})
    probe = probe_of(scene)
    probe.start(frame_of(body(rest)))
    assert probe.evaluate(frame_of(body(rest, u)))[:2] == pytest.approx((0.3, 2.0), abs=1e-12)


def test_the_frame_of_a_moving_clamp_sees_the_deformation_alone():
    """A body that bends by w = a y, dw/dt = b y in the frame of its clamp, which turns and drifts.

    x = R (X + w - c) + c + V t, so that v = R dw/dt + omega x R (X + w - c) + V.
    """
    rate, center, drift, time = np.deg2rad(70.0), np.array([0.3, -0.2]), np.array([0.5, 2.0]), 0.8
    motion = [
        {"type": "rotation", "rate": 70.0, "center": center.tolist()},
        {"type": "linear", "velocity": drift.tolist()},
    ]
    clamp = {"region": {"type": "box", "min": [-1.0, -1.0], "max": [0.2, 2.0]}, "motion": motion}
    spec = {"type": "displacement", "structure": "beam", "at": [1.0, 0.2], "frame": "root"}
    beam = beam_scene(spec).structures["beam"].model_dump() | {"clamps": {"root": clamp}}
    probe = probe_of(beam_scene(spec, structures={"beam": beam}))
    rest = lattice([0.0, 0.0], [1.0, 0.4])
    w, w_rate = np.outer(rest[:, 1], [0.3, -0.1]), np.outer(rest[:, 1], [-4.0, 7.0])
    turn = np.array([[np.cos(rate * time), -np.sin(rate * time)], [np.sin(rate * time), np.cos(rate * time)]])
    arm = (rest + w - center) @ turn.T
    velocity = w_rate @ turn.T + rate * np.column_stack([-arm[:, 1], arm[:, 0]]) + drift
    probe.start(frame_of(body(rest)))
    moved = frame_of(body(rest, arm + center + drift * time - rest, velocity=velocity))
    expected = [0.06, -0.02, -0.8, 1.4]
    np.testing.assert_allclose(probe.evaluate(replace(moved, time=time)), expected, rtol=1e-11)


def test_the_frame_of_a_clamp_at_rest_is_at_rest():
    rest = lattice([0.0, 0.0], [1.0, 0.4])
    probe = probe_of(
        beam_scene({"type": "displacement", "structure": "beam", "at": [1.0, 0.2], "frame": "root"})
    )
    probe.start(frame_of(body(rest)))
    assert probe.evaluate(frame_of(body(rest, np.array([0.2, 0.1]))))[:2] == pytest.approx((0.2, 0.1))


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_the_angle_of_a_rigid_rotation_is_its_own(axis):
    """A right-handed turn by 2.5 rad about any axis, seen by a point on an edge."""
    rest = lattice([0.0] * 3, [1.0, 0.4, 0.4])
    about = np.array([0.3, 0.1, -0.2])
    turn = Rotation.from_rotvec(2.5 * np.eye(3)["xyz".index(axis)])
    spec = {"type": "rotation", "structure": "beam", "at": [1.0, 0.4, 0.2], "about": about.tolist()}
    probe = probe_of(beam_scene(spec | {"axis": axis}, 3))
    probe.start(frame_of(body(rest)))
    moved = body(rest, turn.apply(rest - about) - (rest - about))
    assert probe.evaluate(frame_of(moved))[0] == pytest.approx(2.5, abs=1e-12)


def test_a_point_outside_of_the_structure_is_refused():
    probe = displacement_probe((1.2, 0.2))
    with pytest.raises(SceneError, match=r"probes\.probe\.at"):
        probe.start(frame_of(body(lattice([0.0, 0.0], [1.0, 0.4]))))


def test_reaction_sums_the_clamped_particles_only_with_their_torque():
    rest = lattice([0.0, 0.0], [1.0, 0.4])
    force = np.random.default_rng(3).normal(size=rest.shape)
    held = rest[:, 0] < 0.2
    probe = probe_of(
        beam_scene({"type": "reaction", "structure": "beam", "clamp": "root", "about": [0.5, 1.0]})
    )
    frame = frame_of(body(rest, reaction=force))
    probe.start(frame)
    arm = rest[held] - np.array([0.5, 1.0])
    torque = np.sum(arm[:, 0] * force[held, 1] - arm[:, 1] * force[held, 0])
    np.testing.assert_allclose(probe.evaluate(frame), [*force[held].sum(axis=0), torque], rtol=1e-12)


def test_energies_are_sums_and_the_total_balances_them():
    """total = kinetic + strain + hourglass + contact + potential + dissipated - work."""
    rest = lattice([0.0, 0.0], [1.0, 0.4])
    n = len(rest)
    velocity = np.tile([3.0, -4.0], (n, 1))
    sums = dict(zip(ENERGIES, (5.0, 0.5, 0.25, 2.0, 7.0), strict=True))
    fields = {name: np.full(n, total / n) for name, total in sums.items()}
    frame = frame_of(body(rest, np.array([0.0, -0.3]), velocity=velocity, **fields))
    probe = probe_of(beam_scene({"type": "structure_energy"}))
    values = dict(zip(probe.columns, probe.evaluate(frame), strict=True))
    mass = DENSITY * 0.4
    assert values["probe.kinetic[J/m]"] == pytest.approx(0.5 * mass * 25.0)
    assert values["probe.potential[J/m]"] == pytest.approx(mass * 2.0 * -0.3)
    probe.start(frame)
    assert probe.evaluate(frame)[-1] == 0.0
    total = 0.5 * mass * 25.0 - mass * 0.6 + 5.0 + 0.5 + 0.25 + 2.0 - 7.0
    assert values["probe.total[J/m]"] == pytest.approx(total)


@pytest.mark.parametrize("dimension", [2, 3])
def test_momentum_of_a_rigid_motion(dimension):
    """A body that turns about the origin in the xy plane and drifts: p = M (w x X_c + V), L = sum x cross m v."""
    rest = lattice([0.0] * dimension, [1.0, *[0.4] * (dimension - 1)])
    velocity = np.zeros_like(rest)
    velocity[:, 0], velocity[:, 1] = -2.0 * rest[:, 1] + 1.0, 2.0 * rest[:, 0]
    probe = probe_of(beam_scene({"type": "momentum"}, dimension))
    values = probe.evaluate(frame_of(body(rest, velocity=velocity)))
    mass = DENSITY * 0.4 ** (dimension - 1)
    assert values[:2] == pytest.approx((mass * (-2.0 * 0.2 + 1.0), mass * 2.0 * 0.5))
    # the lattice's own second moments: those of its particles, each a point of mass
    inertia = mass * np.mean(np.sum(rest[:, :2] ** 2, axis=1))
    assert values[-1] == pytest.approx(2.0 * inertia - mass * 0.2)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_rigid_body_tells_the_rows_of_its_particles(dimension):
    """Components of the plane are x and y, and z of what turns."""
    rest = lattice([0.0] * dimension, [1.0, *[0.4] * (dimension - 1)])
    rows = np.arange(18.0).reshape(6, 3)
    flexible = beam_scene({"type": "momentum"}, dimension).structures["beam"]
    rigid = flexible.model_copy(update={"rigid": Rigid(), "clamps": {}})
    spec = {"type": "rigid_body", "structure": "beam"}
    probe = probe_of(beam_scene(spec, dimension, structures={"beam": rigid}))
    frame = frame_of(body(rest, rigid_motion=np.tile(rows, (len(rest), 1, 1))))
    values = dict(zip(probe.columns, probe.evaluate(frame), strict=True))
    unit = "N/m" if dimension == 2 else "N"
    assert values["probe.position_x[m]"] == 0.0
    assert values["probe.velocity_y[m/s]"] == 4.0
    assert values["probe.angle_z[rad]"] == 8.0
    assert values["probe.angular_velocity_z[rad/s]"] == 11.0
    assert values[f"probe.force_y[{unit}]"] == 13.0
    assert values["probe.torque_z[N m/m]" if dimension == 2 else "probe.torque_z[N m]"] == 17.0


@pytest.mark.parametrize(
    ("probe", "key"),
    [
        ({"type": "volume"}, "probes.probe.type"),
        (
            {"type": "rotation", "structure": "beam", "at": [1.0, 0.2], "about": [1.0, 0.2]},
            "probes.probe.at",
        ),
        ({"type": "displacement", "structure": "bean", "at": [0.0, 0.0]}, "probes.probe.structure"),
        ({"type": "reaction", "structure": "beam", "clamp": "rot"}, "probes.probe.clamp"),
        (
            {"type": "displacement", "structure": "beam", "at": [0.0, 0.0], "frame": "rot"},
            "probes.probe.frame",
        ),
        ({"type": "momentum", "structure": "bean"}, "probes.probe.structure"),
        ({"type": "momentum", "fluid": "beam"}, "probes.probe.fluid"),
    ],
)
def test_probes_of_what_is_not_there_are_refused(probe, key):
    with pytest.raises(ValueError, match=re.escape(key)):
        beam_scene(probe)
