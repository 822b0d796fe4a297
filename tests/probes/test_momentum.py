"""Momentum is a sum over the sets that count."""

import numpy as np
import pytest
from particles import DENSITY, fluid, frame_of, lattice, probe_of, scene_with, wall

from warpsph.frame import SetFrame
from warpsph.scene.schema import Structure

ELASTIC = {"youngs_modulus": 1e6, "poisson_ratio": 0.3}
MASS = DENSITY * 1.0
"""Of a block of 1 m x 1 m, per metre of depth [kg/m]."""


def water_at(low, velocity):
    position = lattice(low, [x + 1.0 for x in low])
    return fluid(position, velocity=np.tile(velocity, (len(position), 1)))


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_block_of_fluid_carries_its_mass_and_the_moment_of_its_centre(dimension):
    """p = M V and L = x_c cross p for a block in translation; walls do not count."""
    velocity = np.array([3.0, -4.0, 12.0][:dimension])
    water = water_at([1.0] * dimension, velocity)
    tank = wall(lattice([5.0] * dimension, [5.3] * dimension), velocity=np.ones((3**dimension, dimension)))
    values = probe_of(scene_with({"type": "momentum"}, dimension)).evaluate(frame_of(water, tank))
    centre = np.full(dimension, 1.5)
    moment = np.atleast_1d(np.cross(np.pad(centre, (0, 3 - dimension)), np.pad(velocity, (0, 3 - dimension))))
    expected = [*(MASS * velocity), *(MASS * moment[-1 if dimension == 2 else 0 :])]
    assert values == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("named", "expected"),
    [
        ({}, 1.0 + 20.0 + 300.0),
        ({"fluid": "water"}, 1.0),
        ({"structure": "raft"}, 300.0),
        ({"fluid": "water", "structure": "raft"}, 301.0),
    ],
)
def test_only_what_is_named_counts_and_everything_where_nothing_is(named, expected):
    """Two fluids and a structure, with 1, 20 and 300 m/s along x."""
    plain = scene_with({"type": "momentum"})
    raft = Structure(shape=plain.fluids["water"].shape, material={"density": DENSITY, **ELASTIC})
    sets = {"fluids": {"water": plain.fluids["water"], "oil": plain.fluids["water"]}}
    probe = plain.probes["probe"].model_copy(update=named)
    scene = plain.model_copy(update={**sets, "structures": {"raft": raft}, "probes": {"probe": probe}})
    water, oil, body = (
        water_at([0.0, y], [speed, 0.0]) for y, speed in ((0.0, 1.0), (2.0, 20.0), (4.0, 300.0))
    )
    frame = frame_of(water, SetFrame("oil", "fluid", oil.fields), SetFrame("raft", "structure", body.fields))
    assert probe_of(scene).evaluate(frame)[0] == pytest.approx(MASS * expected, rel=1e-12)
