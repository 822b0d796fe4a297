"""Viscosity and the tangential condition at walls, against closed forms of channel flow."""

import numpy as np
import pytest
from builders import GAP, VISCOSITY, channel

from warpsph.solver.simulation import Simulation

pytestmark = pytest.mark.verification

DRIVE = 2.0e-4
LID_SPEED = 2.5e-5
LAMINAR = {"viscosity": {"type": "laminar"}}


def profile(sim: Simulation) -> tuple[np.ndarray, np.ndarray]:
    water = sim.frame(["velocity"]).sets[0].fields
    return water["position"][:, 1], water["velocity"][:, 0]


def poiseuille(y: np.ndarray, t: float) -> np.ndarray:
    """Start-up between plates at rest (Morris, Fox & Zhu 1997)."""
    v = DRIVE / (2.0 * VISCOSITY) * y * (GAP - y)
    for n in range(200):
        k = 2 * n + 1
        decay = np.exp(-((k * np.pi / GAP) ** 2) * VISCOSITY * t)
        v = v - 4.0 * DRIVE * GAP**2 / (VISCOSITY * np.pi**3 * k**3) * np.sin(np.pi * y * k / GAP) * decay
    return v


def couette(y: np.ndarray, t: float) -> np.ndarray:
    """Start-up under a plate that moves from t = 0 on (Morris, Fox & Zhu 1997)."""
    v = LID_SPEED * y / GAP
    for n in range(1, 400):
        decay = np.exp(-VISCOSITY * (n * np.pi / GAP) ** 2 * t)
        v = v + 2.0 * LID_SPEED / (n * np.pi) * (-1) ** n * np.sin(n * np.pi * y / GAP) * decay
    return v


def largest_error(scene, exact, t: float) -> float:
    sim = Simulation(scene, device="cpu")
    sim.advance(t)
    y, v = profile(sim)
    return float(np.abs(v - exact(y, t)).max() / np.abs(exact(np.linspace(0.0, GAP, 101), 10.0)).max())


@pytest.mark.parametrize("t", [0.0225, 0.225])
def test_poiseuille_start_up(t):
    # The velocity at the wall is first order in dp: the profile may be off by that of half a spacing, dp / (2 l).
    assert largest_error(channel(20, drive=DRIVE, numerics=dict(LAMINAR)), poiseuille, t) < 0.025


@pytest.mark.parametrize("t", [0.045, 0.225])
def test_couette_start_up(t):
    assert largest_error(channel(20, lid_speed=LID_SPEED, numerics=dict(LAMINAR)), couette, t) < 0.025


def test_poiseuille_converges():
    errors = [
        largest_error(channel(n, drive=DRIVE, numerics=dict(LAMINAR)), poiseuille, 0.1) for n in (10, 20)
    ]
    assert errors[1] < 0.6 * errors[0]


@pytest.mark.parametrize("wall", ["extrapolated", "dynamic"])
@pytest.mark.parametrize("viscosity", ["laminar", "artificial"])
def test_free_slip_walls_do_not_brake(wall, viscosity):
    # A uniform stream between frictionless plates gains exactly the impulse of the body force.
    numerics = {"viscosity": {"type": viscosity}, "wall": {"type": wall}}
    sim = Simulation(channel(12, drive=DRIVE, slip="free_slip", numerics=numerics), device="cpu")
    sim.advance(0.1)
    _, v = profile(sim)
    assert v == pytest.approx(np.full_like(v, DRIVE * 0.1), rel=1e-4)


@pytest.mark.parametrize("t", [0.045, 0.225])
def test_couette_start_up_between_structures(t):
    """An elastic floor, clamped at its foot, and a rigid lid that moves: the fluid sticks to both as to walls."""
    scene = channel(20, numerics=dict(LAMINAR))
    stiff = {"density": 1000.0, "youngs_modulus": 1.0, "poisson_ratio": 0.3}
    plates = {
        name: {"shape": plate.shape.model_dump(), "slip": "no_slip", "material": stiff}
        for name, plate in scene.boundaries.items()
    }
    low, high = plates["floor"]["shape"]["min"], plates["floor"]["shape"]["max"]
    foot = {"type": "box", "min": low, "max": (high[0], 0.5 * low[1])}
    plates["floor"]["clamps"] = {"foot": {"region": foot}}
    plates["lid"]["rigid"] = {"free": [], "motion": [{"type": "linear", "velocity": (LID_SPEED, 0.0)}]}
    scene = type(scene)(**scene.model_dump() | {"boundaries": {}, "structures": plates})
    assert largest_error(scene, couette, t) < 0.025


def test_no_slip_holds_for_dynamic_walls_too():
    scene = channel(20, drive=DRIVE, numerics=LAMINAR | {"wall": {"type": "dynamic"}})
    # Friction against the wall's own velocity puts the zero of the profile half a spacing into the wall: a gap that
    # is wider by dp lets (1 + dp/l)^2 - 1 = 10 per cent more through.
    assert largest_error(scene, poiseuille, 0.225) < 0.15
