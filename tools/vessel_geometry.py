"""Write the vessels of the shipped scenes and the pulse that goes through them, all from formulas.

    python tools/vessel_geometry.py

Lengths are in millimetres: `bifurcation.ply`, a vessel that branches; `stenosis.csv`, the outline of a plane vessel
with a narrowing; `cardiac_cycle.csv`, the flow over a heart beat relative to its peak.
"""

from __future__ import annotations

from itertools import permutations
from pathlib import Path

import numpy as np
import trimesh

GEOMETRY = Path(__file__).parents[1] / "scenes/geometry"
PARENT_RADIUS = 2.5
BRANCH_RADIUS = PARENT_RADIUS / 2.0 ** (1.0 / 3.0)
"""Of two equal branches, for the least work of flow and blood (Murray 1926)."""
FIRST, LAST = -14.0, 20.0
"""Coordinates of the open ends: these lie behind the open boundaries at -10 and 16."""
BEND, SPREAD = (-4.0, 13.0), 5.5
"""Where the branches leave the axis, and how far."""
THROAT, STENOSIS_LENGTH = 0.5, 10.0
"""Part of the height that is left, and length of the narrowing."""
CELL, ROUNDING = 0.7, 1.5
"""Of the grid on which the surface is found, and reach of the rounding between the branches."""
PERIOD = 0.5


def lumen(points: np.ndarray) -> np.ndarray:
    """Distance [mm] of points (n, 3) to the wall of the bifurcating vessel, negative inside; rounded in the fork."""
    sides = [_tube(points, side) for side in (1.0, -1.0)]
    k = np.maximum(ROUNDING - np.abs(sides[0] - sides[1]), 0.0) / ROUNDING
    return np.minimum(*sides) - 0.25 * ROUNDING * k**2 * _beside_each_other(points)


def _tube(points: np.ndarray, side: float) -> np.ndarray:
    """Distance to the vessel whose centre line goes into one branch, to first order in its slope."""
    x, y, z = points.T
    s = np.clip((x - BEND[0]) / (BEND[1] - BEND[0]), 0.0, 1.0)
    centre = side * SPREAD * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    slope = SPREAD * 30.0 * (s * (1.0 - s)) ** 2 / (BEND[1] - BEND[0])
    radius = PARENT_RADIUS + (BRANCH_RADIUS - PARENT_RADIUS) * s**2 * (3.0 - 2.0 * s)
    return np.hypot((y - centre) / np.hypot(1.0, slope), z) - radius


def _beside_each_other(points: np.ndarray) -> np.ndarray:
    """Zero where the two centre lines are one, one where they have parted."""
    return np.clip((points[:, 0] - BEND[0]) / 4.0, 0.0, 1.0)


def bifurcation() -> trimesh.Trimesh:
    """The closed surface of the lumen with flat ends."""
    half = np.array([0.5 * (LAST - FIRST), SPREAD + PARENT_RADIUS, PARENT_RADIUS]) + 2.0 * CELL
    middle = np.array([0.5 * (FIRST + LAST), 0.0, 0.0])
    axes = [
        m + CELL * np.arange(-np.ceil(r / CELL), np.ceil(r / CELL) + 1)
        for m, r in zip(middle, half, strict=True)
    ]
    nodes = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    ends = np.maximum(FIRST - nodes[..., 0], nodes[..., 0] - LAST)
    values = np.maximum(lumen(nodes.reshape(-1, 3)).reshape(ends.shape), ends)
    return isosurface(nodes, values)


