"""Paths of particles over a picture, each up to the time of the picture."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import Normal, Stroke
from pxr import UsdGeom

from warpsph.rendering.cache import open_stage
from warpsph.rendering.errors import RenderError

PATH_FILE = "paths.usdc"
COLOURS = ("#e8432e", "#111418", "#f2b134", "#7b2d8b", "#1b9e4b", "#8c564b")
"""In turn, one a particle; all of them stand out from the blues of the water."""
_WIDTH, _HALO, _HEAD = 1.8, 1.6, 6.0
"""Width of a line, of the white beside it, and diameter of the dot at its end, in points."""


@dataclass(frozen=True)
class Pathline:
    """Way of one particle: points (n, 3) [m] with their times (n,) [s], and the particle's number."""

    points: np.ndarray
    times: np.ndarray
    particle: int


def read_pathlines(path: Path) -> tuple[Pathline, ...]:
    """The paths of a stage of `UsdGeom.BasisCurves` as a run leaves it. Raises RenderError if there is none."""
    if not path.is_file():
        allowed = "run a scene with output.paths, or draw without paths"
        raise RenderError(f"{path}: there is no such file; {allowed}")
    stage, lines = open_stage(path), list[Pathline]()
    for prim in stage.Traverse():
        if not prim.IsA(UsdGeom.BasisCurves):
            continue
        curves, primvars = UsdGeom.BasisCurves(prim), UsdGeom.PrimvarsAPI(prim)
        counts = np.asarray(curves.GetCurveVertexCountsAttr().Get(), dtype=np.int64)
        ends = np.cumsum(counts)
        points = np.asarray(curves.GetPointsAttr().Get()).reshape(-1, 3)
        times = np.asarray(primvars.GetPrimvar("time").Get())
        numbers = np.asarray(primvars.GetPrimvar("particle").Get())
        lines += [
            Pathline(points[end - count : end], times[end - count : end], int(number))
            for end, count, number in zip(ends, counts, numbers, strict=True)
        ]
    return tuple(lines)


def draw_pathlines(
    axes: Axes,
    lines: Sequence[Pathline],
    time: float,
    project: Callable[[np.ndarray], np.ndarray] = lambda points: points,
) -> None:
    """Draw lines up to a time [s], with a dot where a particle is then; `project` takes points (n, 3) to axes (n, 2 or
    more)."""
    particles = list(dict.fromkeys(line.particle for line in lines))
    for line in lines:
        # Times are in single precision: a sample at the time of the frame may lie a rounding later.
        past = line.times <= time * (1.0 + 1e-6)
        if not past.any():
            continue
        colour = COLOURS[particles.index(line.particle) % len(COLOURS)]
        x, y = project(line.points[past])[:, :2].T
        halo = [Stroke(linewidth=_WIDTH + 2.0 * _HALO, foreground="white"), Normal()]
        axes.plot(x, y, color=colour, linewidth=_WIDTH, solid_capstyle="round", path_effects=halo)
        if past.all() and time > line.times[-1] * (1.0 + 1e-6):
            continue
        axes.plot(x[-1], y[-1], "o", color=colour, markersize=_HEAD, markeredgecolor="white")
