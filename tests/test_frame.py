"""Frames: finding sets in them, and the units of their fields."""

import numpy as np
import pytest

from warpsph.frame import Frame, SetFrame, field_unit

WATER = SetFrame("water", "fluid", {"position": np.zeros((3, 2))})
TANK = SetFrame("tank", "boundary", {"position": np.zeros((5, 2))})
FRAME = Frame(0, 0.0, 2, 0.1, (WATER, TANK))


def test_sets_are_found_by_name_and_by_kind():
    assert FRAME.set_named("tank") is TANK
    assert FRAME.of_kind("fluid") == (WATER,)
    assert FRAME.of_kind("structure") == ()
    assert (WATER.count, TANK.count) == (3, 5)


def test_unknown_set_is_an_error_that_names_those_there_are():
    with pytest.raises(KeyError, match="'oil'; there are water, tank"):
        FRAME.set_named("oil")


@pytest.mark.parametrize(
    ("field", "plane", "space"),
    [("force", "N/m", "N"), ("mass", "kg/m", "kg"), ("volume", "m2", "m3"), ("pressure", "Pa", "Pa")],
)
def test_extensive_fields_are_per_metre_of_depth_in_the_plane(field, plane, space):
    assert (field_unit(field, 2), field_unit(field, 3)) == (plane, space)
