"""CSV tables: columns by name, and a reason with its line where there are none."""

from pathlib import Path

import numpy as np
import pytest

from warpsph.scene.tables import TableError, read_columns


def test_columns_come_by_name_and_in_order(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("# source\n\n time , value ,other\n0,1.5,a\n# a remark\n1e-1,-2,b\n")
    value, time = read_columns(path, ["value", "time"])
    np.testing.assert_array_equal(time, [0.0, 0.1])
    np.testing.assert_array_equal(value, [1.5, -2.0])


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "no header"),
        (b"time,value\n", "no header with rows"),
        (b"time,height\n0,1\n", "no column 'value', only time, height"),
        (b"time,value\n0,1\n1\n", "line 3: nothing is not a number"),
        (b"# remark\ntime,value\n0,one\n", "line 3: 'one' is not a number"),
        (b"time,value\n0,nan\n", "line 2: nan is not finite"),
        (b"time,value\n\xff,1\n", "not text in UTF-8"),
    ],
)
def test_a_wrong_table_is_refused_with_the_reason(tmp_path: Path, content: bytes, reason: str) -> None:
    path = tmp_path / "table.csv"
    path.write_bytes(content)
    with pytest.raises(TableError, match=reason) as caught:
        read_columns(path, ["time", "value"])
    assert str(path) in str(caught.value)


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(TableError, match="No such file"):
        read_columns(tmp_path / "nothing.csv", ["time"])
