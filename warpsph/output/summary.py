"""summary.json: what a run was and how it went."""

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from warpsph.output.atomic import write_atomically


def write_summary(path: Path, summary: Mapping[str, Any]) -> None:
    """Write nested mappings, sequences and scalars, also of NumPy, as JSON; NaN and infinity become null.

    Raises OutputError if it cannot be written; an older summary then stays.
    """
    text = json.dumps(_plain(summary), indent=2, allow_nan=False)
    write_atomically(path, f"{text}\n".encode())


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return str(value) if isinstance(value, Path) else value
