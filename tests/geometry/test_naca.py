"""NACA sections against the figures of report 460 and the integrals of its formulas."""

import numpy as np
import pytest

from warpsph.geometry.naca import camber, half_thickness, naca_outline
from warpsph.geometry.polygons import polygon_area, refuse_crossing


def surfaces(digits: str, closed: bool = True) -> tuple[np.ndarray, np.ndarray]:
    """Upper and lower surface from the nose to the trailing edge."""
    outline = naca_outline(digits, closed)
    nose = int(np.argmin(np.linalg.norm(outline, axis=1)))
    return outline[: nose + 1][::-1], outline[nose:]


def test_thickness_of_the_report() -> None:
    """NACA report 460 gives the ordinates of the section of 20 %: y = 0.0956 at 0.2, 0.100 at 0.3, 0.0882 at 0.5."""
    ordinates = half_thickness(np.array([0.2, 0.3, 0.5, 1.0]), 0.2, closed=False)
    assert ordinates == pytest.approx([0.0956, 0.1000, 0.0882, 0.0021], abs=1e-4)


@pytest.mark.parametrize("digits", ["0012", "0006", "0024"])
def test_thickest_place_of_a_symmetric_section(digits: str) -> None:
    """The thickness of its name, to the rounding of the coefficients, at 0.3 chords."""
    upper, lower = surfaces(digits)
    assert 2.0 * upper[:, 1].max() == pytest.approx(int(digits) / 100.0, rel=5e-4)
    assert upper[upper[:, 1].argmax(), 0] == pytest.approx(0.3, abs=0.02)
    assert upper[1:-1] == pytest.approx(lower[1:] * [1.0, -1.0], abs=1e-15)


@pytest.mark.parametrize("closed", [True, False])
def test_area_is_the_integral_of_the_thickness(closed: bool) -> None:
    """Chords of a smooth curve miss parts of second order in the edges; at the nose those are shortest."""
    last = -0.1036 if closed else -0.1015
    exact = 10.0 * 0.12 * (0.2969 / 1.5 - 0.1260 / 2.0 - 0.3516 / 3.0 + 0.2843 / 4.0 + last / 5.0)
    assert polygon_area(naca_outline("0012", closed)) == pytest.approx(exact, rel=2e-4)


def test_trailing_edge() -> None:
    closed, opened = naca_outline("0012", closed=True), naca_outline("0012", closed=False)
    assert closed[0] == pytest.approx([1.0, 0.0], abs=1e-15)
    assert len(np.unique(closed.round(12), axis=0)) == len(closed)
    assert opened[0] == pytest.approx([1.0, 0.00126], abs=1e-15)
    assert opened[-1] == pytest.approx([1.0, -0.00126], abs=1e-15)


def test_camber_of_a_2412() -> None:
    """2 % of the chord at 0.4, in one smooth line through the ends of the chord."""
    x = np.linspace(0.0, 1.0, 1001)
    line, slope = camber(x, 0.02, 0.4)
    assert (line.max(), x[line.argmax()]) == (pytest.approx(0.02), pytest.approx(0.4))
    assert line[[0, -1]] == pytest.approx([0.0, 0.0], abs=1e-15)
    assert slope[1:-1] == pytest.approx(np.gradient(line, x)[1:-1], abs=2e-4)
    upper, lower = surfaces("2412")
    middle = (upper[1:-1] + lower[1:]) / 2.0
    assert middle[:, 1] == pytest.approx(np.interp(middle[:, 0], x, line), abs=1e-5)


@pytest.mark.parametrize("digits", ["0012", "2412", "6409", "9930", "0001"])
@pytest.mark.parametrize("closed", [True, False])
def test_outlines_do_not_cross_themselves(digits: str, closed: bool) -> None:
    refuse_crossing([(x, y) for x, y in naca_outline(digits, closed)])
