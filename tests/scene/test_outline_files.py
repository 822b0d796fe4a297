"""Points of figures of the plane from files: the same airfoil in every order, and files that hold none."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from warpsph.geometry.errors import GeometryError
from warpsph.geometry.naca import naca_outline
from warpsph.scene.outline_files import read_outline

SECTION = naca_outline("2412", closed=False)
NOSE = int(np.argmin(np.linalg.norm(SECTION, axis=1)))


def written(path: Path, head: str, *blocks: Sequence[Sequence[float]]) -> Path:
    """A file of a head and blocks of points with empty lines between them."""
    text = "\n\n".join("\n".join(f" {x:.9f}  {y:.9f}" for x, y in block) for block in blocks)
    path.write_text(f"{head}\n{text}\n")
    return path


def test_airfoil_in_the_order_of_selig(tmp_path: Path) -> None:
    path = written(tmp_path / "selig.dat", "NACA 2412", SECTION)
    assert read_outline(path) == pytest.approx(SECTION, abs=1e-9)


def test_airfoil_in_the_order_of_lednicer(tmp_path: Path) -> None:
    """Both surfaces begin at the nose; the outline is the same as in the other order."""
    upper, lower = SECTION[: NOSE + 1][::-1], SECTION[NOSE:]
    head = f"NACA 2412\n {len(upper)}.  {len(lower)}.\n"
    path = written(tmp_path / "lednicer.dat", head, upper, lower)
    assert read_outline(path) == pytest.approx(SECTION, abs=1e-9)


def test_airfoil_without_a_title(tmp_path: Path) -> None:
    path = written(tmp_path / "bare.dat", "1.0, 0.001", SECTION[1:])
    assert len(read_outline(path)) == len(SECTION)


def test_repeated_points_count_once(tmp_path: Path) -> None:
    """Files often repeat the trailing edge at the end and the nose between the surfaces."""
    square = [[1, 0], [1, 1], [0, 1], [0, 1], [0, 0], [1, 0]]
    assert len(read_outline(written(tmp_path / "square.dat", "square", square))) == 4


def test_columns_of_a_csv_file(tmp_path: Path) -> None:
    path = tmp_path / "square.csv"
    path.write_text("# a square\nname,y,x\na,0,0\nb,0,2\nc,1,2\nd,1,0\n")
    assert read_outline(path).tolist() == [[0, 0], [2, 0], [2, 1], [0, 1]]


@pytest.mark.parametrize(
    ("name", "text", "reason"),
    [
        ("a.dat", "name\n 3. 3.\n0 0\n1 1\n", "announces 3 and 3 points and holds 2"),
        ("a.dat", "name\n1 0\n0 zero\n", "line 3: '0 zero' is no pair"),
        ("a.dat", "name\n1 0\n0 nan\n", "line 3: '0 nan' is no pair of finite numbers"),
        ("a.csv", "u,v\n1,2\n", "no column 'x'"),
        ("a.txt", "1 2\n", r"ends in .csv or .dat, not in '.txt'"),
    ],
)
def test_file_that_holds_no_outline_is_refused(tmp_path: Path, name: str, text: str, reason: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(GeometryError, match=reason):
        read_outline(tmp_path / name)
