"""Error, voids and cost of what keeps particles in order where fluid fills its space.

Changes the particle order of scenes without a surface, and writes the table of docs/particle_order.md:

    python tools/particle_order.py
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from trials import error_text, run_trial, write_table

from warpsph.solver.errors import SimulationDiverged

PAGE = Path(__file__).parents[1] / "docs/particle_order.md"
SCENES: Mapping[str, Sequence[str]] = {
    "taylor_green": ["spacing=0.02", "numerics.kernel_gradient=plain", "numerics.h_over_dp=2"],
    "lid_driven_cavity_re400": ["spacing=0.04"],
    "cylinder_array": [],
}
"""Scenes with what is fixed in them: half a minute each."""

CHOICES: Mapping[str, Sequence[str]] = {
    "none": [],
    "background pressure 2 rho U^2": ["numerics.background_pressure=2"],
    "background pressure 10 rho U^2": ["numerics.background_pressure=10"],
    "background pressure 100 rho U^2": ["numerics.background_pressure=100"],
    "shifting, coefficient 4": ["numerics.particle_order={type: shifting}"],
    "shifting, coefficient 10": ["numerics.particle_order={type: shifting, coefficient: 10}"],
    "transport velocity, background 0.1": [
        "numerics.particle_order={type: transport_velocity, background: 0.1}"
    ],
    "transport velocity, background 1": ["numerics.particle_order={type: transport_velocity}"],
}
"""Overrides of each choice; in all scenes the density is 1 kg/m3 and the speed U about 1 m/s."""

FIXED = [
    "numerics.particle_order={type: none}",
    "probes.voids={type: voids}",
    'references.empty_ball={type: feature, column: "voids.radius[1]", feature: maximum, source: of the whole run}',
]
"""What every run measures beside the scene's own references."""


def row(scene: str, name: str, overrides: Sequence[str]) -> list[str]:
    """Errors, the largest empty ball and the cost of a choice."""
    try:
        summary, seconds = run_trial(scene, [*SCENES[scene], *FIXED, *overrides])
    except SimulationDiverged:
        return [f"`{scene}`", name, "diverged", "-", "-", "-"]
    rows = {reference["quantity"]: reference for reference in summary["references"]}
    ball = rows.pop("empty_ball")
    errors = ", ".join(error_text(reference) for reference in rows.values())
    steps = str(summary["steps"]["count"])
    return [f"`{scene}`", name, errors, f"{ball['value']:.2f}", steps, f"{seconds:.1f}"]


def main(scenes: Sequence[str]) -> None:
    """Run every choice in the scenes and replace the table of the page."""
    rows = []
    for scene in scenes or SCENES:
        for name, overrides in CHOICES.items():
            rows.append(row(scene, name, overrides))
            print(*rows[-1], sep=" | ", file=sys.stderr, flush=True)
    columns = ("scene", "particle order", "errors", "largest empty ball / spacing", "steps", "CPU [s]")
    write_table(PAGE, columns, rows)


if __name__ == "__main__":
    main(sys.argv[1:])
