"""What particles tell about their place."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from warpsph.rendering.cache import RenderedSet
from warpsph.rendering.surroundings import encloses, inner_layer, neighbour_counts


def test_lattice_has_26_neighbours_inside_and_7_in_a_corner(block: RenderedSet) -> None:
    counts = neighbour_counts(block)
    assert (counts.max(), counts.min()) == (26, 7)


def test_tank_encloses_its_water_but_no_water_beside_it(tank: RenderedSet, block: RenderedSet) -> None:
    assert encloses(tank, [block])
    assert not encloses(tank, [replace(block, position=block.position + 5.0)])


def test_inner_layer_is_the_first_behind_the_walls_surface(tank: RenderedSet) -> None:
    x = inner_layer(tank)
    beyond = np.max(np.maximum(-x, x - 1.0)[:, :2], axis=1)
    beyond = np.maximum(beyond, -x[:, 2])
    np.testing.assert_allclose(beyond, 0.05)
    floor = x[(x[:, 2] < 0.0) & np.all((x[:, :2] > 0.0) & (x[:, :2] < 1.0), axis=1)]
    assert len(floor) == 100


def test_single_layer_is_drawn_whole() -> None:
    sheet = np.array([[0.1 * i, 0.1 * j, 0.0] for i in range(10) for j in range(10)])
    walls = RenderedSet("sheet", "boundary", sheet, 0.1, None)
    assert len(inner_layer(walls)) > 0
