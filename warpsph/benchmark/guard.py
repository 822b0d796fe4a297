"""A guard against lost speed: ratios to the plain sum, recorded once and compared at every change.

Ratios carry over from one machine to another better than seconds do, and yet not fully: vector units differ. So a ratio
is held only against one recorded on a processor of the same name.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

LEAST_PART = 0.7
"""A case fails below this part of its recorded ratio."""


def read_rows(path: Path) -> list[dict[str, Any]]:
    """Records of a benchmark, one JSON object a line. Raises ValueError with the line that is none."""
    rows = []
    for number, line in enumerate(path.read_text().splitlines(), start=1):
        try:
            row = json.loads(line)
            rows.append({**row, "case": row["case"], "ratio_to_plain_sum": row["ratio_to_plain_sum"]})
        except (ValueError, KeyError, TypeError) as error:
            raise ValueError(f"{path}, line {number}: this is no record of a benchmark ({error})") from error
    return rows


def key_of(row: Mapping[str, Any]) -> tuple[Any, ...]:
    """What two records must share to be compared: the case, its scene and overrides, and the threads."""
    return row["case"], row.get("scene"), tuple(row.get("set", ())), row.get("threads")


def partner(row: Mapping[str, Any], older: Sequence[Mapping[str, Any]]) -> Mapping[str, Any] | None:
    """The older record of the same case, None if there is none."""
    return next((old for old in older if key_of(old) == key_of(row)), None)


def losses(rows: Sequence[Mapping[str, Any]], recorded: Sequence[Mapping[str, Any]]) -> list[str]:
    """What has become too slow, a sentence for each case; a case without a recorded partner is one, too.

    Cases recorded on another processor are not judged, see `strangers`.
    """
    found = []
    for row in rows:
        old, ratio = partner(row, recorded), row["ratio_to_plain_sum"]
        name = f"{row['case']} with {row['moving_particles']} moving particles"
        if old is None:
            found.append(f"{name}: no recorded ratio for {row['threads']} threads")
        elif not _is_stranger(row, old) and ratio < LEAST_PART * old["ratio_to_plain_sum"]:
            least = LEAST_PART * old["ratio_to_plain_sum"]
            found.append(f"{name}: {ratio:.2f} times the plain sum; allowed: at least {least:.2f}")
    return found


def strangers(rows: Sequence[Mapping[str, Any]], recorded: Sequence[Mapping[str, Any]]) -> list[str]:
    """Cases that no loss can be found in, because their ratios were recorded on another processor, a sentence each."""
    pairs = [(row, partner(row, recorded)) for row in rows]
    return [
        f"{row['case']}: recorded on {old['machine']}, not judged on {row['machine']}"
        for row, old in pairs
        if old is not None and _is_stranger(row, old)
    ]


def _is_stranger(row: Mapping[str, Any], old: Mapping[str, Any]) -> bool:
    return bool(row.get("machine") != old.get("machine"))
