"""NACA sections of four digits (Jacobs, Ward & Pinkerton 1933, NACA report 460)."""

from __future__ import annotations

import numpy as np

_OPEN_END, _CLOSED_END = -0.1015, -0.1036
"""Last coefficient of the thickness: that of the report, and the one with which the trailing edge has no thickness."""
STATIONS = 100
"""Edges along each of the two surfaces: chords within 1e-4 chord lengths of the curve."""


def naca_outline(digits: str, closed: bool) -> np.ndarray:
    """Corners (n, 2) of a section of chord 1, from the trailing edge over the upper surface and back below.

    The chord runs from (0, 0) to (1, 0). The first digit is the camber in hundredths of the chord, the second its place
    in tenths, the last two the thickness in hundredths. Stations are close where the nose is round (equal steps
    of the angle t in x = (1 - cos t) / 2).

    Args:
        closed: whether the upper and lower surface meet in the trailing edge, which has else 2.1 % of the thickness.
    """
    x = (1.0 - np.cos(np.linspace(0.0, np.pi, STATIONS + 1))) / 2.0
    half = half_thickness(x, int(digits[2:]) / 100.0, closed)
    line, slope = camber(x, int(digits[0]) / 100.0, int(digits[1]) / 10.0)
    across = half[:, None] * np.stack([-slope, np.ones_like(slope)], axis=1) / np.hypot(1.0, slope)[:, None]
    middle = np.stack([x, line], axis=1)
    upper, lower = middle + across, middle - across
    return np.concatenate([upper[::-1], lower[1 : -1 if closed else None]])


def half_thickness(x: np.ndarray, thickness: float, closed: bool) -> np.ndarray:
    """Half of the thickness (n,) at stations x (n,), all in chords; `thickness` is the largest of the section."""
    last = _CLOSED_END if closed else _OPEN_END
    return 5.0 * thickness * (0.2969 * np.sqrt(x) + x * (-0.1260 + x * (-0.3516 + x * (0.2843 + x * last))))


def camber(x: np.ndarray, height: float, place: float) -> tuple[np.ndarray, np.ndarray]:
    """Mean line and its slope (n,) at stations x (n,), all in chords: two parabolas that meet in their tops."""
    if height == 0.0:
        return np.zeros_like(x), np.zeros_like(x)
    ahead = x < place
    scale = height / np.where(ahead, place, 1.0 - place) ** 2
    line = scale * (np.where(ahead, 0.0, 1.0 - 2.0 * place) + 2.0 * place * x - x**2)
    return line, 2.0 * scale * (place - x)
