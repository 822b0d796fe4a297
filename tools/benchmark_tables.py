"""Tables of speed in the README and in docs/performance.md, from the records of `warpsph bench`.

warpsph bench --threads 1 --out docs/benchmark.jsonl
python tools/benchmark_tables.py docs/benchmark.jsonl
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from pages import read_rows, rewrite, table

ROOT = Path(__file__).parents[1]
MARKS = ("<!-- benchmark:begin -->", "<!-- benchmark:end -->")
LARGEST_STAGES = 5

Row = Mapping[str, Any]


def summary_table(rows: Sequence[Row]) -> list[str]:
    """A line a case: size, speed, ratio to the plain sum, memory."""
    columns = (
        "machine",
        "case (scene)",
        "moving particles",
        "neighbours",
        "threads",
        "M particle-steps/s",
        "M evaluations/s",
        "times the plain sum",
        "bytes a particle (without lists)",
    )
    return table(columns, map(_summary, rows))


def profile_table(rows: Sequence[Row]) -> list[str]:
    """A line a case: microseconds a step, the largest stages, and how often lists are made."""
    columns = (
        "case",
        "moving particles",
        "threads",
        "ms a step",
        "stages",
        "outside of stages",
        "steps a list",
    )
    return table(columns, map(_profile, rows))


def _summary(row: Row) -> tuple[str, ...]:
    low, high = row["ratio_quartiles"]
    without = row["bytes_per_particle_without_lists"]
    return (
        row["machine"],
        f"{row['case']} (`{row['scene']}`)",
        str(row["moving_particles"]),
        f"{row['neighbours']:.0f}",
        str(row["threads"]),
        f"{row['particle_steps_per_second'] / 1e6:.2f}",
        f"{row['evaluations_per_second'] / 1e6:.2f}",
        f"{row['ratio_to_plain_sum']:.2f} ({low:.2f} to {high:.2f})",
        f"{row['bytes_per_particle']:.0f} ({without:.0f})",
    )


def _profile(row: Row) -> tuple[str, ...]:
    step = row["seconds"] / row["steps"]
    stages = list(row["seconds_a_step_by_stage"].items())[:LARGEST_STAGES]
    interval = row["list_interval_steps"]
    return (
        row["case"],
        str(row["moving_particles"]),
        str(row["threads"]),
        f"{1e3 * step:.3g}",
        ", ".join(f"{name} {spent / step:.0%}" for name, spent in stages),
        f"{row['share_outside_stages']:.0%}",
        f"{interval:.1f}" if interval else "-",
    )


def main(path: Path) -> None:
    """Write the tables of both pages."""
    rows = read_rows(path)
    rewrite(ROOT / "README.md", *MARKS, "\n".join(summary_table(rows)))
    rewrite(
        ROOT / "docs/performance.md",
        *MARKS,
        "\n".join([*summary_table(rows), "", *profile_table(rows)]),
    )


if __name__ == "__main__":
    main(Path(sys.argv[1]))
