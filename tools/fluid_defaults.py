"""Error against cost of fluids over kernels, smoothing lengths, walls, viscosities and diffusions.

Changes one choice at a time from the scene as it stands, and writes the table of docs/fluid_defaults.md:

    python tools/fluid_defaults.py
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from trials import error_text, run_trial, write_table

from warpsph.scene.errors import SceneError
from warpsph.solver.errors import SimulationDiverged

PAGE = Path(__file__).parents[1] / "docs/fluid_defaults.md"
SCENES: Mapping[str, Sequence[str]] = {
    "hydrostatic_tank_2d": ["spacing=0.04"],
    "dam_break_2d": ["spacing=0.05"],
    "couette": ["spacing=4e-5"],
    "taylor_green": ["spacing=0.04", "numerics.h_over_dp=2"],
}
"""Scenes with their spacing: a few seconds each."""


def _kernels() -> Iterator[tuple[str, list[str]]]:
    lengths = {
        "wendland_c2": (1.25, 1.5, 1.75, 2.0),
        "wendland_c4": (1.5, 2.0),
        "cubic_spline": (1.25, 1.5),
        "quintic_spline": (1.0, 1.25),
        "gaussian": (1.0, 1.25),
    }
    for kernel, ratios in lengths.items():
        for ratio in ratios:
            yield f"{kernel}, h/dp {ratio:g}", [f"numerics.kernel={kernel}", f"numerics.h_over_dp={ratio}"]


def _walls() -> Iterator[tuple[str, list[str]]]:
    for wall in ("extrapolated", "dynamic", "modified_dynamic", "repulsive"):
        yield f"wall {wall}", [f"numerics.wall={{type: {wall}}}"]


def _viscosities(scene: str) -> Iterator[tuple[str, list[str]]]:
    if scene in ("hydrostatic_tank_2d", "dam_break_2d"):
        for alpha in (0.01, 0.02, 0.05):
            yield (
                f"artificial viscosity {alpha:g}",
                [f"numerics.viscosity={{type: artificial, alpha: {alpha}}}"],
            )
        yield (
            "riemann pressure, inviscid",
            ["numerics.viscosity={type: none}", "numerics.pressure_form=riemann"],
        )
    else:
        for viscosity in ("laminar", "viscous_stress"):
            yield f"viscosity {viscosity}", [f"numerics.viscosity={{type: {viscosity}}}"]


def _diffusions() -> Iterator[tuple[str, list[str]]]:
    for diffusion in ("none", "molteni_colagrossi", "fourtakas", "delta_sph"):
        yield f"density diffusion {diffusion}", [f"numerics.density_diffusion={{type: {diffusion}}}"]


def choices(scene: str) -> Iterator[tuple[str, list[str]]]:
    """Name and overrides of everything that is tried in a scene, the scene as it stands first."""
    yield "as it stands", []
    yield from _kernels()
    if scene != "taylor_green":
        yield from _walls()
    yield from _viscosities(scene)
    yield from _diffusions()


def row(scene: str, name: str, overrides: Sequence[str]) -> list[str]:
    """The errors and the cost of a choice; what it cannot compute says why."""
    try:
        summary, seconds = run_trial(scene, [*SCENES[scene], *overrides])
    except SceneError as error:
        return [f"`{scene}`", name, f"refused: {error.problems[0].message}", "-", "-"]
    except SimulationDiverged:
        return [f"`{scene}`", name, "diverged", "-", "-"]
    errors = ", ".join(error_text(reference) for reference in summary["references"])
    return [f"`{scene}`", name, errors, str(summary["steps"]["count"]), f"{seconds:.1f}"]


def main(scenes: Sequence[str]) -> None:
    """Run every choice of the scenes and replace the table of the page."""
    rows = []
    for scene in scenes or SCENES:
        for name, overrides in choices(scene):
            rows.append(row(scene, name, overrides))
            print(*rows[-1], sep=" | ", file=sys.stderr, flush=True)
    write_table(PAGE, ("scene", "choice", "errors", "steps", "CPU [s]"), rows)


if __name__ == "__main__":
    main(sys.argv[1:])
