"""A scene in other units of length, time and mass is the same scene: there is no number with a unit in the scheme.

With powers of two as the factors not even rounding differs, because a product, quotient or sum of scaled numbers is the
scaled one to the last bit; roots are taken of nothing but even powers. So is the whole way from the shapes to the state
at the end, with hydrostatic pressure, `auto` sound speed, walls, clamps, damping and sub-steps.
"""

import numpy as np
import pytest

from warpsph.validation.hard.case import Machine
from warpsph.validation.hard.scaled_scenes import Units, at_scale, basin, end_fields, rounding

DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])
KINDS = pytest.mark.parametrize("kind", ["fluid", "structure", "coupled"])
PRECISIONS = pytest.mark.parametrize("precision", ["single", "double"])

CPU = Machine("cpu", threads=1)
MICROMETRE, TEN_KILOMETRES = 1.0e-6, 1.0e4


@DIMENSIONS
@KINDS
@PRECISIONS
@pytest.mark.parametrize(
    "units",
    [
        Units(length=2.0**-10),
        Units(length=2.0**13),
        Units(time=2.0**-7),
        Units(mass=2.0**5),
        Units(length=2.0**-20, time=2.0**-20, mass=2.0**-60),
    ],
    ids=["millimetres", "8_kilometres", "milliseconds", "32_kilograms", "micro"],
)
def test_powers_of_two_do_not_change_a_bit(kind, dimension, precision, units):
    expected = end_fields(basin(kind, dimension, precision), CPU)
    found = end_fields(basin(kind, dimension, precision, units), CPU, units)
    assert found.keys() == expected.keys()
    for key, values in expected.items():
        assert np.array_equal(found[key], values), key


@DIMENSIONS
@KINDS
@PRECISIONS
@pytest.mark.parametrize("length", [MICROMETRE, TEN_KILOMETRES])
def test_the_same_material_at_another_scale_moves_alike(kind, dimension, precision, length):
    """At the same speeds and densities, under a gravity that grows as lengths shrink."""
    units = at_scale(length, dimension)
    scene = basin(kind, dimension, precision)
    found = end_fields(basin(kind, dimension, precision, units), CPU, units)
    assert rounding(found, end_fields(scene, CPU), scene) <= 1.0