def isosurface(nodes: np.ndarray, values: np.ndarray) -> trimesh.Trimesh:
    """The surface of value zero on a grid of nodes, values (n, m, k), by marching tetrahedra (Doi & Koide 1991).

    Six tetrahedra a cell share its diagonal, so that those of neighbouring cells fit together.
    """
    index = np.arange(values.size).reshape(values.shape)
    steps = np.array([[order.index(axis) for axis in range(3)] for order in permutations(range(3))])
    tetrahedra = []
    for ranks in steps:
        corners = [tuple(int(k > rank) for rank in ranks) for k in range(4)]
        tetrahedra.append(np.stack([_shifted(index, corner) for corner in corners], axis=1))
    edges = _crossed_edges(np.concatenate(tetrahedra), values.ravel() < 0.0)
    ends, inverse = np.unique(np.sort(edges.reshape(-1, 2), axis=1), axis=0, return_inverse=True)
    f = values.ravel()[ends]
    part = np.clip(f[:, :1] / (f[:, :1] - f[:, 1:]), 0.05, 0.95)
    x = nodes.reshape(-1, 3)[ends]
    vertices, faces = x[:, 0] + part * (x[:, 1] - x[:, 0]), inverse.reshape(-1, 3)
    first, second, third = (vertices[faces[:, k]] for k in range(3))
    outwards = np.diff(nodes.reshape(-1, 3)[edges[:, 0]], axis=1)[:, 0]
    inverted = np.einsum("ij,ij->i", np.cross(second - first, third - first), outwards) < 0.0
    faces[inverted] = faces[inverted, ::-1]
    return trimesh.Trimesh(vertices, faces, process=False)


def _shifted(index: np.ndarray, corner: tuple[int, ...]) -> np.ndarray:
    """Nodes at one corner of every cell."""
    return index[tuple(slice(c, c - 1 or None) for c in corner)].ravel()


def _crossed_edges(tetrahedra: np.ndarray, inside: np.ndarray) -> np.ndarray:
    """Edges of the tetrahedra (n, 4), from inside to outside, on which the corners of triangles lie (m, 3, 2)."""
    state = inside[tetrahedra]
    ordered = np.take_along_axis(tetrahedra, np.argsort(~state, axis=1, kind="stable"), axis=1)
    count = state.sum(axis=1)
    triangles = {
        1: [[(0, 1), (0, 2), (0, 3)]],
        2: [[(0, 2), (0, 3), (1, 3)], [(0, 2), (1, 3), (1, 2)]],
        3: [[(0, 3), (1, 3), (2, 3)]],
    }
    return np.concatenate(
        [
            ordered[count == n][:, triangle]
            for n, several in triangles.items()
            for triangle in np.array(several)
        ]
    )


def stenosis() -> np.ndarray:
    """Corners (n, 2) of a vessel of height 1 with a narrowing 1 - (1 - THROAT) (1 + cos(2 pi x / L)) / 2 (Young 1968).

    The flow reaches from 3 heights before the middle of the narrowing to 7 behind it; the rest lies behind its ends.
    """
    height, length = 2.0 * PARENT_RADIUS, STENOSIS_LENGTH
    x = np.concatenate([[-5.0 * height], np.linspace(-0.5 * length, 0.5 * length, 41), [8.0 * height]])
    within = np.abs(x) <= 0.5 * length
    wave = np.where(within, 0.5 * (1.0 + np.cos(2.0 * np.pi * x / length)), 0.0)
    y = 0.5 * height * (1.0 - (1.0 - THROAT) * wave)
    return np.concatenate([np.stack([x, -y], axis=1), np.stack([x, y], axis=1)[::-1]])


def cardiac_cycle(times: np.ndarray) -> np.ndarray:
    """Flow over its peak at times [s]: a systolic and a smaller dicrotic bell over a steady flow; own formula."""
    s = times / PERIOD
    flow = np.full_like(s, 0.25)
    for part, middle, width in ((0.75, 0.25, 0.09), (0.12, 0.58, 0.07)):
        for k in (-1, 0, 1):
            flow += part * np.exp(-(((s - middle - k) / width) ** 2))
    return flow


def main() -> None:
    """Write the three files."""
    bifurcation().export(GEOMETRY / "bifurcation.ply")
    outline = stenosis()
    np.savetxt(GEOMETRY / "stenosis.csv", outline, "%.5f", delimiter=",", header="x,y", comments="")
    times = np.linspace(0.0, PERIOD, 101)
    pulse = np.stack([times, cardiac_cycle(times)], axis=1)
    np.savetxt(GEOMETRY / "cardiac_cycle.csv", pulse, "%.5f", delimiter=",", header="time,value", comments="")


if __name__ == "__main__":
    main()
