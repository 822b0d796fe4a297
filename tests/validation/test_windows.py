"""Which references a shortened run cannot serve."""

from __future__ import annotations

from typing import Any

import pytest
from compared_scenes import tank_with

from warpsph.validation.windows import beyond_the_end

WHOLE = 4.0
"""End of the run that has not been shortened [s]; that of the tank is 2 s."""
TABLE = {"time": [1.0, 3.0], "value": [1.0, 1.0]}
SERIES = {"type": "series", "column": "front.position[m]", "table": TABLE}
FIELD = {"type": "field", "set": "water", "field": "pressure", "expression": "0", "relative_to": 1.0}
LIMIT = {"type": "limit", "column": "energy.kinetic[J/m]", "high": 1.0}
FIGURE = {"type": "feature", "column": "energy.kinetic[J/m]"}


@pytest.mark.parametrize(
    ("reference", "until"),
    [
        (SERIES, None),  # of its times those within the run count
        (SERIES | {"table": {"time": [2.5, 3.0], "value": [1.0, 1.0]}}, 2.5),
        (SERIES | {"at": [1.0, 3.0]}, 3.0),
        (SERIES | {"at": [1.0, 2.0]}, None),
        (FIELD, WHOLE),
        (FIELD | {"at": [1.5]}, None),
        (LIMIT, None),
        (LIMIT | {"window": [1.0, 2.5]}, 2.5),
        (FIGURE | {"feature": "maximum"}, WHOLE),
        (FIGURE | {"feature": "maximum", "window": [0.0, 2.0]}, None),
        (FIGURE | {"feature": "arrival", "threshold": 1.0, "value": 3.5}, 3.5),
        (FIGURE | {"feature": "arrival", "threshold": 1.0, "value": 1.5}, None),
        (FIGURE | {"feature": "first_peak", "threshold": 1.0, "value": 1e5}, None),
    ],
)
def test_a_reference_is_left_out_where_it_looks_beyond_the_end(
    reference: dict[str, Any], until: float | None
) -> None:
    expected = {} if until is None else {"it": until}
    assert beyond_the_end(tank_with(it=reference), WHOLE) == expected
