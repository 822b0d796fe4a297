"""Whether a closed line of straight edges bounds a figure of the plane."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from warpsph.geometry.errors import GeometryError

Point = tuple[float, float]


def refuse_crossing(points: Sequence[Point]) -> None:
    """Raise GeometryError where a polygon, its last corner joined to the first, repeats a corner or meets itself."""
    edges = list(pairwise((*points, points[0])))
    for index, (start, end) in enumerate(edges):
        if start == end:
            follower = (index + 1) % len(points)
            raise GeometryError(f"points {index} and {follower} coincide (the polygon closes by itself)")
    crossing = _crossing_edges(edges)
    if crossing is not None:
        raise GeometryError("the polygon cuts or touches itself: edges {} and {} meet".format(*crossing))


_Edge = tuple[Point, Point]


def _crossing_edges(edges: list[_Edge]) -> tuple[int, int] | None:
    """Indices of two edges that share more than a common corner; None where the polygon is simple."""
    order = sorted(range(len(edges)), key=lambda index: min(edges[index][0][0], edges[index][1][0]))
    for place, i in enumerate(order):
        right_end = max(edges[i][0][0], edges[i][1][0])
        for j in order[place + 1 :]:
            if min(edges[j][0][0], edges[j][1][0]) > right_end:
                break
            if _edges_meet(edges, i, j):
                return min(i, j), max(i, j)
    return None


def _edges_meet(edges: list[_Edge], i: int, j: int) -> bool:
    if (i + 1) % len(edges) == j:
        return _folds_back(edges[i], edges[j])
    if (j + 1) % len(edges) == i:
        return _folds_back(edges[j], edges[i])
    (a, b), (c, d) = edges[i], edges[j]
    sides = (_side(a, b, c), _side(a, b, d), _side(c, d, a), _side(c, d, b))
    if sides[0] * sides[1] < 0.0 and sides[2] * sides[3] < 0.0:
        return True
    return any(
        side == 0.0 and _within(point, edge)
        for side, point, edge in zip(sides, (c, d, a, b), ((a, b), (a, b), (c, d), (c, d)), strict=True)
    )


def _folds_back(first: _Edge, second: _Edge) -> bool:
    """Whether the second of two consecutive edges runs back over the first."""
    (a, b), (_, c) = first, second
    backwards = (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]) < 0.0
    return backwards and _side(a, b, c) == 0.0


def _side(a: Point, b: Point, point: Point) -> float:
    """Positive to the left of the line from a to b, negative to its right, zero on it."""
    return (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0])


def _within(point: Point, edge: _Edge) -> bool:
    """Whether a point of the edge's line lies between the edge's ends."""
    (a, b) = edge
    return all(min(a[k], b[k]) <= point[k] <= max(a[k], b[k]) for k in range(2))


def polygon_area(corners: np.ndarray) -> float:
    """Area [m2] inside of a polygon with corners (n, 2) [m], positive where they run counter-clockwise."""
    x, y = corners.T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2.0
