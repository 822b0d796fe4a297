"""Layers of points along the outline of a plane figure, at given depths behind it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from warpsph.geometry.polygons import polygon_area
from warpsph.sampling.distance import DistanceFunction, polygon_distance, steepest_direction
from warpsph.sampling.packing import CLOSEST, filled, thinned

# Outlines that turn less than this at a corner are followed round it as one smooth curve.
_SHARP_TURN = np.deg2rad(30.0)
_TOLERANCE = 0.1
# Depths, in units of the first layer's, that are tried where a wall is too thin for its first layer.
_THIN_WALL = np.array([0.8, 0.6, 0.4, 0.2])
_MIDDLE = 0.3


@dataclass(frozen=True)
class Chain:
    """Part of an outline between two sharp corners, with the turns [rad] of the outline at its ends."""

    corners: np.ndarray
    turn_before: float
    turn_after: float


def disc_layers(
    center: Sequence[float], radius: float, depths: np.ndarray, outward: bool, spacing: float
) -> np.ndarray:
    """Points (n, 2) evenly spaced on circles at the given depths [m] outside (or inside) a disc."""
    radii = radius + depths if outward else (radius - depths)[depths < radius]
    return np.concatenate([np.empty((0, 2)), *(np.array(center) + circle(r, spacing) for r in radii)])


def circle(radius: float, spacing: float) -> np.ndarray:
    """Points (n, 2) on a circle about the origin; its centre where there is no room for two."""
    count = round(2.0 * np.pi * radius / spacing)
    if count < 2:
        return np.zeros((1, 2))
    angle = 2.0 * np.pi * np.arange(count) / count
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def polygon_layers(corners: np.ndarray, depths: np.ndarray, outward: bool, spacing: float) -> np.ndarray:
    """Points (n, 2) evenly spaced along a polygon (m, 2) at the given depths [m] outside (or inside) it.

    Where the wall goes round a corner the layers run on to the bisector; where it closes in on itself they
    end there. What meets too closely is thinned and what stays open is filled. A part of the wall thinner
    than the spacing, such as a trailing edge, holds one row in its middle.
    """
    corners = _counter_clockwise(corners)
    side = 1.0 if outward else -1.0
    margin = _TOLERANCE * spacing

    def behind(points: np.ndarray) -> np.ndarray:
        return side * polygon_distance(corners, points)

    def at(depth: float) -> np.ndarray:
        points = np.concatenate([_along_chain(chain, side * depth, spacing) for chain in _chains(corners)])
        return points[behind(points) >= depth - margin]

    def between_layers(points: np.ndarray) -> np.ndarray:
        return (behind(points) >= depths[0] - margin) & (behind(points) <= depths[-1] + margin)

    layers = [at(depth) for depth in depths]
    thin_walls = [_in_the_middle(at(share * depths[0]), behind, spacing) for share in _THIN_WALL]
    return filled(thinned(np.concatenate([*layers, *thin_walls]), CLOSEST * spacing), spacing, between_layers)


def _in_the_middle(points: np.ndarray, behind: DistanceFunction, spacing: float) -> np.ndarray:
    """The points (n, 2) about midway between two surfaces: a step away from the nearer leads nowhere."""
    step = _MIDDLE * spacing
    inwards = steepest_direction(behind, points, 1e-4 * spacing)
    gain = behind(points + step * inwards) - behind(points)
    return points[gain < 0.5 * step]


def _counter_clockwise(corners: np.ndarray) -> np.ndarray:
    return corners if polygon_area(corners) > 0.0 else corners[::-1]


def _chains(corners: np.ndarray) -> Iterator[Chain]:
    turns = _turns(corners)
    sharp = np.flatnonzero(np.abs(turns) > _SHARP_TURN)
    if len(sharp) == 0:
        yield Chain(np.concatenate([corners, corners[:1]]), 0.0, 0.0)
    for first, last in zip(sharp, np.roll(sharp, -1), strict=True):
        count = (last - first - 1) % len(corners) + 2
        members = (first + np.arange(count)) % len(corners)
        yield Chain(corners[members], turns[first], turns[last])


def _turns(corners: np.ndarray) -> np.ndarray:
    """Angle [rad] by which a counter-clockwise outline turns left at each corner."""
    after = np.roll(corners, -1, axis=0) - corners
    before = np.roll(after, 1, axis=0)
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    return np.arctan2(cross, (before * after).sum(axis=1))


def _along_chain(chain: Chain, offset: float, spacing: float) -> np.ndarray:
    """Points (n, 2) along a chain moved by `offset` [m] to its right, run on round corners at its ends."""
    line = _moved_right(chain.corners, offset)
    before, after = line[0] - line[1], line[-1] - line[-2]
    return np.concatenate(
        [
            _evenly_spaced(line, spacing),
            _run_on(line[0], before, _reach(offset, chain.turn_before), spacing),
            _run_on(line[-1], after, _reach(offset, chain.turn_after), spacing),
        ]
    )


def _moved_right(corners: np.ndarray, offset: float) -> np.ndarray:
    """An open or closed line of corners (n, 2), moved so that each of its edges has the given offset [m]."""
    edges = np.diff(corners, axis=0)
    normals = np.stack([edges[:, 1], -edges[:, 0]], axis=1) / np.linalg.norm(edges, axis=1)[:, None]
    closed = np.array_equal(corners[0], corners[-1])
    before = np.concatenate([normals[-1:] if closed else normals[:1], normals])
    after = np.concatenate([normals, normals[:1] if closed else normals[-1:]])
    return corners + offset * (before + after) / (1.0 + (before * after).sum(axis=1, keepdims=True))


def _evenly_spaced(line: np.ndarray, spacing: float) -> np.ndarray:
    """Points (n, 2) in the middles of n equal parts of a line, each as near to the spacing as possible."""
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    count = max(1, round(length[-1] / spacing))
    at = (np.arange(count) + 0.5) * length[-1] / count
    return np.stack([np.interp(at, length, line[:, k]) for k in range(2)], axis=1)


def _reach(offset: float, turn: float) -> float:
    """How far [m] a moved edge runs on to the bisector of its corner; at most twice its offset."""
    if offset * turn <= 0.0 or abs(turn) <= _SHARP_TURN:
        return 0.0
    return abs(offset) * min(np.tan(abs(turn) / 2.0), 2.0)


def _run_on(end: np.ndarray, direction: np.ndarray, reach: float, spacing: float) -> np.ndarray:
    count = int(max(0.0, reach / spacing + 0.5 + _TOLERANCE))
    steps = (np.arange(count) + 0.5) * spacing
    length = np.linalg.norm(direction)
    return end + steps[:, None] * (direction / length if length > 0.0 else direction)
