"""What the skin of the neighbour lists costs: the time of a step over that with the first skin.

Steps scenes with several skins, blocks of steps in turn, so that other programs disturb all alike, and writes the table
of docs/performance.md:

    python tools/skins.py
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

import warp as wp
from pages import rewrite, table

from warpsph import load_scene
from warpsph.solver.simulation import Simulation

PAGE = Path(__file__).parents[1] / "docs/performance.md"
BEGIN, END = "<!-- skins:begin -->", "<!-- skins:end -->"
SKINS = (0.15, 0.2, 0.25, 0.3)
"""Of the support radius."""
SCENES: Mapping[str, Sequence[str]] = {
    "rotating_patch": ["spacing=0.02"],
    "taylor_green": ["spacing=0.01"],
    "bifurcation": ["spacing=5e-4"],
    "cylinder_re100": ["spacing=0.005"],
}
"""Scenes whose particles are shifted, and their spacings [m]."""
WARM_UP, STEPS, BLOCKS = 30, 20, 8


def ratios(scene: str, overrides: Sequence[str]) -> list[float]:
    """Median over blocks of the time that steps take with each skin, over that with the first one."""
    runs = [Simulation(load_scene(scene, [*overrides, f"numerics.skin={skin}"]), "cpu", 1) for skin in SKINS]
    for run in runs:
        _seconds(run, WARM_UP)
    blocks = [[_seconds(run, STEPS) for run in runs] for _ in range(BLOCKS)]
    return [statistics.median(block[k] / block[0] for block in blocks) for k in range(len(SKINS))]


def _seconds(run: Simulation, steps: int) -> float:
    begun = time.perf_counter()
    for _ in range(steps):
        run.step()
    return time.perf_counter() - begun


def main() -> None:
    """Measure every scene and replace the table of the page."""
    wp.config.quiet = True
    rows = []
    for scene, overrides in SCENES.items():
        found = ratios(scene, overrides)
        rows.append([f"`{scene}`, {overrides[0]}", *(f"{ratio:.2f}" for ratio in found)])
        print(*rows[-1], sep=" | ", file=sys.stderr, flush=True)
    rewrite(PAGE, BEGIN, END, "\n".join(table(["scene", *map(str, SKINS)], rows)))


if __name__ == "__main__":
    main()
