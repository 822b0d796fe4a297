"""Paths of particles over pictures: where they are, and up to when."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.image import imread

from warpsph.output.recordings import write_path_curves
from warpsph.rendering.errors import RenderError
from warpsph.rendering.movie import render
from warpsph.rendering.pathlines import COLOURS, read_pathlines
from warpsph.scene import Scene

SIZE = (640, 360)
FIRST, SECOND = np.array([0.1, 0.2]), np.array([0.1, 0.8])


def write_paths(run: Path, scene: Scene) -> None:
    """Two particles that go along x for 0.2 s at 3 m/s; the second one leaves at 0.1 s."""
    times, dimension = np.array([0.0, 0.1, 0.2]), scene.dimension
    starts = np.pad(np.array([FIRST, SECOND]), ((0, 0), (0, dimension - 2)), constant_values=0.25)
    positions = starts + 3.0 * times[:, None, None] * np.eye(dimension)[0]
    positions[2, 1] = np.nan
    write_path_curves(run / "paths.usdc", {"rake": (times, np.array([7, 3]), positions)}, scene)


def drawn_in(picture: np.ndarray, plain: np.ndarray, colour: str) -> np.ndarray:
    """First and last column of the pixels that are not as in the plain picture and have a colour, to a quarter that
    smoothing may take from a line of less than two pixels."""
    off = np.abs(picture - np.array(to_rgb(colour))).max(axis=2)
    columns = np.nonzero((off < 0.25) & np.any(picture != plain, axis=2))[1]
    return np.array([columns.min(), columns.max()])


def pictures(run: Path, *, paths: bool) -> list[np.ndarray]:
    """Pixels (height, width, 3) of the pictures."""
    return [imread(path)[..., :3] for path in render(run, size=SIZE, paths=paths).images]


def test_a_path_that_was_written_is_read(tmp_path: Path, make_scene: Callable[[int], Scene]) -> None:
    write_paths(tmp_path, make_scene(2))
    first, second = read_pathlines(tmp_path / "paths.usdc")
    assert (first.particle, second.particle) == (7, 3)
    assert first.points == pytest.approx(np.array([[0.1, 0.2, 0.0], [0.4, 0.2, 0.0], [0.7, 0.2, 0.0]]))
    assert second.times == pytest.approx([0.0, 0.1])


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_path_reaches_to_where_its_particle_is(
    write_run: Callable[..., Path], make_scene: Callable[[int], Scene], dimension: int
) -> None:
    """At twice the time the path is twice as long, to a quarter: its round ends and the perspective add to it."""
    run = write_run(dimension)
    write_paths(run, make_scene(dimension))
    with_paths, without = pictures(run, paths=True)[1:], pictures(run, paths=False)[1:]
    first, second = (
        np.array([drawn_in(*pair, colour) for pair in zip(with_paths, without, strict=True)])
        for colour in COLOURS[:2]
    )
    assert first[0, 0] == pytest.approx(first[1, 0], abs=2)
    half, whole = np.ptp(first, axis=1)
    assert half > 20
    assert whole == pytest.approx(2 * half, rel=0.25)
    assert second[1] == pytest.approx(second[0], abs=6)


def test_a_run_without_paths_is_answered_with_what_would_record_them(write_run: Callable[..., Path]) -> None:
    with pytest.raises(RenderError, match=r"paths\.usdc: there is no such file.*output\.paths"):
        render(write_run(2), size=SIZE, paths=True)
