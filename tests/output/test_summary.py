"""summary.json is valid JSON whatever the numbers are."""

import json
import math
from pathlib import Path

import numpy as np

from warpsph.output.summary import write_summary


def test_numpy_values_and_numbers_that_are_not_finite(tmp_path):
    summary = {
        "steps": np.int64(7),
        "step": {"smallest": np.float32(0.5), "largest": math.inf},
        "counts": np.arange(3),
        "errors": (0.1, np.nan),
        "directory": Path("out/tank"),
        "converged": np.bool_(True),
        "note": None,
    }
    write_summary(tmp_path / "summary.json", summary)
    assert json.loads((tmp_path / "summary.json").read_text(), parse_constant=refuse_constant) == {
        "steps": 7,
        "step": {"smallest": 0.5, "largest": None},
        "counts": [0, 1, 2],
        "errors": [0.1, None],
        "directory": "out/tank",
        "converged": True,
        "note": None,
    }


def refuse_constant(constant: str) -> None:
    raise AssertionError(f"{constant} is not JSON")
